(* What SML/NJ has of options besides the Basis library. *)
structure Option = struct
    open Option

    fun isNone NONE = true
      | isNone (SOME _) = false
    fun fold _ start NONE = start
      | fold f start (SOME x) = f (x, start)
end
