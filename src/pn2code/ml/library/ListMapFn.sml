(* Maps as lists that are sorted by their keys. *)
functor ListMapFn (K : ORD_KEY) = struct
    structure Key = K
    datatype 'a map = MAP of (K.ord_key * 'a) list

    val empty = MAP nil
    fun isEmpty (MAP items) = List.null items
    fun singleton (k, x) = MAP [(k, x)]
    fun insert (MAP items, k, x) =
        let fun put nil = [(k, x)]
              | put ((j, y) :: rest) =
                (case K.compare (k, j) of
                     LESS => (k, x) :: (j, y) :: rest
                   | EQUAL => (k, x) :: rest
                   | GREATER => (j, y) :: put rest)
        in MAP (put items) end
    fun insert' ((k, x), m) = insert (m, k, x)
    fun find (MAP items, k) =
        let fun look nil = NONE
              | look ((j, y) :: rest) =
                (case K.compare (k, j) of LESS => NONE | EQUAL => SOME y | GREATER => look rest)
        in look items end
    fun lookup (m, k) = case find (m, k) of SOME x => x | NONE => raise LibBase.NotFound
    fun inDomain (m, k) = isSome (find (m, k))
    fun remove (MAP items, k) =
        let fun cut (nil, _) = raise LibBase.NotFound
              | cut ((j, y) :: rest, before_it) =
                (case K.compare (k, j) of
                     EQUAL => (MAP (List.revAppend (before_it, rest)), y)
                   | _ => cut (rest, (j, y) :: before_it))
        in cut (items, nil) end
    fun first (MAP nil) = NONE
      | first (MAP ((_, x) :: _)) = SOME x
    fun firsti (MAP nil) = NONE
      | firsti (MAP (item :: _)) = SOME item
    fun numItems (MAP items) = length items
    fun listItems (MAP items) = List.map (fn (_, x) => x) items
    fun listItemsi (MAP items) = items
    fun listKeys (MAP items) = List.map (fn (k, _) => k) items
    fun collate cmp (MAP a, MAP b) =
        List.collate
            (fn ((j, x), (k, y)) => case K.compare (j, k) of EQUAL => cmp (x, y) | other => other) (a, b)
    fun mergeWithi f (MAP a, MAP b) =
        let fun keep (k, NONE, rest) = rest
              | keep (k, SOME z, rest) = (k, z) :: rest
            fun both (nil, nil, out) = rev out
              | both ((j, x) :: xs, nil, out) = both (xs, nil, keep (j, f (j, SOME x, NONE), out))
              | both (nil, (k, y) :: ys, out) = both (nil, ys, keep (k, f (k, NONE, SOME y), out))
              | both ((j, x) :: xs, (k, y) :: ys, out) =
                (case K.compare (j, k) of
                     LESS => both (xs, (k, y) :: ys, keep (j, f (j, SOME x, NONE), out))
                   | EQUAL => both (xs, ys, keep (j, f (j, SOME x, SOME y), out))
                   | GREATER => both ((j, x) :: xs, ys, keep (k, f (k, NONE, SOME y), out)))
        in MAP (both (a, b, nil)) end
    fun mergeWith f = mergeWithi (fn (_, x, y) => f (x, y))
    fun unionWithi f =
        mergeWithi (fn (k, SOME x, SOME y) => SOME (f (k, x, y)) | (_, SOME x, NONE) => SOME x | (_, NONE, y) => y)
    fun unionWith f = unionWithi (fn (_, x, y) => f (x, y))
    fun intersectWithi f = mergeWithi (fn (k, SOME x, SOME y) => SOME (f (k, x, y)) | _ => NONE)
    fun intersectWith f = intersectWithi (fn (_, x, y) => f (x, y))
    fun appi f (MAP items) = List.app f items
    fun app f (MAP items) = List.app (fn (_, x) => f x) items
    fun mapi f (MAP items) = MAP (List.map (fn (k, x) => (k, f (k, x))) items)
    fun map f m = mapi (fn (_, x) => f x) m
    fun foldli f start (MAP items) = List.foldl (fn ((k, x), z) => f (k, x, z)) start items
    fun foldl f start m = foldli (fn (_, x, z) => f (x, z)) start m
    fun foldri f start (MAP items) = List.foldr (fn ((k, x), z) => f (k, x, z)) start items
    fun foldr f start m = foldri (fn (_, x, z) => f (x, z)) start m
    fun filteri f (MAP items) = MAP (List.filter f items)
    fun filter f m = filteri (fn (_, x) => f x) m
    fun mapPartiali f (MAP items) =
        MAP (List.mapPartial (fn (k, x) => case f (k, x) of SOME y => SOME (k, y) | NONE => NONE) items)
    fun mapPartial f m = mapPartiali (fn (_, x) => f x) m
    fun existsi f (MAP items) = List.exists f items
    fun exists f m = existsi (fn (_, x) => f x) m
    fun alli f (MAP items) = List.all f items
    fun all f m = alli (fn (_, x) => f x) m
end
