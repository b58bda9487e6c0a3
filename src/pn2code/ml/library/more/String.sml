(* What SML/NJ has of strings besides the Basis library. *)
structure String = struct
    open String

    fun rev text = implode (List.rev (explode text))
    fun implodeRev letters = implode (List.rev letters)
    fun concatWithMap separator f items = concatWith separator (List.map f items)
end
