(* What stands at a position of reals when they are sorted. SML/NJ sorts the array partly; here it stays as it is. *)
structure RealOrderStats = struct
    fun ordered items = ListMergeSort.sort (fn (a : real, b) => a > b) items
    fun middle items =
        let val sorted = ordered items
            val half = List.length items div 2
        in
            if List.length items mod 2 = 1 then List.nth (sorted, half)
            else (List.nth (sorted, half - 1) + List.nth (sorted, half)) / 2.0
        end
    fun items whole = Array.foldr (op ::) nil whole
    fun elements part = ArraySlice.foldr (op ::) nil part
    fun select (whole, i) = List.nth (ordered (items whole), i)
    fun select' (part, i) = List.nth (ordered (elements part), i)
    fun median whole = middle (items whole)
    fun median' part = middle (elements part)
end
