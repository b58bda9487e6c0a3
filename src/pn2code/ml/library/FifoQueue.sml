(* What waits, the first that came first: as `Stack`. *)
structure FifoQueue = struct
    type 'a waitingset = 'a Fifo.fifo
    exception Dequeue = Fifo.Dequeue
    val empty = Fifo.empty
    fun isEmpty set = Fifo.isEmpty set
    fun enqueue (set, x) = Fifo.enqueue (set, x)
    fun dequeue set = Fifo.dequeue set
    fun head set = Fifo.head set
    fun peek set = Fifo.peek set
    fun length set = Fifo.length set
end
