val size : IntInf.int = 256
fun Word8_fromInt n = IntInf.mod (IntInf.fromInt n, size)
fun Word8_toInt w = IntInf.toInt w
fun Word8_toString w = String.map Char.toUpper (IntInf.fmt StringCvt.HEX w)
