(* What the engine has of model times besides what is built in. *)
structure ModelTime = struct
    open ModelTime

    val null = fromInt 0
    val null_str = toString null
    fun mkstr t = toString t
    fun col (colour @ _) = colour
end
structure CPN'Time = ModelTime
