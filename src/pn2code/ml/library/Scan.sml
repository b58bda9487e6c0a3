(* The reverse of `Format`: values read by a format; NONE where the text does not fit. A width counts for texts alone. *)
structure Scan = struct
    datatype fmt_item = datatype Format.fmt_item
    exception BadFormat = Format.BadFormat

    fun word (next, at, left, out) =
        case if left = 0 then NONE else next at of
            SOME (c, rest) => if Char.isSpace c then (String.implode (List.rev out), at) else word (next, rest, left - 1, c :: out)
          | NONE => (String.implode (List.rev out), at)

    fun value (kind, width, next) =
        let fun as_item make scan at = case scan next at of SOME (x, at) => SOME (make x, at) | NONE => NONE
            fun blanks read at = read (StringCvt.skipWS next at)
        in
            case kind of
                #"d" => as_item INT (Int.scan StringCvt.DEC)
              | #"o" => as_item INT (Int.scan StringCvt.OCT)
              | #"b" => as_item BOOL Bool.scan
              | #"s" => blanks (fn at => let val (text, at) = word (next, at, width, nil) in SOME (STR text, at) end)
              | #"c" => blanks (fn at => case next at of SOME (c, at) => SOME (CHR c, at) | NONE => NONE)
              | _ =>
                if Format.is_real kind then as_item REAL Real.scan else as_item INT (Int.scan StringCvt.HEX)
        end

    (* A blank stands for any number of blanks, another character for itself. *)
    fun text (next, nil, at) = SOME at
      | text (next, c :: rest, at) =
        if Char.isSpace c then text (next, rest, StringCvt.skipWS next at)
        else
            case next at of
                SOME (found, at) => if found = c then text (next, rest, at) else NONE
              | NONE => NONE

    fun all (next, nil, at, out) = SOME (List.rev out, at)
      | all (next, Format.TEXT wanted :: rest, at, out) =
        (case text (next, String.explode wanted, at) of SOME at => all (next, rest, at, out) | NONE => NONE)
      | all (next, Format.FIELD (_, width, _, kind) :: rest, at, out) =
        (case value (kind, width, next) at of SOME (x, at) => all (next, rest, at, x :: out) | NONE => NONE)

    fun scanf format =
        let val parts = Format.pieces (String.explode format, nil)
        in fn next => fn at => all (next, parts, at, nil) end
    fun sscanf format = let val scan = scanf format in fn text => StringCvt.scanString scan text end
end
