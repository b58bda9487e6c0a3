signature LIST_XPROD = sig
    val appX : ('b * 'c -> 'a) -> 'b list * 'c list -> unit
    val mapX : ('a * 'b -> 'c) -> 'a list * 'b list -> 'c list
    val foldX : ('a * 'b * 'c -> 'c) -> 'a list * 'b list -> 'c -> 'c
end
