(* A vector of bytes is a list of numbers. *)
val Word8Vector_maxLen = 16777215
fun Word8Vector_length (bytes : IntInf.int list) = length bytes
fun Word8Vector_sub (bytes : IntInf.int list, i) = List.nth (bytes, i)
fun Word8Vector_fromList (bytes : IntInf.int list) = bytes
fun Word8Vector_concat (parts : IntInf.int list list) = List.concat parts
