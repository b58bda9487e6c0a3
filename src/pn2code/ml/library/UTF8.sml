(* Characters of up to three bytes. *)
structure UTF8 = struct
    type wchar = word
    exception Incomplete

    val maxCodePoint = 0wx10FFFF
    fun code c = Word.fromInt (Char.ord c)
    fun further getc (sum, rest) =
        case getc rest of
            NONE => raise Incomplete
          | SOME (c, rest) =>
            if Word.andb (code c, 0wxC0) = 0wx80
            then (Word.orb (Word.<< (sum, 0w6), Word.andb (code c, 0wx3F)), rest)
            else raise Incomplete
    fun getu getc rest =
        case getc rest of
            NONE => NONE
          | SOME (c, rest) =>
            if code c < 0w128 then SOME (code c, rest)
            else if Word.andb (code c, 0wxE0) = 0wxC0 then SOME (further getc (Word.andb (code c, 0wx1F), rest))
            else if Word.andb (code c, 0wxE0) = 0wxE0
            then SOME (further getc (further getc (Word.andb (code c, 0wxF), rest)))
            else raise Incomplete
    fun fold f start text =
        let fun each (rest, out) =
                case getu Substring.getc rest of NONE => out | SOME (w, rest) => each (rest, f (w, out))
        in each (Substring.full text, start) end
    fun explode text = rev (fold (op ::) nil text)
    fun size text = fold (fn (_, n) => n + 1) 0 text

    fun byte w = Char.chr (Word.toInt w)
    fun last (w, shift) = byte (Word.orb (0wx80, Word.andb (Word.>> (w, shift), 0wx3F)))
    fun encode (w : wchar) =
        if w < 0wx80 then str (byte w)
        else if w < 0wx800 then implode [byte (Word.orb (0wxC0, Word.>> (w, 0w6))), last (w, 0w0)]
        else implode [byte (Word.orb (0wxE0, Word.>> (w, 0w12))), last (w, 0w6), last (w, 0w0)]
    fun isAscii (w : wchar) = w < 0wx80
    fun toAscii (w : wchar) = byte (Word.andb (w, 0wx7F))
    fun fromAscii c = Word.andb (code c, 0wx7F)
    fun toString (w : wchar) =
        if isAscii w then Char.toCString (toAscii w) else "\\u" ^ StringCvt.padLeft #"0" 4 (Word.toString w)
end
