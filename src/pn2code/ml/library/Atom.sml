structure Atom = struct
    datatype atom = ATOM of string

    fun atom text = ATOM text
    fun atom' text = ATOM (Substring.string text)
    fun toString (ATOM text) = text
    fun same (ATOM a, ATOM b) = a = b
    fun sameAtom pair = same pair
    fun lexCompare (ATOM a, ATOM b) = String.compare (a, b)
    fun hash (ATOM text) = HashString.hashString text
    fun compare (a, b) =
        case Word.compare (hash a, hash b) of
            EQUAL => lexCompare (a, b)
          | other => other
end
