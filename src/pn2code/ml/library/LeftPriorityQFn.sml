(* Queues of items with priorities: heaps whose left side is at least as deep as the right one. The greatest comes first. *)
functor LeftPriorityQFn (P : PRIORITY) = struct
    type item = P.item
    datatype heap = EMPTY | NODE of int * P.item * heap * heap
    datatype queue = Q of int * heap

    fun rank EMPTY = 0
      | rank (NODE (n, _, _, _)) = n
    fun node (x, a, b) = if rank a >= rank b then NODE (rank b + 1, x, a, b) else NODE (rank a + 1, x, b, a)
    fun joined (a, EMPTY) = a
      | joined (EMPTY, b) = b
      | joined (a as NODE (_, x, left, right), b as NODE (_, y, left', right')) =
        (case P.compare (P.priority x, P.priority y) of
            GREATER => node (x, left, joined (right, b))
          | _ => node (y, left', joined (a, right')))
    val empty = Q (0, EMPTY)
    fun single x = NODE (1, x, EMPTY, EMPTY)
    fun singleton x = Q (1, single x)
    fun insert (x, Q (n, heap)) = Q (n + 1, joined (single x, heap))
    fun next (Q (_, EMPTY)) = NONE
      | next (Q (n, NODE (_, x, left, right))) = SOME (x, Q (n - 1, joined (left, right)))
    fun remove queue = case next queue of SOME found => found | NONE => raise Empty
    fun merge (Q (m, a), Q (n, b)) = Q (m + n, joined (a, b))
    fun numItems (Q (n, _)) = n
    fun isEmpty (Q (_, EMPTY)) = true
      | isEmpty _ = false
    fun fromList items =
        let fun pairs ([heap], nil) = heap
              | pairs (nil, [heap]) = heap
              | pairs (nil, heaps) = pairs (heaps, nil)
              | pairs ([heap], heaps) = pairs (heap :: heaps, nil)
              | pairs (a :: b :: rest, heaps) = pairs (rest, joined (a, b) :: heaps)
        in
            case items of
                nil => empty
              | _ => Q (length items, pairs (List.foldl (fn (x, heaps) => single x :: heaps) nil items, nil))
        end
end
