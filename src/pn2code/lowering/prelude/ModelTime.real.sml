fun ModelTime_fromString s = Real.fromString s
fun ModelTime_maketime s =
    case Real.fromString s of SOME t => t | NONE => raise CPN'Error ("maketime: not a real : " ^ s)
