structure HashString = struct
    fun hashString text = List.foldl (fn (c, h) => h * 0w33 + Word.fromInt (Char.ord c) + 0w720) 0w0 (String.explode text)
end
