(* All pairs of two lists, the second one fastest. *)
structure ListXProd = struct
    fun appX f (xs, ys) = List.app (fn x => List.app (fn y => ignore (f (x, y))) ys) xs
    fun mapX f (xs, ys) = List.concat (List.map (fn x => List.map (fn y => f (x, y)) ys) xs)
    fun foldX f (xs, ys) start = List.foldl (fn (x, out) => List.foldl (fn (y, z) => f (x, y, z)) out ys) start xs
end
