(* Texts as vectors of characters. *)
structure CharVector = struct
    type elem = char
    type vector = string
    val maxLen = String.maxSize

    fun sub (text, i) = String.sub (text, i)
    fun length text = String.size text
    fun fromList letters = String.implode letters
    fun toList text = String.explode text
    fun concat texts = String.concat texts
    fun collate order (a, b) = List.collate order (String.explode a, String.explode b)
    fun tabulate (n, f) = if n < 0 orelse n > maxLen then raise Size else String.implode (List.tabulate (n, f))
    fun map f text = String.map f text
    fun update (text, i, c) =
        if i < 0 orelse i >= String.size text then raise Subscript
        else String.substring (text, 0, i) ^ String.str c ^ String.extract (text, i + 1, NONE)
    fun append (text, c) = text ^ String.str c
    fun prepend (c, text) = String.str c ^ text

    fun foldli f start text =
        let fun each (i, out) = if i = String.size text then out else each (i + 1, f (i, String.sub (text, i), out))
        in each (0, start) end
    fun foldri f start text =
        let fun each (i, out) = if i < 0 then out else each (i - 1, f (i, String.sub (text, i), out))
        in each (String.size text - 1, start) end
    fun foldl f = foldli (fn (_, c, out) => f (c, out))
    fun foldr f = foldri (fn (_, c, out) => f (c, out))
    fun mapi f text = String.implode (List.rev (foldli (fn (i, c, out) => f (i, c) :: out) nil text))
    fun appi f = foldli (fn (i, c, ()) => f (i, c) : unit) ()
    fun app f = appi (fn (_, c) => f c)
    fun findi f text =
        let fun from i =
                if i = String.size text then NONE
                else let val found = (i, String.sub (text, i)) in if f found then SOME found else from (i + 1) end
        in from 0 end
    fun find f text = case findi (fn (_, c) => f c) text of SOME (_, c) => SOME c | NONE => NONE
    fun exists f text = case find f text of SOME _ => true | NONE => false
    fun all f text = not (exists (fn c => not (f c)) text)
end
