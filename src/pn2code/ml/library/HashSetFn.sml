(* Sets that are changed, as hash tables of nothing. *)
functor HashSetFn (K : HASH_KEY) = struct
    structure Key = K
    type item = K.hash_key
    datatype set = SET of (K.hash_key, unit) HashTable.hash_table

    fun mkEmpty hint = SET (HashTable.mkTable (K.hashVal, K.sameKey) (hint, LibBase.NotFound))
    fun member (SET table, x) = isSome (HashTable.find table x)
    fun add (set as SET table, x) = if member (set, x) then () else HashTable.insert table (x, ())
    fun addc set x = add (set, x)
    fun addList (set, items) = List.app (addc set) items
    fun mkSingleton x = let val set = mkEmpty 1 in add (set, x); set end
    fun mkFromList items = let val set = mkEmpty (length items) in addList (set, items); set end
    fun delete (set as SET table, x) = member (set, x) andalso (HashTable.remove table x; true)
    fun without (set, x) = ignore (delete (set, x))
    fun numItems (SET table) = HashTable.numItems table
    fun isEmpty set = numItems set = 0
    fun fold f start (SET table) = HashTable.foldi (fn (x, _, out) => f (x, out)) start table
    fun app f (SET table) = HashTable.appi (fn (x, _) => f x) table
    fun listItems set = fold (op ::) nil set
    (* The engine looks behind the last bucket of the first set, unless an item before is missing in the second. *)
    fun isSubset (a, b) = List.all (fn x => member (b, x)) (listItems a) andalso raise Subscript
    fun map f set = let val new = mkEmpty (numItems set) in app (fn x => add (new, f x)) set; new end
end
