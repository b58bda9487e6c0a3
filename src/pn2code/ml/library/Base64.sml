(* Bytes as texts of 64 characters (RFC 4648). *)
structure Base64 = struct
    exception Incomplete
    exception Invalid of int * char

    val alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
    val isBase64 = Char.contains alphabet
    fun code c =
        if Char.isUpper c then Char.ord c - 65
        else if Char.isLower c then Char.ord c - 71
        else if Char.isDigit c then Char.ord c + 4
        else if c = #"+" then 62
        else if c = #"/" then 63
        else ~1

    fun letters n = map (fn d => String.sub (alphabet, n div d mod 64))
    fun written (a :: b :: c :: rest) =
        letters (65536 * a + 256 * b + c) [262144, 4096, 64, 1] ^^ written rest
      | written [a, b] = letters (65536 * a + 256 * b) [262144, 4096, 64] ^^ [#"="]
      | written [a] = letters (65536 * a) [262144, 4096] ^^ [#"=", #"="]
      | written nil = nil
    fun encode bytes = String.implode (written (map Word8.toInt (Word8Vector.toList bytes)))
    fun encodeSlice part = encode (Word8VectorSlice.vector part)

    fun isBlank c = c = #" " orelse c = #"\t" orelse c = #"\n" orelse c = #"\r"
    (* As in SML/NJ, which finds a text of four characters, or less, incomplete, and reads with padding what is before the
       last four only where it begins before the last character of it. *)
    fun read strict text =
        let val size = String.size text
            fun skipped c = not strict andalso isBlank c
            fun checked (i, c) = if code c < 0 then raise Invalid (i, c) else code c
            (* The last four characters, and where what is before them ends. *)
            fun tail (i, chars) =
                if i < 0 then raise Incomplete
                else if length chars = 4 then (i, chars)
                else
                    let val c = String.sub (text, i)
                    in
                        if skipped c then tail (i - 1, chars)
                        else if c <> #"=" andalso code c < 0 then raise Invalid (i, c)
                        else tail (i - 1, (i, c) :: chars)
                    end
            fun bytes (n, divisors) = map (fn d => Word8.fromInt (n div d mod 256)) divisors
            fun value codes = foldl (fn (x, n) => 64 * n + x) 0 codes
            fun next i =
                if i >= size then raise Incomplete
                else if skipped (String.sub (text, i)) then next (i + 1)
                else (checked (i, String.sub (text, i)), i + 1)
            fun plain (i, limit) =
                if i >= limit then nil
                else
                    let val (a, i) = next i
                        val (b, i) = next i
                        val (c, i) = next i
                        val (d, i) = next i
                        val rest = plain (i, limit)
                    in bytes (value [a, b, c, d], [65536, 256, 1]) ^^ rest end
            val (limit, last) = tail (size - 1, nil)
            val (limit, final) =
                case last of
                    [a, b, (_, #"="), (_, #"=")] => (limit, bytes (value [checked a, checked b, 0, 0], [65536]))
                  | [a, b, c, (_, #"=")] =>
                    (limit, bytes (value [checked a, checked b, checked c, 0], [65536, 256]))
                  | _ => (size, nil)
            val start = plain (0, limit)
        in Word8Vector.fromList (start ^^ final) end
    fun decode text = read false text
    fun decodeStrict text = read true text
    fun decodeSlice part = decode (Substring.string part)
    fun decodeSliceStrict part = decodeStrict (Substring.string part)
end
