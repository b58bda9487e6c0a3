fun StringCvt_padLeft c n s =
    let val m = n - String.size s
    in
        if n > String.maxSize then raise Size
        else if m > 0 then implode (List.tabulate (m, fn _ => c)) ^ s
        else s
    end

fun StringCvt_padRight c n s =
    let val m = n - String.size s
    in
        if n > String.maxSize then raise Size
        else if m > 0 then s ^ implode (List.tabulate (m, fn _ => c))
        else s
    end

fun StringCvt_splitl p getc stream =
    let fun loop (stream, out) =
            case getc stream of
                SOME (c, rest) => if p c then loop (rest, c :: out) else (implode (rev out), stream)
              | NONE => (implode (rev out), stream)
    in loop (stream, nil) end

fun StringCvt_takel p getc stream = #1 (StringCvt_splitl p getc stream)

fun StringCvt_dropl p getc stream =
    case getc stream of
        SOME (c, rest) => if p c then StringCvt_dropl p getc rest else stream
      | NONE => stream

fun StringCvt_skipWS getc stream = StringCvt_dropl Char.isSpace getc stream

fun StringCvt_scanString scan s =
    case scan (fn i => if i < String.size s then SOME (String.sub (s, i), i + 1) else NONE) 0 of
        SOME (x, _) => SOME x
      | NONE => NONE
