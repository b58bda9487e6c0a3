signature PROP_LIST = sig
    type holder
    val newHolder : unit -> holder
    val hasProps : holder -> bool
    val clearHolder : holder -> unit
    val sameHolder : holder * holder -> bool
    val newProp : ('b -> holder) * ('b -> 'a) -> { clrFn : 'b -> unit,  getFn : 'b -> 'a,  peekFn : 'b -> 'a option,  setFn : 'b * 'a -> unit }
    val newFlag : ('a -> holder) -> { getFn : 'a -> bool,  setFn : 'a * bool -> unit }
end
