fun List_getItem nil = NONE
  | List_getItem (x :: rest) = SOME (x, rest)

fun List_collate cmp =
    let fun loop (nil, nil) = EQUAL
          | loop (nil, _) = LESS
          | loop (_, nil) = GREATER
          | loop (x :: xs, y :: ys) =
            (case cmp (x, y) of EQUAL => loop (xs, ys) | LESS => LESS | GREATER => GREATER)
    in loop end

fun List_partition p xs =
    let fun loop (nil, yes, no) = (rev yes, rev no)
          | loop (x :: rest, yes, no) = if p x then loop (rest, x :: yes, no) else loop (rest, yes, x :: no)
    in loop (xs, nil, nil) end

fun List_predlist p xs = List.exists p xs

fun List_mapfilter (f, xs) =
    let fun loop (nil, out) = rev out
          | loop (x :: rest, out) = (case !f x of (true, y) => loop (rest, y :: out) | (false, _) => loop (rest, out))
    in loop (xs, nil) end

(* Merge sort of the runs that are there, in CPN Tools' order of comparisons: the latest list is the first. As many merges after
   each run as the number of runs can be halved: both lists then come from as many runs. *)
fun sorted_by less merge xs =
    let fun run (x, nil, out) = (rev (x :: out), nil)
          | run (x, y :: rest, out) = if less (x, y) then run (y, rest, x :: out) else (rev (x :: out), y :: rest)
        fun join (later :: earlier :: rest, size) =
            if size mod 2 = 0 then join (merge (later, earlier, nil) :: rest, size div 2) else later :: earlier :: rest
          | join (lists, _) = lists
        fun finish (later :: earlier :: rest) = finish (merge (later, earlier, nil) :: rest)
          | finish (xs :: _) = xs
          | finish nil = nil
        fun loop (nil, lists, _) = finish lists
          | loop (x :: rest, lists, runs) =
            let val (first, others) = run (x, rest, nil)
            in loop (others, join (first :: lists, runs + 1), runs + 1) end
    in loop (xs, nil, 0) end

fun List_sort less xs =
    let fun merge (x :: xs, y :: ys, out) =
            if less (x, y) then merge (xs, y :: ys, x :: out) else merge (x :: xs, ys, y :: out)
          | merge (nil, ys, out) = List.revAppend (out, ys)
          | merge (xs, nil, out) = List.revAppend (out, xs)
    in sorted_by less merge xs end

fun List_unique_sort less xs =
    let fun merge (x :: xs, y :: ys, out) =
            if less (x, y) then merge (xs, y :: ys, x :: out)
            else if less (y, x) then merge (x :: xs, ys, y :: out)
            else merge (xs, ys, x :: out)
          | merge (nil, ys, out) = List.revAppend (out, ys)
          | merge (xs, nil, out) = List.revAppend (out, xs)
    in sorted_by less merge xs end
