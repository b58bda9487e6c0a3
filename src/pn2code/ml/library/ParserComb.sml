(* Parsers that are put together of smaller ones. *)
structure ParserComb = struct
    type ('a, 's) parser = ('s -> (char * 's) option) -> 's -> ('a * 's) option

    fun result found getc from = SOME (found, from)
    fun failure getc from = NONE

    fun bind (first, next) getc from =
        case first getc from of
            SOME (found, rest) => next found getc rest
          | NONE => NONE

    fun wrap (parser, f) getc from =
        case parser getc from of
            SOME (found, rest) => SOME (f found, rest)
          | NONE => NONE

    fun seqWith f (first, second) getc from =
        case first getc from of
            NONE => NONE
          | SOME (a, rest) => (case second getc rest of
                NONE => NONE
              | SOME (b, rest') => SOME (f (a, b), rest'))
    fun seq (first, second) = seqWith (fn both => both) (first, second)

    fun eatChar wanted getc from =
        case getc from of
            SOME (c, rest) => if wanted c then SOME (c, rest) else NONE
          | NONE => NONE
    fun char c = eatChar (fn c' => c = c')

    fun string wanted getc from =
        let
            fun eat (i, rest) =
                if i = String.size wanted then SOME (wanted, rest)
                else case getc rest of
                    SOME (c, rest') => if c = String.sub (wanted, i) then eat (i + 1, rest') else NONE
                  | NONE => NONE
        in
            eat (0, from)
        end

    fun skipBefore skipped parser getc from =
        let
            fun skip rest =
                case getc rest of
                    SOME (c, rest') => if skipped c then skip rest' else rest
                  | NONE => rest
        in
            parser getc (skip from)
        end

    fun or (first, second) getc from =
        case first getc from of
            NONE => second getc from
          | found => found
    fun or' parsers getc from =
        let
            fun try nil = NONE
              | try (parser :: others) = (case parser getc from of
                    NONE => try others
                  | found => found)
        in
            try parsers
        end

    fun zeroOrMore parser getc from =
        let
            fun more (found, rest) =
                case parser getc rest of
                    SOME (one, rest') => more (one :: found, rest')
                  | NONE => SOME (rev found, rest)
        in
            more (nil, from)
        end
    fun oneOrMore parser getc from =
        case zeroOrMore parser getc from of
            SOME (nil, _) => NONE
          | found => found

    fun option parser getc from =
        case parser getc from of
            SOME (found, rest) => SOME (SOME found, rest)
          | NONE => SOME (NONE, from)
    fun join parser getc from =
        case parser getc from of
            SOME (SOME found, rest) => SOME (found, rest)
          | _ => NONE
    fun token wanted = wrap (oneOrMore (eatChar wanted), implode)
end
