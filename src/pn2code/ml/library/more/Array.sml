(* What SML/NJ has of arrays besides the Basis library. *)
structure Array = struct
    open Array

    fun toList items = foldr (op ::) nil items
    fun toVector items = vector items
    fun fromVector items = tabulate (Vector.length items, fn i => Vector.sub (items, i))
end
