(* Tables with a value for each character. *)
structure CharMap = struct
    datatype 'a char_map = CharMap of 'a vector

    fun mkCharMap {default, bindings} =
        let val values = Array.array (256, default)
            fun each (letters, x) = List.app (fn c => Array.update (values, Char.ord c, x)) (String.explode letters)
        in (List.app each bindings; CharMap (Array.vector values)) end
    fun mapChr (CharMap values) c = Vector.sub (values, Char.ord c)
    fun mapStrChr table (text, i) = mapChr table (String.sub (text, i))
end
