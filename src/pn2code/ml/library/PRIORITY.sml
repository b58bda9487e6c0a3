signature PRIORITY = sig
    type priority
    val compare : priority * priority -> order
    type item
    val priority : item -> priority
end
