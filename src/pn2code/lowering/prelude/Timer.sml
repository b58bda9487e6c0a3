fun Timer_startRealTimer () : IntInf.int = 0
fun Timer_totalRealTimer () : IntInf.int = 0
fun Timer_checkRealTimer (timer : IntInf.int) : IntInf.int = 0
fun Timer_startCPUTimer () : IntInf.int = 0
fun Timer_totalCPUTimer () : IntInf.int = 0
fun Timer_checkCPUTimer (timer : IntInf.int) = {usr = 0 : IntInf.int, sys = 0 : IntInf.int}
