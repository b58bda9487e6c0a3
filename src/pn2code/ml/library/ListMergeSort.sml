(* Sorting lists: `gt` says which pairs are in the wrong order. *)
structure ListMergeSort = struct
    val by_lt = sort
    fun sort gt items = by_lt (fn (a, b) => gt (b, a)) items

    fun sorted gt (x :: y :: rest) = not (gt (x, y)) andalso sorted gt (y :: rest)
      | sorted _ _ = true

    (* Of those that are equal the first stays. *)
    fun uniqueSort cmp items =
        let fun merge (nil, ys) = ys
              | merge (xs, nil) = xs
              | merge (x :: xs, y :: ys) =
                (case cmp (x, y) of
                     LESS => x :: merge (xs, y :: ys)
                   | EQUAL => merge (x :: xs, ys)
                   | GREATER => y :: merge (x :: xs, ys))
            fun halves (nil, n, first) = (rev first, nil)
              | halves (rest, 0, first) = (rev first, rest)
              | halves (x :: rest, n, first) = halves (rest, n - 1, x :: first)
            fun made nil = nil
              | made [x] = [x]
              | made xs =
                let val (first, second) = halves (xs, length xs div 2, nil)
                in merge (made first, made second) end
        in made items end
end
