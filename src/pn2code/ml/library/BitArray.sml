(* Arrays of bits. A text of hexadecimal digits begins with the highest bits. *)
structure BitArray = struct
    datatype array = BITS of bool Array.array
    datatype vector = VECTOR of bool list
    type elem = bool

    val maxLen = 8 * Word8Array.maxLen
    fun array (size, x) = if size < 0 then raise Subscript else BITS (Array.array (size, x))
    fun fromList items = BITS (Array.fromList items)
    fun tabulate (size, f) = BITS (Array.tabulate (size, f))
    fun length (BITS items) = Array.length items
    fun sub (BITS items, i) = Array.sub (items, i)
    fun update (BITS items, i, x) = Array.update (items, i, x)
    fun toList (BITS items) = Array.foldr (op ::) nil items
    fun vector whole = VECTOR (toList whole)
    fun toVector whole = vector whole
    fun fromVector (VECTOR items) = fromList items
    fun copy {src = BITS src, dst = BITS dst, di} = Array.copy {src = src, dst = dst, di = di}
    fun copyVec {src, dst, di} = copy {src = fromVector src, dst = dst, di = di}
    fun appi f (BITS items) = Array.appi f items
    fun app f (BITS items) = Array.app f items
    fun modifyi f (BITS items) = Array.modifyi f items
    fun modify f (BITS items) = Array.modify f items
    fun foldli f start (BITS items) = Array.foldli f start items
    fun foldri f start (BITS items) = Array.foldri f start items
    fun foldl f start (BITS items) = Array.foldl f start items
    fun foldr f start (BITS items) = Array.foldr f start items
    fun findi f (BITS items) = Array.findi f items
    fun find f (BITS items) = Array.find f items
    fun exists f (BITS items) = Array.exists f items
    fun all f (BITS items) = Array.all f items
    fun collate f (BITS a, BITS b) = Array.collate f (a, b)

    fun bit (whole, i) = i < length whole andalso sub (whole, i)
    fun bits (size, set) =
        let val made = array (Int.max (0, size), false)
            val bytes = (size + 7) div 8
            fun put i =
                if i < 0 orelse i >= 8 * bytes then raise Subscript
                else if i < size then update (made, i, true)
                else ()
        in List.app put set; made end
    fun getBits whole = List.filter (fn i => bit (whole, i)) (List.tabulate (length whole, fn i => i))
    fun isZero whole = not (exists (fn x => x) whole)
    fun extended (whole, size, x) =
        let val old = length whole
        in tabulate (Int.max (old, size), fn i => if i < old then sub (whole, i) else x) end
    fun extend0 (whole, size) = extended (whole, size, false)
    fun extend1 (whole, size) = extended (whole, size, true)
    fun eqBits (a, b) = getBits a = getBits b
    fun equal (a, b) = toList a = toList b
    fun both f (a, b, size) =
        if size < 0 then raise Subscript
        else tabulate (size, fn i => f (bit (a, i), bit (b, i)))
    fun andb parts = both (fn (x, y) => x andalso y) parts
    fun orb parts = both (fn (x, y) => x orelse y) parts
    fun xorb parts = both (fn (x, y) => x <> y) parts
    fun notb whole = tabulate (length whole, fn i => not (sub (whole, i)))
    fun lshift (whole, n) =
        if n < 0 then raise Fail "BitArray.lshift: negative shift" else tabulate (length whole + n, fn i => i >= n andalso sub (whole, i - n))
    fun rshift (whole, n) =
        if n < 0 then raise Fail "BitArray.rshift: negative shift" else tabulate (Int.max (0, length whole - n), fn i => sub (whole, i + n))
    fun setBit (whole, i) = update (whole, i, true)
    fun clrBit (whole, i) = update (whole, i, false)
    fun union a b = modifyi (fn (i, x) => x orelse bit (b, i)) a
    fun intersection a b = modifyi (fn (i, x) => x andalso bit (b, i)) a
    fun complement whole = modify not whole
    fun toString whole =
        let fun digit i = List.foldl (fn (k, n) => 2 * n + (if bit (whole, 4 * i + k) then 1 else 0)) 0 [3, 2, 1, 0]
            val digits = (length whole + 3) div 4
        in String.implode (List.tabulate (digits, fn i => String.sub ("0123456789abcdef", digit (digits - 1 - i)))) end
    fun fromString text =
        let val digits = List.map Char.toUpper (String.explode text)
            fun value c =
                if Char.isDigit c then Char.ord c - 48
                else if Char.isHexDigit c then Char.ord c - 55
                else raise Fail "BitArray.stringToBits: illegal character"
            fun four (c, rest) =
                let val n = value c in (n mod 2 = 1) :: (n div 2 mod 2 = 1) :: (n div 4 mod 2 = 1) :: (n div 8 = 1) :: rest end
        in fromList (List.foldl four nil digits) end
end
