(* Bytes as characters, in parts of vectors and arrays. *)
structure Byte = struct
    open Byte

    fun unpackStringVec bytes = bytesToString (Word8VectorSlice.vector bytes)
    fun unpackString bytes = bytesToString (Word8ArraySlice.vector bytes)
    fun packString (bytes, at, text) =
        Word8Array.copyVec {src = stringToBytes (Substring.string text), dst = bytes, di = at}
end
