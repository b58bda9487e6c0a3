fun ModelTime_fromString s = Real.fromString s
fun ModelTime_maketime s = valOf (Real.fromString s)
