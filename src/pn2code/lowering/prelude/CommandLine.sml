fun CommandLine_name () = "cpn"
fun CommandLine_arguments () : string list = nil
