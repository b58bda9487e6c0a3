structure ArrayQSort = struct
    type 'a array = 'a Array.array

    fun sorted order (items : 'a array) =
        let fun from i =
                i >= Array.length items orelse
                (order (Array.sub (items, i - 1), Array.sub (items, i)) <> GREATER andalso from (i + 1))
        in from 1 end
    fun sort order (items : 'a array) =
        let fun put (_, nil) = ()
              | put (i, x :: rest) = (Array.update (items, i, x); put (i + 1, rest))
            val unsorted = Array.foldr (fn (x, out) => x :: out) nil items
        in put (0, ListMergeSort.sort (fn pair => order pair = GREATER) unsorted) end
end
