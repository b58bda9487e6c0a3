(* Bytes are numbers; what goes over a connection is written as CPN Tools writes it. *)
fun ConnManagementLayer_stringEncode s = Byte.stringToBytes s
fun ConnManagementLayer_stringDecode bytes = Byte.bytesToString bytes

fun ConnManagementLayer_integerEncode n =
    let val n = IntInf.fromInt n
        fun byte k = IntInf.mod (IntInf.div (n, IntInf.pow (256, k)), 256)
    in List.map byte [3, 2, 1, 0] end

fun ConnManagementLayer_integerDecode bytes =
    case bytes of
        a :: b :: c :: d :: _ =>
        let val n : IntInf.int = ((a * 256 + b) * 256 + c) * 256 + d
        in IntInf.toInt (if n >= 2147483648 then n - 4294967296 else n) end
      | _ => raise Subscript
