signature ARRAY_SORT = sig
    type 'a array
    val sort : ('a * 'a -> order) -> 'a array -> unit
    val sorted : ('a * 'a -> order) -> 'a array -> bool
end
