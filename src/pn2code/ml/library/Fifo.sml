structure Fifo = struct
    datatype 'a fifo = Q of {front : 'a list, rear : 'a list}
    exception Dequeue

    val empty = Q {front = nil, rear = nil}
    fun isEmpty (Q {front = nil, rear = nil}) = true
      | isEmpty _ = false
    fun enqueue (Q {front, rear}, x) = Q {front = front, rear = x :: rear}
    fun next (Q {front = x :: rest, rear}) = SOME (x, Q {front = rest, rear = rear})
      | next (Q {front = nil, rear = nil}) = NONE
      | next (Q {rear, ...}) = next (Q {front = rev rear, rear = nil})
    fun dequeue q = case next q of SOME (x, rest) => (rest, x) | NONE => raise Dequeue
    fun contents (Q {front, rear}) = List.revAppend (rev front, rev rear)
    fun delete (Q {front, rear}, f) =
        Q {front = List.filter (fn x => not (f x)) (front), rear = List.filter (fn x => not (f x)) rear}
    fun head q = case next q of SOME (x, _) => x | NONE => raise Dequeue
    fun peek q = case next q of SOME (x, _) => SOME x | NONE => NONE
    fun length q = List.length (contents q)
    fun app f q = List.app f (contents q)
    fun map f q = Q {front = List.map f (contents q), rear = nil}
    fun foldl f start q = List.foldl f start (contents q)
    fun foldr f start q = List.foldr f start (contents q)
end
