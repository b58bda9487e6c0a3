(* Vectors of bytes, besides what is built in. *)
structure Word8Vector = struct
    open Word8Vector
    type elem = Word8.word

    fun toList bytes = List.tabulate (length bytes, fn i => sub (bytes, i))
    fun tabulate (n, f) = if n > maxLen then raise Size else fromList (List.tabulate (n, f))
    fun update (bytes, i, byte) =
        if i < 0 orelse i >= length bytes then raise Subscript
        else fromList (List.tabulate (length bytes, fn j => if i = j then byte else sub (bytes, j)))
    fun append (bytes, byte) = fromList (toList bytes ^^ [byte])
    fun prepend (byte, bytes) = fromList (byte :: toList bytes)
    fun collate order (a, b) = List.collate order (toList a, toList b)

    fun foldli f z bytes =
        let fun each (_, nil, out) = out | each (i, x :: rest, out) = each (i + 1, rest, f (i, x, out))
        in each (0, toList bytes, z) end
    fun foldri f z bytes =
        let fun each (_, nil) = z | each (i, x :: rest) = f (i, x, each (i + 1, rest))
        in each (0, toList bytes) end
    fun foldl f z bytes = List.foldl f z (toList bytes)
    fun foldr f z bytes = List.foldr f z (toList bytes)
    fun mapi f bytes = fromList (rev (foldli (fn (i, x, out) => f (i, x) :: out) nil bytes))
    fun map f bytes = fromList (List.map f (toList bytes))
    fun appi f bytes = foldli (fn (i, x, ()) => f (i, x) : unit) () bytes
    fun app f bytes = List.app f (toList bytes)
    fun findi has bytes =
        let fun each (_, nil) = NONE | each (i, x :: rest) = if has (i, x) then SOME (i, x) else each (i + 1, rest)
        in each (0, toList bytes) end
    fun find has bytes = List.find has (toList bytes)
    fun exists has bytes = List.exists has (toList bytes)
    fun all has bytes = List.all has (toList bytes)
end
