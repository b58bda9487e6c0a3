fun OS_errorMsg (error : string) = error
fun OS_errorName (error : string) = error
