fun Byte_byteToChar w = chr (IntInf.toInt w)
fun Byte_charToByte c = IntInf.fromInt (ord c)
fun Byte_bytesToString bytes = implode (List.map Byte_byteToChar bytes)
fun Byte_stringToBytes s = List.map Byte_charToByte (explode s)
