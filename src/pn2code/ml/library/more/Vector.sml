(* What SML/NJ has of vectors besides the Basis library. *)
structure Vector = struct
    open Vector

    fun toList items = foldr (op ::) nil items
    fun append (items, item) = fromList (toList items ^^ [item])
    fun prepend (item, items) = fromList (item :: toList items)
end
