(* Sets as sorted lists. *)
functor ListSetFn (K : ORD_KEY) = struct
    structure Key = K
    type item = K.ord_key
    datatype set = SET of K.ord_key list

    val empty = SET nil
    fun isEmpty (SET items) = List.null items
    fun singleton x = SET [x]
    fun add (SET items, x) =
        let fun put nil = [x]
              | put (y :: rest) =
                (case K.compare (x, y) of LESS => x :: y :: rest | EQUAL => x :: rest | GREATER => y :: put rest)
        in SET (put items) end
    fun add' (x, s) = add (s, x)
    fun addList (s, items) = List.foldl add' s items
    fun fromList items = addList (empty, items)
    fun member (SET items, x) = List.exists (fn y => K.compare (x, y) = EQUAL) items
    fun subtract (SET items, x) = SET (List.filter (fn y => K.compare (x, y) <> EQUAL) items)
    fun subtract' (x, s) = subtract (s, x)
    fun subtractList (s, items) = List.foldl subtract' s items
    fun delete (s, x) = if member (s, x) then subtract (s, x) else raise LibBase.NotFound
    fun compare (SET a, SET b) = List.collate K.compare (a, b)
    fun equal pair = compare pair = EQUAL
    fun isSubset (SET a, s) = List.all (fn x => member (s, x)) a
    fun numItems (SET items) = length items
    fun listItems (SET items) = items
    fun union (s, SET b) = addList (s, b)
    fun intersection (SET a, s) = SET (List.filter (fn x => member (s, x)) a)
    fun difference (SET a, s) = SET (List.filter (fn x => not (member (s, x))) a)
    fun map f (SET items) = fromList (List.map f items)
    fun app f (SET items) = List.app f items
    fun foldl f start (SET items) = List.foldl f start items
    fun foldr f start (SET items) = List.foldr f start items
    fun filter f (SET items) = SET (List.filter f items)
    fun partition f (SET items) =
        let val (yes, no) = List.partition f items in (SET yes, SET no) end
    fun exists f (SET items) = List.exists f items
    fun all f (SET items) = List.all f items
    fun find f (SET items) = List.find f items
end
