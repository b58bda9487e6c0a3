(* Hash tables with keys of one type. *)
functor HashTableFn (K : HASH_KEY) = struct
    structure Key = K
    open HashTable
    type 'a hash_table = (K.hash_key, 'a) HashTable.hash_table
    fun mkTable (hint, missing) = HashTable.mkTable (K.hashVal, K.sameKey) (hint, missing)
end
