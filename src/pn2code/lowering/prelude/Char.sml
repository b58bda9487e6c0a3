val Char_minChar = #"\000"
val Char_maxChar = #"\255"
val Char_maxOrd = 255

fun Char_succ c = chr (ord c + 1)

fun Char_pred c = chr (ord c - 1)

fun Char_isAscii c = ord c < 128

fun Char_isCntrl c = ord c < 32 orelse ord c = 127

fun Char_isGraph c = ord c > 32 andalso ord c < 127

fun Char_isPrint c = ord c >= 32 andalso ord c < 127

fun Char_isPunct c = Char_isGraph c andalso not (Char.isAlphaNum c)

fun Char_isHexDigit c =
    Char.isDigit c orelse (#"a" <= c andalso c <= #"f") orelse (#"A" <= c andalso c <= #"F")

fun Char_contains s c =
    let val n = String.size s
        fun loop i = i < n andalso (String.sub (s, i) = c orelse loop (i + 1))
    in loop 0 end

fun Char_notContains s c = not (Char_contains s c)

fun three (n, base) = implode (List.map (fn d => chr (48 + d)) [n div (base * base), n div base mod base, n mod base])

fun Char_toString c =
    case ord c of
        34 => "\\\""
      | 92 => "\\\\"
      | 7 => "\\a"
      | 8 => "\\b"
      | 9 => "\\t"
      | 10 => "\\n"
      | 11 => "\\v"
      | 12 => "\\f"
      | 13 => "\\r"
      | n => if n < 32 then "\\^" ^ str (chr (n + 64)) else if n < 127 then str c else "\\" ^ three (n, 10)

fun Char_toCString c =
    case ord c of
        34 => "\\\""
      | 39 => "\\'"
      | 63 => "\\?"
      | 92 => "\\\\"
      | 7 => "\\a"
      | 8 => "\\b"
      | 9 => "\\t"
      | 10 => "\\n"
      | 11 => "\\v"
      | 12 => "\\f"
      | 13 => "\\r"
      | n => if n < 32 orelse n > 126 then "\\" ^ three (n, 8) else str c

(* The characters that stand for a control character after a backslash, in the order of their codes from 7 on. *)
fun control c =
    case c of
        #"a" => SOME (chr 7)
      | #"b" => SOME (chr 8)
      | #"t" => SOME (chr 9)
      | #"n" => SOME (chr 10)
      | #"v" => SOME (chr 11)
      | #"f" => SOME (chr 12)
      | #"r" => SOME (chr 13)
      | #"\\" => SOME c
      | #"\"" => SOME c
      | _ => NONE

fun hex c = if Char.isDigit c then ord c - 48 else ord (Char.toUpper c) - 55

fun code (n, base, digits, 0) = if n < 256 then SOME (chr n) else NONE
  | code (n, base, nil, _) = NONE
  | code (n, base, c :: rest, k) =
    if Char_isHexDigit c andalso hex c < base then code (n * base + hex c, base, rest, k - 1) else NONE

(* So many characters from a stream, those that there are. *)
fun several (getc, stream, 0, out) = (rev out, stream)
  | several (getc, stream, n, out) =
    case getc stream of SOME (c, rest) => several (getc, rest, n - 1, c :: out) | NONE => (rev out, stream)

(* What follows a gap `\   \` of which the backslash has been read. *)
fun beyond_gap (getc, stream) =
    case getc stream of
        SOME (#"\\", rest) => SOME rest
      | SOME (c, rest) => if Char.isSpace c then beyond_gap (getc, rest) else NONE
      | NONE => NONE

fun Char_scan getc stream =
    case getc stream of
        NONE => NONE
      | SOME (#"\\", stream) =>
        (case getc stream of
             NONE => NONE
           | SOME (#"^", stream) =>
             (case getc stream of
                  NONE => NONE
                | SOME (c, stream) =>
                  if ord c >= 64 andalso ord c <= 95 then SOME (chr (ord c - 64), stream) else NONE)
           | SOME (#"u", stream) =>
             let val (digits, stream) = several (getc, stream, 4, nil)
             in case code (0, 16, digits, 4) of SOME c => SOME (c, stream) | NONE => NONE end
           | SOME (c, next) =>
             if Char.isDigit c then
                 let val (digits, next) = several (getc, next, 2, nil)
                 in case code (0, 10, c :: digits, 3) of SOME c => SOME (c, next) | NONE => NONE end
             else if Char.isSpace c then
                 case beyond_gap (getc, next) of SOME rest => Char_scan getc rest | NONE => NONE
             else (case control c of SOME c => SOME (c, next) | NONE => NONE))
      | SOME (c, stream) => if Char_isPrint c then SOME (c, stream) else NONE

fun Char_fromString s =
    case Char_scan (fn i => if i < String.size s then SOME (String.sub (s, i), i + 1) else NONE) 0 of
        SOME (c, _) => SOME c
      | NONE => NONE

fun Char_fromCString s =
    let fun at i = if i < String.size s then String.sub (s, i) else #"\000"
        fun octal c = #"0" <= c andalso c <= #"7"
        fun number (i, most, base, p, n) =
            if n > 255 then n
            else if i < String.size s andalso most > 0 andalso p (at i) then number (i + 1, most - 1, base, p, n * base + hex (at i))
            else n
        fun character n = if n < 256 then SOME (chr n) else NONE
    in
        if s = "" then NONE
        else if at 0 <> #"\\" then (if Char_isPrint (at 0) then SOME (at 0) else NONE)
        else if at 1 = #"?" orelse at 1 = #"'" then SOME (at 1)
        else if at 1 = #"x" then
            (if Char_isHexDigit (at 2) then character (number (2, 1000, 16, Char_isHexDigit, 0)) else NONE)
        else if at 1 = #"^" then
            (if ord (at 2) >= 64 andalso ord (at 2) <= 95 then SOME (chr (ord (at 2) - 64)) else NONE)
        else if octal (at 1) then character (number (1, 3, 8, octal, 0))
        else control (at 1)
    end
