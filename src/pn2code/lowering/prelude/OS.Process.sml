val OS_Process_success = 0
val OS_Process_failure = 1
fun OS_Process_isSuccess status = status = 0
fun OS_Process_getEnv (name : string) : string option = NONE
fun OS_Process_sleep (time : IntInf.int) = ()
