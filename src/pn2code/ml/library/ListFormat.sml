structure ListFormat = struct
    fun fmt {init, sep, final, fmt} items = init ^ String.concatWith sep (List.map fmt items) ^ final
    fun listToString f items = fmt {init = "[", sep = ",", final = "]", fmt = f} items

    (* White space before each of the texts is skipped; an empty text is always there. *)
    fun scan {init, sep, final, scan} next =
        let fun letters (nil, at) = SOME at
              | letters (x :: rest, at) =
                (case next at of
                     SOME (y, at) => if x = y then letters (rest, at) else NONE
                   | NONE => NONE)
            val texts = List.map (fn text => String.explode text) [init, sep, final]
            fun accept i =
                let val text = List.nth (texts, i)
                    val blanks = case text of nil => (fn at => at) | _ => StringCvt.skipWS next
                in fn at => letters (text, blanks at) end
            val (first, between, last) = (accept 0, accept 1, accept 2)
            fun items (at, out) =
                case scan next at of
                    NONE => NONE
                  | SOME (x, at) =>
                    (case between at of
                         SOME at => items (at, x :: out)
                       | NONE => (case last at of SOME at => SOME (rev (x :: out), at) | NONE => NONE))
        in
            fn at =>
                case first at of
                    NONE => NONE
                  | SOME at => (case last at of SOME at => SOME (nil, at) | NONE => items (at, nil))
        end
end
