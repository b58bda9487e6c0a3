(* Hash tables with the order of items that SML/NJ has: a new one comes first in its bucket, growing turns buckets round. *)
structure HashTable = struct
    datatype ('a, 'b) hash_table =
        HASH_TABLE of {hash : 'a -> word, same : 'a * 'a -> bool, missing : exn,
                       buckets : (word * 'a * 'b) list array ref, count : int ref}

    fun at (h, buckets) = Word.toIntX (Word.andb (h, Word.fromInt (Array.length buckets) - 0w1))
    fun mkTable (hash, same) (hint, missing) =
        let fun large n = if n >= hint then n else large (n + n)
        in HASH_TABLE {hash = hash, same = same, missing = missing, buckets = ref (Array.array (large 32, nil)), count = ref 0}
        end
    fun clear (HASH_TABLE {buckets, count, ...}) = (Array.modify (fn _ => nil) (!buckets); count := 0)
    fun turned old =
        let val new = Array.array (2 * Array.length old, nil)
            fun put (item as (h, _, _)) = let val i = at (h, new) in Array.update (new, i, item :: Array.sub (new, i)) end
        in Array.app (List.app put) old; new end
    fun insert (HASH_TABLE {hash, same, buckets, count, ...}) (key, value) =
        let val table = !buckets
            val h = hash key
            val i = at (h, table)
            val bucket = Array.sub (table, i)
            fun here (h', k, _) = h = h' andalso same (key, k)
            fun replaced nil = nil
              | replaced (item :: rest) = if here item then (h, key, value) :: rest else item :: replaced rest
        in
            if List.exists here bucket then Array.update (table, i, replaced bucket)
            else (Array.update (table, i, (h, key, value) :: bucket); count := !count + 1;
                  if !count >= Array.length table then buckets := turned table else ())
        end
    fun find (HASH_TABLE {hash, same, buckets, ...}) key =
        let val h = hash key
        in case List.find (fn (h', k, _) => h = h' andalso same (key, k)) (Array.sub (!buckets, at (h, !buckets))) of
               SOME (_, _, value) => SOME value
             | NONE => NONE
        end
    fun lookup (table as HASH_TABLE {missing, ...}) key =
        case find table key of SOME value => value | NONE => raise missing
    fun remove (table as HASH_TABLE {hash, same, buckets, count, ...}) key =
        let val value = lookup table key
            val h = hash key
            val i = at (h, !buckets)
            fun without nil = nil
              | without ((item as (h', k, _)) :: rest) = if h = h' andalso same (key, k) then rest else item :: without rest
        in Array.update (!buckets, i, without (Array.sub (!buckets, i))); count := !count - 1; value end
    fun numItems (HASH_TABLE {count, ...}) = !count
    fun foldi f start (HASH_TABLE {buckets, ...}) =
        Array.foldl (fn (bucket, out) => List.foldl (fn ((_, k, v), out) => f (k, v, out)) out bucket) start (!buckets)
    fun fold f start table = foldi (fn (_, v, out) => f (v, out)) start table
    fun listItemsi (HASH_TABLE {buckets, ...}) =
        Array.foldr (fn (bucket, out) => List.foldl (fn ((_, k, v), out) => (k, v) :: out) out bucket) nil (!buckets)
    fun listItems table = List.map (fn (_, v) => v) (listItemsi table)
    fun appi f (HASH_TABLE {buckets, ...}) = Array.app (List.app (fn (_, k, v) => f (k, v))) (!buckets)
    fun app f table = appi (fn (_, v) => f v) table
    fun mapi f (HASH_TABLE {hash, same, missing, buckets, count}) =
        let val new = Array.array (Array.length (!buckets), nil)
            fun put (i, bucket) = Array.update (new, i, List.map (fn (h, k, v) => (h, k, f (k, v))) bucket)
        in Array.appi put (!buckets);
           HASH_TABLE {hash = hash, same = same, missing = missing, buckets = ref new, count = ref (!count)} end
    fun map f table = mapi (fn (_, v) => f v) table
    fun copy table = map (fn v => v) table
    fun modifyi f (HASH_TABLE {buckets, ...}) =
        Array.modify (List.map (fn (h, k, v) => (h, k, f (k, v)))) (!buckets)
    fun modify f table = modifyi (fn (_, v) => f v) table
    fun filteri wanted (HASH_TABLE {buckets, count, ...}) =
        (Array.modify (List.filter (fn (_, k, v) => wanted (k, v))) (!buckets);
         count := Array.foldl (fn (bucket, n) => n + List.length bucket) 0 (!buckets))
    fun filter wanted table = filteri (fn (_, v) => wanted v) table
    fun bucketSizes (HASH_TABLE {buckets, ...}) = Array.foldr (fn (bucket, out) => List.length bucket :: out) nil (!buckets)
end
