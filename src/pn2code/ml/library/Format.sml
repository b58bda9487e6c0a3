(* Texts made of values by a format, as `sprintf` does in C. A format that is not understood raises BadFormat, where it is applied to
   nothing else; items that are not what it asks for raise BadFmtList. A flag must be followed by `0`, and so has an effect only there:
   the engine reads formats in this way. *)
structure Format = struct
    datatype fmt_item =
        ATOM of Atom.atom | LINT of IntInf.int | INT of int | LWORD of word | WORD of word | WORD8 of Word8.word
      | BOOL of bool | CHR of char | STR of string | REAL of real | LREAL of real
      | LEFT of int * fmt_item | RIGHT of int * fmt_item
    exception BadFormat
    exception BadFmtList

    (* What stands before a number above zero and below it, whether it shows its base or point, whether zeros fill it up; without width
       or precision these are below zero. *)
    type layout = {positive : string, negative : string, base : bool, zeros : bool}
    datatype piece = TEXT of string | FIELD of layout * int * int * char

    fun flags (seen, _, _, _, nil) = if seen then raise BadFormat else raise Option
      | flags (seen, positive, negative, base, c :: rest) =
        (case c of
             #" " => if positive = "+" then raise BadFormat else flags (true, " ", negative, base, rest)
           | #"+" => if positive = " " then raise BadFormat else flags (true, "+", negative, base, rest)
           | #"~" => flags (true, positive, "~", base, rest)
           | #"-" => flags (true, positive, negative, base, rest)
           | #"#" => flags (true, positive, negative, true, rest)
           | #"0" => ({positive = positive, negative = negative, base = base, zeros = true}, rest)
           | _ =>
             if seen then raise BadFormat
             else ({positive = positive, negative = negative, base = base, zeros = false}, c :: rest))

    fun number (value, nil) = (value, nil)
      | number (value, c :: rest) =
        if Char.isDigit c then
            number ((if value < 0 then 0 else value * 10) + (Char.ord c - Char.ord #"0"), rest)
        else (value, c :: rest)

    fun is_real kind = Char.contains "eEfgG" kind
    fun is_whole kind = Char.contains "dxXo" kind

    fun field letters =
        let val (layout, rest) = flags (false, "", "-", false, letters)
            val (width, rest) = number (~1, rest)
            val (precision, rest) =
                case rest of
                    #"." :: rest => (case number (~1, rest) of (~1, _) => raise Option | found => found)
                  | _ => (~1, rest)
        in
            case rest of
                nil => if width < 0 then raise Option else raise BadFormat
              | kind :: rest =>
                if is_real kind orelse precision < 0 andalso
                   (Char.contains "csb" kind orelse is_whole kind andalso (width >= 0 orelse not (#zeros layout)))
                then (FIELD (layout, width, precision, kind), rest)
                else raise BadFormat
        end

    fun pieces (nil, text) = [TEXT (String.implode (List.rev text))]
      | pieces (#"%" :: #"%" :: rest, text) = pieces (rest, #"%" :: text)
      | pieces (#"%" :: rest, text) =
        let val (piece, rest) = field rest
        in TEXT (String.implode (List.rev text)) :: piece :: pieces (rest, nil) end
      | pieces (c :: rest, text) = pieces (rest, c :: text)

    fun place (left, width, text) =
        if left then StringCvt.padRight #" " width text else StringCvt.padLeft #" " width text

    (* A whole number of which the digits are given, with `~` before one below zero. *)
    fun whole ({positive, negative, base, zeros} : layout, left, width, kind, text) =
        let val below = String.isPrefix "~" text
            val digits = if below then String.extract (text, 1, NONE) else text
            val sign = if below then negative else positive
            val front =
                sign ^ (if not base then "" else case kind of #"x" => "0x" | #"X" => "0X" | _ => "")
        in
            if zeros then front ^ StringCvt.padLeft #"0" (width - String.size front) digits
            else place (left, width, front ^ digits)
        end

    fun radix kind =
        case kind of #"d" => StringCvt.DEC | #"o" => StringCvt.OCT | _ => StringCvt.HEX

    fun letters_of (kind, text) = if kind = #"x" then String.map Char.toLower text else text

    (* The fifteen digits of a number above zero, and its power of ten. *)
    fun decimal r =
        let val text = Real.fmt (StringCvt.SCI (SOME 14)) r
            val (digits, power) = Substring.splitl (fn c => c <> #"E") (Substring.full text)
            val power = case Int.fromString (Substring.string (Substring.triml 1 power)) of SOME e => e | NONE => 0
        in (String.implode (List.filter Char.isDigit (Substring.explode digits)), power) end

    (* So many digits, rounded, a half upwards; whether a digit 1 has come in front. *)
    fun rounded (digits, n) =
        let fun up (nil, out) = (out, true)
              | up (#"9" :: rest, out) = up (rest, #"0" :: out)
              | up (c :: rest, out) = (List.revAppend (rest, Char.succ c :: out), false)
        in
            if n < 0 then ("", false)
            else if n >= String.size digits then (StringCvt.padRight #"0" n digits, false)
            else
                let val kept = String.substring (digits, 0, n)
                in
                    if String.sub (digits, n) < #"5" then (kept, false)
                    else
                        let val (out, carried) = up (List.rev (String.explode kept), nil)
                        in (String.implode out, carried) end
                end
        end

    (* One digit before the point and n after it, and the power of ten. *)
    fun scientific (r, n) =
        let val (digits, power) = decimal r
            val (kept, carried) = rounded (digits, n + 1)
        in if carried then ("1" ^ String.substring (kept, 0, n), power + 1) else (kept, power) end

    fun point (whole, part, base) = if part = "" andalso not base then whole else whole ^ "." ^ part

    fun with_power ({negative, base, ...} : layout, digits, power, upper) =
        point (String.substring (digits, 0, 1), String.extract (digits, 1, NONE), base) ^
        (if upper then "E" else "e") ^ (if power < 0 then negative else "") ^
        StringCvt.padLeft #"0" 2 (Int.toString (Int.abs power))

    fun fixed ({base, ...} : layout, r, n) =
        let val (digits, power) = decimal r
            val (kept, carried) = rounded (digits, power + 1 + n)
            val kept = StringCvt.padLeft #"0" (n + 1) (if carried then "1" ^ kept else kept)
            val before_point = String.size kept - n
        in point (String.substring (kept, 0, before_point), String.extract (kept, before_point, NONE), base) end

    fun without_zeros ({base, ...} : layout, text) =
        if base then text else Substring.string (Substring.dropr (fn c => c = #"0") (Substring.full text))

    fun general (layout as {base, ...} : layout, r, n, upper) =
        let val (digits, power) = scientific (r, n - 1)
        in
            if power < ~4 orelse power >= n then
                with_power (layout, String.substring (digits, 0, 1) ^ without_zeros (layout, String.extract (digits, 1, NONE)),
                            power, upper)
            else if power < 0 then
                point ("0", without_zeros (layout, StringCvt.padLeft #"0" (n - power - 1) digits), base)
            else
                point (String.substring (digits, 0, power + 1),
                       without_zeros (layout, String.extract (digits, power + 1, NONE)), base)
        end

    fun fraction (layout as {positive, negative, ...} : layout, left, width, precision, kind, r) =
        let val sign = if r < 0.0 then negative else positive
            val n = if precision < 0 then 6 else precision
            val size = Real.abs r
        in
            if Real.isNan r then "nan"
            else if not (Real.isFinite r) then sign ^ "inf"
            else
                place (left, width, sign ^
                    (case kind of
                         #"f" => fixed (layout, size, n)
                       | #"e" => let val (d, p) = scientific (size, n) in with_power (layout, d, p, false) end
                       | #"E" => let val (d, p) = scientific (size, n) in with_power (layout, d, p, true) end
                       | _ => general (layout, size, if n = 0 then 1 else n, kind = #"G")))
        end

    fun shown (layout, left, width, precision, kind, item) =
        let fun number text =
                if is_whole kind then whole (layout, left, width, kind, text) else raise BadFmtList
            fun plain (wanted, text) = if kind = wanted then place (left, width, text) else raise BadFmtList
        in
            case item of
                LEFT (n, item) => shown (layout, true, n, precision, kind, item)
              | RIGHT (n, item) => shown (layout, false, n, precision, kind, item)
              | INT n => number (letters_of (kind, Int.fmt (radix kind) n))
              | LINT n => number (letters_of (kind, IntInf.fmt (radix kind) n))
              | WORD w => number (Word.fmt (radix kind) w)
              | LWORD w => number (Word.fmt (radix kind) w)
              | WORD8 w => number (Int.fmt (radix kind) (Word8.toInt w))
              | STR s => plain (#"s", s)
              | ATOM a => plain (#"s", Atom.toString a)
              | CHR c => plain (#"c", String.str c)
              | BOOL b => plain (#"b", Bool.toString b)
              | REAL r => if is_real kind then fraction (layout, left, width, precision, kind, r) else raise BadFmtList
              | LREAL _ => raise BadFmtList
        end

    fun filled (nil, nil, out) = String.concat (List.rev out)
      | filled (TEXT text :: rest, items, out) = filled (rest, items, text :: out)
      | filled (FIELD (layout, width, precision, kind) :: rest, item :: items, out) =
        filled (rest, items, shown (layout, false, width, precision, kind, item) :: out)
      | filled _ = raise BadFmtList

    fun format text =
        let val parts = pieces (String.explode text, nil) in fn items => filled (parts, items, nil) end
    fun formatf text =
        let val made = format text in fn consumer => fn items => consumer (made items) : unit end
end
