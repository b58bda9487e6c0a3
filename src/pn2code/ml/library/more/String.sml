(* What SML/NJ has of strings besides the Basis library. *)
structure String = struct
    open String

    fun rev text = implode (List.rev (explode text))
    fun implodeRev letters = implode (List.rev letters)
    fun blanks next at =
        case next at of
            SOME (#"\\", rest) => SOME rest
          | SOME (c, rest) => if Char.isSpace c then blanks next rest else NONE
          | NONE => NONE
    (* What follows gaps `\   \`, which stand for nothing. *)
    fun beyond_gaps next at =
        case next at of
            SOME (#"\\", rest) =>
            (case next rest of
                 SOME (c, _) =>
                 if Char.isSpace c then case blanks next rest of SOME end_ => beyond_gaps next end_ | NONE => at else at
               | NONE => at)
          | _ => at
    fun scan next at =
        let fun each (at, out) =
                case (Char.scan next at, out) of
                    (SOME (c, rest), _) => each (rest, c :: out)
                  | (NONE, nil) =>
                    let val rest = beyond_gaps next at in case next rest of SOME _ => NONE | NONE => SOME ("", rest) end
                  | _ => SOME (implodeRev out, beyond_gaps next at)
        in each (at, nil) end
    fun concatWithMap separator f items = concatWith separator (List.map f items)
end
