(* Sizes of tables: of these primes the first that is larger, or the last. *)
structure PrimeSizes = struct
    val sizes =
        [11, 13, 17, 23, 37, 47, 67, 97, 131, 191, 257, 367, 521, 727, 1031, 1451, 2053, 2897, 4099, 5801, 8209, 11587, 16411,
         23173, 32771, 46349, 65537, 92683, 131101, 185369, 262147, 370759, 524309, 741457, 1048583, 1482919, 2097169]
    fun pick least =
        let fun first [last] = last
              | first (size :: rest) = if size > least then size else first rest
              | first nil = 0
        in first sizes end
end
