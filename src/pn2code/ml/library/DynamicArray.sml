(* Arrays that grow: behind the last item that was set, every item is the default. *)
structure DynamicArray = struct
    datatype 'a array = DARRAY of 'a Array.array ref * 'a * int ref

    fun array (size, default) = DARRAY (ref (Array.array (size, default)), default, ref ~1)
    fun filled (items, default) = DARRAY (ref items, default, ref (Array.length items - 1))
    fun fromList (items, default) = filled (Array.fromList items, default)
    fun tabulate (size, f, default) = filled (Array.tabulate (size, f), default)
    fun default (DARRAY (_, x, _)) = x
    fun bound (DARRAY (_, _, last)) = !last
    fun sub (DARRAY (items, default, _), i) =
        if i < 0 then raise Subscript
        else if i < Array.length (!items) then Array.sub (!items, i)
        else default
    fun update (DARRAY (items, default, last), i, x) =
        let fun grown size = if size > i then size else grown (2 * size)
            val old = !items
            fun item i = if i < Array.length old then Array.sub (old, i) else default
        in
            if i < 0 then raise Subscript else ();
            if i < Array.length old then () else items := Array.tabulate (grown (Array.length old + 1), item);
            Array.update (!items, i, x);
            if i > !last then last := i else ()
        end
    fun truncate (DARRAY (items, default, last), size) =
        let fun clear i = if i > !last then () else (Array.update (!items, i, default); clear (i + 1))
            val size = if size < 0 then 0 else size
        in if size > !last then () else (clear size; last := size - 1) end
    fun subArray (items, first, last) =
        let fun item i = sub (items, first + i)
            val size = Int.min (last, bound items) - first + 1
        in if first < 0 then raise Subscript else tabulate (if size < 0 then 0 else size, item, default items) end

    fun foldli f start items =
        let fun each (i, out) = if i > bound items then out else each (i + 1, f (i, sub (items, i), out))
        in each (0, start) end
    fun foldri f start items =
        let fun each (i, out) = if i < 0 then out else each (i - 1, f (i, sub (items, i), out))
        in each (bound items, start) end
    fun foldl f start items = foldli (fn (_, x, out) => f (x, out)) start items
    fun foldr f start items = foldri (fn (_, x, out) => f (x, out)) start items
    fun elements items = foldr (fn (x, out) => x :: out) nil items
    fun vector items = Vector.fromList (elements items)
    fun appi f items = foldli (fn (i, x, ()) => f (i, x) : unit) () items
    fun app f items = appi (fn (_, x) => f x) items
    fun modifyi f items = appi (fn (i, x) => update (items, i, f (i, x))) items
    fun modify f items = modifyi (fn (_, x) => f x) items
    fun findi has items =
        let fun from i =
                if i > bound items then NONE
                else if has (i, sub (items, i)) then SOME (i, sub (items, i))
                else from (i + 1)
        in from 0 end
    fun find has items = case findi (fn (_, x) => has x) items of SOME (_, x) => SOME x | NONE => NONE
    fun exists has items = case find has items of SOME _ => true | NONE => false
    fun all has items = not (exists (fn x => not (has x)) items)
    fun collate order (a, b) = List.collate order (elements a, elements b)
end
