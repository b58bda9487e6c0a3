(* Bytes are numbers; what goes over a connection is written as CPN Tools writes it. *)
fun ConnManagementLayer_stringEncode s = Byte.stringToBytes s
fun ConnManagementLayer_stringDecode bytes = Byte.bytesToString bytes

fun ConnManagementLayer_integerEncode n = Byte.stringToBytes (Int.toString n)

fun ConnManagementLayer_integerDecode bytes =
    case Int.fromString (Byte.bytesToString bytes) of SOME n => n | NONE => raise ConnManagementLayer.InvalidDataExn
