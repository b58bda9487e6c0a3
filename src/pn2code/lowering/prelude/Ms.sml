fun Ms_legal_ms legal ms = List.all legal ms

(* Neighbours in the sorted list count as equal unless the first is less. *)
fun Ms_mkstr_ms (text, less) ms =
    let fun line (n, x) = Int.toString n ^ "`" ^ text x
        fun count (x, n, nil, out) = rev (line (n, x) :: out)
          | count (x, n, y :: rest, out) =
            if less (x, y) then count (y, 1, rest, line (n, x) :: out) else count (x, n + 1, rest, out)
    in
        case sort less ms of
            nil => "empty"
          | x :: rest => String.concatWith "++\n" (count (x, 1, rest, nil))
    end

fun Ms_sort_ms less ms = sort less ms
