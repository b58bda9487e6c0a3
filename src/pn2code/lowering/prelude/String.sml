fun String_extract (s, from, NONE) =
    if from < 0 then raise Subscript else substring (s, from, String.size s - from)
  | String_extract (s, from, SOME n) = substring (s, from, n)

fun String_concatWith separator nil = ""
  | String_concatWith separator (first :: rest) =
    let fun loop (nil, out) = concat (rev out)
          | loop (x :: xs, out) = loop (xs, x :: separator :: out)
    in loop (rest, [first]) end

fun String_map f s = implode (List.map f (explode s))

fun String_translate f s = concat (List.map f (explode s))

fun String_fields p s =
    let val n = String.size s
        fun loop (i, from, out) =
            if i = n then rev (substring (s, from, i - from) :: out)
            else if p (String.sub (s, i)) then loop (i + 1, i + 1, substring (s, from, i - from) :: out)
            else loop (i + 1, from, out)
    in loop (0, 0, nil) end

fun String_tokens p s =
    let val n = String.size s
        fun part (from, i, out) = if from = i then out else substring (s, from, i - from) :: out
        fun loop (i, from, out) =
            if i = n then rev (part (from, i, out))
            else if p (String.sub (s, i)) then loop (i + 1, i + 1, part (from, i, out))
            else loop (i + 1, from, out)
    in loop (0, 0, nil) end

fun String_collate cmp (a, b) = List.collate cmp (explode a, explode b)

fun String_toString s = concat (List.map Char.toString (explode s))

fun String_toCString s = concat (List.map Char.toCString (explode s))

val String_maxSize = 16777215

(* Position of what follows a gap `\   \`, or of the backslash if it is none. *)
fun after_gap (s, i) =
    let val n = String.size s
        fun blanks j = if j < n andalso Char.isSpace (String.sub (s, j)) then blanks (j + 1) else j
    in
        if i + 1 < n andalso String.sub (s, i) = #"\\" andalso Char.isSpace (String.sub (s, i + 1)) then
            let val j = blanks (i + 1)
            in if j < n andalso String.sub (s, j) = #"\\" then after_gap (s, j + 1) else i end
        else i
    end

fun reader s i = if i < String.size s then SOME (String.sub (s, i), i + 1) else NONE

fun String_fromString s =
    let fun loop (i, out, any) =
            case Char.scan (reader s) (after_gap (s, i)) of
                SOME (c, j) => loop (j, c :: out, true)
              | NONE => if any orelse after_gap (s, i) = String.size s then SOME (implode (rev out)) else NONE
    in loop (0, nil, false) end

fun String_fromCString s =
    let fun loop (i, out) =
            if i = String.size s then SOME (implode (rev out))
            else case Char.fromCString (substring (s, i, String.size s - i)) of
                     NONE => if i = 0 then NONE else SOME (implode (rev out))
                   | SOME c => loop (next i, c :: out)
        and next i =
            if String.sub (s, i) <> #"\\" then i + 1
            else
                let val c = String.sub (s, i + 1)
                    fun digits (j, most, p) =
                        if j < String.size s andalso most > 0 andalso p (String.sub (s, j)) then digits (j + 1, most - 1, p)
                        else j
                in
                    if c = #"x" then digits (i + 2, 1000, Char.isHexDigit)
                    else if c = #"^" then i + 3
                    else if Char.isDigit c then digits (i + 1, 3, fn d => #"0" <= d andalso d <= #"7")
                    else i + 2
                end
    in loop (0, nil) end
