(* Formats made of functions: each fragment takes the arguments that it writes. A format has the pieces before it, the
   last one first. *)
structure FormatComb = struct
    type 'a format = string list -> 'a
    type ('a, 'b) fragment = 'a format -> 'b format
    type 'a glue = ('a, 'a) fragment
    type ('a, 'b) element = ('a, 'b -> 'a) fragment
    datatype place = Left | Center | Right

    fun format' receive fragment = fragment (fn pieces => receive (rev pieces)) nil
    fun format fragment = format' concat fragment
    fun using text next pieces x = next (text x :: pieces)
    fun int next = using Int.toString next
    fun real next = using Real.toString next
    fun bool next = using Bool.toString next
    fun string next = using (fn s => s) next
    fun string' next = using String.toString next
    fun char next = using String.str next
    fun char' next = using Char.toString next
    fun int' radix next = using (Int.fmt radix) next
    fun real' kind next = using (Real.fmt kind) next

    fun glue element x next pieces = element next pieces x
    fun elem maker next pieces x = maker x next pieces
    fun nothing next = next
    fun text s next pieces = next (s :: pieces)
    fun sp n = text (StringCvt.padLeft #" " n "")
    fun nl next = text "\n" next
    fun tab next = text "\t" next

    (* What remains, as the first item of it and behind another one. *)
    type 'a gg = 'a glue * 'a glue
    fun seqg (fold : ('b * 'a gg -> 'a gg) -> 'a gg -> 'c -> 'a gg) between maker items =
        let fun put (x, (_, behind)) = (maker x o behind, between o maker x o behind)
            val (all, _) = fold put (nothing, nothing) items
        in all end
    fun seq fold between element = elem (seqg fold between (glue element))
    fun listg maker items = text "[" o seqg List.foldr (text ", ") maker items o text "]"
    fun list element = elem (listg (glue element))
    fun optiong _ NONE = text "NONE"
      | optiong maker (SOME x) = text "SOME(" o maker x o text ")"
    fun option element = elem (optiong (glue element))

    val left = Left
    val center = Center
    val right = Right
    fun padded Left n s = StringCvt.padLeft #" " n s
      | padded Right n s = StringCvt.padRight #" " n s
      | padded Center n s =
        StringCvt.padRight #" " n (StringCvt.padLeft #" " (String.size s + (n - String.size s) div 2) s)
    fun trimmed place n s =
        let val more = String.size s - n
            val start = case place of Left => more | Center => more div 2 | Right => 0
        in if more <= 0 then s else String.substring (s, start, n) end
    fun adjusted change fragment next pieces = fragment (fn inner => next (change (concat (rev inner)) :: pieces)) nil
    fun pad place n fragment = adjusted (padded place n) fragment
    fun trim place n fragment = adjusted (trimmed place n) fragment
    fun fit place n fragment = adjusted (padded place n o trimmed place n) fragment
    fun padl n fragment = pad Left n fragment
    fun padr n fragment = pad Right n fragment
end
