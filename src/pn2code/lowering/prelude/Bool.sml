(* Reads the letters of a word; capital ones are others, as in SML/NJ. *)
fun word (getc, stream, nil) = SOME stream
  | word (getc, stream, c :: rest) =
    case getc stream of
        SOME (d, next) => if d = c then word (getc, next, rest) else NONE
      | NONE => NONE

fun Bool_scan getc stream =
    let val stream = StringCvt.skipWS getc stream
    in
        case word (getc, stream, explode "true") of
            SOME rest => SOME (true, rest)
          | NONE => (case word (getc, stream, explode "false") of SOME rest => SOME (false, rest) | NONE => NONE)
    end

fun Bool_fromString s = StringCvt.scanString Bool_scan s
