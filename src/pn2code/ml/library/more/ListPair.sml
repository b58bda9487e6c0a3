(* What SML/NJ has of pairs of lists besides the Basis library; `..Eq` raises UnequalLengths at the end. *)
structure ListPair = struct
    open ListPair

    fun fold_left (ended, f) start (left, right) =
        let fun each (i, x :: xs, y :: ys, out) = each (i + 1, xs, ys, f (i, x, y, out))
              | each (_, nil, nil, out) = (ended (true, true); out)
              | each (_, _, _, out) = (ended (true, false); out)
        in each (0, left, right, start) end
    fun fold_right (ended, f) start (left, right) =
        let fun each (i, x :: xs, y :: ys) = f (i, x, y, each (i + 1, xs, ys))
              | each (_, nil, nil) = start
              | each _ = (ended (true, false); start)
        in each (0, left, right) end
    fun any_end (_ : bool * bool) = ()
    fun both_end (a, b) = if a andalso b then () else raise UnequalLengths

    fun foldli f = fold_left (any_end, f)
    fun foldliEq f = fold_left (both_end, f)
    fun foldri f = fold_right (any_end, f)
    fun foldriEq f = fold_right (both_end, f)
    fun appi f = foldli (fn (i, x, y, ()) => f (i, x, y)) ()
    fun appiEq f = foldliEq (fn (i, x, y, ()) => f (i, x, y)) ()
    fun mapi f pair = rev (foldli (fn (i, x, y, out) => f (i, x, y) :: out) nil pair)
    fun mapiEq f pair = rev (foldliEq (fn (i, x, y, out) => f (i, x, y) :: out) nil pair)
    fun mapPartiali f pair =
        rev (foldli (fn (i, x, y, out) => case f (i, x, y) of SOME z => z :: out | NONE => out) nil pair)
    fun mapPartialiEq f pair =
        rev (foldliEq (fn (i, x, y, out) => case f (i, x, y) of SOME z => z :: out | NONE => out) nil pair)
    fun mapPartial f = mapPartiali (fn (_, x, y) => f (x, y))
    fun mapPartialEq f = mapPartialiEq (fn (_, x, y) => f (x, y))
end
