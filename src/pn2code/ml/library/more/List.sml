(* What SML/NJ has of lists besides the Basis library. *)
structure List = struct
    open List

    fun unfoldl next start =
        let fun more (state, out) = case next state of NONE => rev out | SOME (x, state) => more (state, x :: out)
        in more (start, nil) end
    fun unfoldr next start =
        let fun more (state, out) = case next state of NONE => out | SOME (x, state) => more (state, x :: out)
        in more (start, nil) end
    fun reduce _ empty nil = empty
      | reduce f _ (first :: rest) = foldl f first rest

    fun foldli f start items =
        let fun each (_, nil, out) = out | each (i, x :: rest, out) = each (i + 1, rest, f (i, x, out))
        in each (0, items, start) end
    fun foldri f start items =
        let fun each (_, nil) = start | each (i, x :: rest) = f (i, x, each (i + 1, rest))
        in each (0, items) end
    fun appi f items = foldli (fn (i, x, ()) => f (i, x)) () items
    fun findi has items =
        let fun each (_, nil) = NONE | each (i, x :: rest) = if has (i, x) then SOME (i, x) else each (i + 1, rest)
        in each (0, items) end

    fun revMapi f items = foldli (fn (i, x, out) => f (i, x) :: out) nil items
    fun mapi f items = rev (revMapi f items)
    fun revMapPartiali f items = foldli (fn (i, x, out) => case f (i, x) of SOME y => y :: out | NONE => out) nil items
    fun mapPartiali f items = rev (revMapPartiali f items)
    fun revMap f items = revMapi (fn (_, x) => f x) items
    fun revMapPartial f items = revMapPartiali (fn (_, x) => f x) items
    fun concatMap f items = concat (map f items)
    fun concatMapi f items = concat (mapi f items)
    fun foldMapl f g start items = foldl (fn (x, out) => f (g x, out)) start items
    fun foldMapr f g start items = foldr (fn (x, out) => f (g x, out)) start items

    fun splitAt (items, n) = (take (items, n), drop (items, n))
    fun sub pair = nth pair
    fun update (items, n, x) =
        case splitAt (items, n) of
            (before_it, _ :: behind) => before_it ^^ (x :: behind)
          | _ => raise Subscript
end
