fun ModelTime_fromString s = IntInf.fromString s
fun ModelTime_maketime s =
    case IntInf.fromString s of SOME t => t | NONE => raise CPN'Error ("maketime: not an IntInf : " ^ s)
