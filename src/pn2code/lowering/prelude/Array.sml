(* An array is a reference to a list. *)
val Array_maxLen = 16777215
fun Array_array (n, x) = if n < 0 orelse n > Array_maxLen then raise Size else ref (List.tabulate (n, fn _ => x))
fun Array_fromList (xs : 'a list) = ref xs
(* The first element comes before the array, which may be too large. *)
fun Array_tabulate (n, f) =
    if n > Array_maxLen then (f 0; raise Size) else ref (List.tabulate (n, f))
fun Array_length a = length (!a)
fun Array_sub (a, i) = List.nth (!a, i)

fun Array_update (a, i, x) =
    let val xs = !a
    in
        if i < 0 orelse i >= length xs then raise Subscript
        else a := List.take (xs, i) ^^ (x :: List.drop (xs, i + 1))
    end

fun Array_vector a = !a
fun Array_app f a = List.app f (!a)
fun Array_foldl f z a = List.foldl f z (!a)
fun Array_foldr f z a = List.foldr f z (!a)
fun Array_find p a = List.find p (!a)
fun Array_exists p a = List.exists p (!a)
fun Array_all p a = List.all p (!a)
fun Array_collate cmp (a, b) = List.collate cmp (!a, !b)

fun numbered xs =
    let fun loop (nil, _, out) = rev out
          | loop (x :: rest, i, out) = loop (rest, i + 1, (i, x) :: out)
    in loop (xs, 0, nil) end

fun Array_modify f a = List.app (fn (i, x) => Array_update (a, i, f x)) (numbered (!a))
fun Array_appi f a = List.app f (numbered (!a))
fun Array_modifyi f a = List.app (fn (i, x) => Array_update (a, i, f (i, x))) (numbered (!a))
fun Array_foldli f z a = List.foldl (fn ((i, x), z) => f (i, x, z)) z (numbered (!a))
fun Array_foldri f z a = List.foldr (fn ((i, x), z) => f (i, x, z)) z (numbered (!a))
fun Array_findi p a = List.find p (numbered (!a))

fun put (xs, a, di) =
    let val n = length xs
        val old = !a
    in
        if di < 0 orelse di + n > length old then raise Subscript
        else a := List.take (old, di) ^^ xs ^^ List.drop (old, di + n)
    end

fun Array_copy {src, dst, di} = put (!src, dst, di)
fun Array_copyVec {src, dst, di} = put (src, dst, di)
