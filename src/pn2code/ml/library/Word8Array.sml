(* Arrays of bytes. *)
structure Word8Array = struct
    open Array
    type elem = Word8.word
    type array = Word8.word Array.array
    type vector = Word8Vector.vector

    val array : int * elem -> array = Array.array
    val fromList : elem list -> array = Array.fromList
    val tabulate : int * (int -> elem) -> array = Array.tabulate
    val sub : array * int -> elem = Array.sub
    val update : array * int * elem -> unit = Array.update
    val length : array -> int = Array.length
    fun toList (bytes : array) = foldr (op ::) nil bytes
    fun vector (bytes : array) = Word8Vector.fromList (toList bytes)
    fun toVector (bytes : array) = vector bytes
    fun fromVector bytes = tabulate (Word8Vector.length bytes, fn i => Word8Vector.sub (bytes, i))
    fun copyVec {src : vector, dst : array, di : int} =
        Array.copyVec {src = Vector.fromList (Word8Vector.toList src), dst = dst, di = di}
end
