(* Parts of vectors: the vector, where the part begins, and how long it is. *)
structure VectorSlice = struct
    datatype 'a slice = Slice of 'a vector * int * int

    fun within (start, size, i, NONE) =
        if i < 0 orelse i > size then raise Subscript else (start + i, size - i)
      | within (start, size, i, SOME n) =
        if i < 0 orelse n < 0 orelse i > size orelse n > size - i then raise Subscript else (start + i, n)

    fun full items = Slice (items, 0, Vector.length items)
    fun slice (items, i, n) = let val (i, n) = within (0, Vector.length items, i, n) in Slice (items, i, n) end
    fun subslice (Slice (items, start, size), i, n) =
        let val (i, n) = within (start, size, i, n) in Slice (items, i, n) end
    fun base (Slice whole) = whole
    fun length (Slice (_, _, size)) = size
    fun isEmpty (Slice (_, _, size)) = size = 0
    fun sub (Slice (items, start, size), i) =
        if i < 0 orelse i >= size then raise Subscript else Vector.sub (items, start + i)
    fun getItem (Slice (items, start, size)) =
        if size = 0 then NONE else SOME (Vector.sub (items, start), Slice (items, start + 1, size - 1))

    fun foldli f z (Slice (items, start, size)) =
        let fun each (i, out) = if i = size then out else each (i + 1, f (i, Vector.sub (items, start + i), out))
        in each (0, z) end
    fun foldri f z (Slice (items, start, size)) =
        let fun each (i, out) = if i < 0 then out else each (i - 1, f (i, Vector.sub (items, start + i), out))
        in each (size - 1, z) end
    fun foldl f z part = foldli (fn (_, x, out) => f (x, out)) z part
    fun foldr f z part = foldri (fn (_, x, out) => f (x, out)) z part
    fun elements part = foldr (fn (x, out) => x :: out) nil part
    fun vector part = Vector.fromList (elements part)
    fun concat parts = Vector.fromList (List.concat (List.map elements parts))
    fun appi f part = foldli (fn (i, x, ()) => f (i, x) : unit) () part
    fun app f part = appi (fn (_, x) => f x) part
    fun mapi f part = Vector.fromList (List.rev (foldli (fn (i, x, out) => f (i, x) :: out) nil part))
    fun map f part = mapi (fn (_, x) => f x) part
    fun findi has (Slice (items, start, size)) =
        let fun from i =
                if i = size then NONE
                else let val found = (i, Vector.sub (items, start + i))
                     in if has found then SOME found else from (i + 1) end
        in from 0 end
    fun find has part = case findi (fn (_, x) => has x) part of SOME (_, x) => SOME x | NONE => NONE
    fun exists has part = case find has part of SOME _ => true | NONE => false
    fun all has part = not (exists (fn x => not (has x)) part)
    fun collate order (a, b) = List.collate order (elements a, elements b)
end
