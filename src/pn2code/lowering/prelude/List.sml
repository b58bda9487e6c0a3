fun List_getItem nil = NONE
  | List_getItem (x :: rest) = SOME (x, rest)

fun List_collate cmp =
    let fun loop (nil, nil) = EQUAL
          | loop (nil, _) = LESS
          | loop (_, nil) = GREATER
          | loop (x :: xs, y :: ys) =
            (case cmp (x, y) of EQUAL => loop (xs, ys) | LESS => LESS | GREATER => GREATER)
    in loop end

fun List_partition p xs =
    let fun loop (nil, yes, no) = (rev yes, rev no)
          | loop (x :: rest, yes, no) = if p x then loop (rest, x :: yes, no) else loop (rest, yes, x :: no)
    in loop (xs, nil, nil) end

fun List_predlist p xs = List.exists p xs

fun List_mapfilter (f, xs) =
    let fun loop (nil, out) = rev out
          | loop (x :: rest, out) = (case !f x of (true, y) => loop (rest, y :: out) | (false, _) => loop (rest, out))
    in loop (xs, nil) end
