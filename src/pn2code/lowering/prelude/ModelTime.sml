fun ModelTime_fromString s = IntInf.fromString s
fun ModelTime_maketime s = valOf (IntInf.fromString s)
