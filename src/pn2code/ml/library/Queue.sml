structure Queue = struct
    datatype 'a queue = QUEUE of 'a Fifo.fifo ref
    exception Dequeue = Fifo.Dequeue

    fun mkQueue () = QUEUE (ref Fifo.empty)
    fun clear (QUEUE q) = q := Fifo.empty
    fun enqueue (QUEUE q, x) = q := Fifo.enqueue (!q, x)
    fun dequeue (QUEUE q) = let val (rest, x) = Fifo.dequeue (!q) in q := rest; x end
    fun next (QUEUE q) = case Fifo.next (!q) of SOME (x, rest) => (q := rest; SOME x) | NONE => NONE
    fun delete (QUEUE q, f) = q := Fifo.delete (!q, f)
    fun head (QUEUE q) = Fifo.head (!q)
    fun peek (QUEUE q) = Fifo.peek (!q)
    fun isEmpty (QUEUE q) = Fifo.isEmpty (!q)
    fun length (QUEUE q) = Fifo.length (!q)
    fun contents (QUEUE q) = Fifo.contents (!q)
    fun app f (QUEUE q) = Fifo.app f (!q)
    fun map f (QUEUE q) = QUEUE (ref (Fifo.map f (!q)))
    fun foldl f start (QUEUE q) = Fifo.foldl f start (!q)
    fun foldr f start (QUEUE q) = Fifo.foldr f start (!q)
end
