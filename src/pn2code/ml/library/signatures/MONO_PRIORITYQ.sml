signature MONO_PRIORITYQ = sig
    type item
    type queue
    val empty : queue
    val singleton : item -> queue
    val fromList : item list -> queue
    val insert : item * queue -> queue
    val remove : queue -> item * queue
    val next : queue -> (item * queue) option
    val merge : queue * queue -> queue
    val numItems : queue -> int
    val isEmpty : queue -> bool
end
