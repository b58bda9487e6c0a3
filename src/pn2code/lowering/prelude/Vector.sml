(* A vector is a list. *)
val Vector_maxLen = 16777215
fun Vector_fromList (xs : 'a list) = xs
fun Vector_tabulate (n, f) = if n > Vector_maxLen then raise Size else List.tabulate (n, f)
fun Vector_length xs = length xs
fun Vector_sub (xs, i) = List.nth (xs, i)

fun Vector_update (xs, i, x) =
    if i < 0 orelse i >= length xs then raise Subscript else List.take (xs, i) ^^ (x :: List.drop (xs, i + 1))

fun Vector_concat parts = List.concat parts
fun Vector_app f xs = List.app f xs
fun Vector_map f xs = List.map f xs
fun Vector_foldl f z xs = List.foldl f z xs
fun Vector_foldr f z xs = List.foldr f z xs
fun Vector_find p xs = List.find p xs
fun Vector_exists p xs = List.exists p xs
fun Vector_all p xs = List.all p xs
fun Vector_collate cmp (xs, ys) = List.collate cmp (xs, ys)

fun numbered xs =
    let fun loop (nil, _, out) = rev out
          | loop (x :: rest, i, out) = loop (rest, i + 1, (i, x) :: out)
    in loop (xs, 0, nil) end

fun Vector_appi f xs = List.app f (numbered xs)
fun Vector_mapi f xs = List.map f (numbered xs)
fun Vector_foldli f z xs = List.foldl (fn ((i, x), z) => f (i, x, z)) z (numbered xs)
fun Vector_foldri f z xs = List.foldr (fn ((i, x), z) => f (i, x, z)) z (numbered xs)
fun Vector_findi p xs = List.find p (numbered xs)
