(* What waits, the last that came first. *)
structure Stack = struct
    type 'a waitingset = 'a list
    exception Dequeue = Empty
    val empty = nil
    fun isEmpty set = List.null set
    fun enqueue (set, x) = x :: set
    fun dequeue nil = raise Dequeue
      | dequeue (x :: rest) = (rest, x)
    fun head set = List.hd set
    fun peek nil = NONE
      | peek (x :: _) = SOME x
    fun length set = List.length set
end
