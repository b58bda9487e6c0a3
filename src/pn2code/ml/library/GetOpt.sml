(* The options of a command line. *)
structure GetOpt = struct
    datatype 'a arg_order = RequireOrder | Permute | ReturnInOrder of string -> 'a
    datatype 'a arg_descr =
        NoArg of unit -> 'a | ReqArg of (string -> 'a) * string | OptArg of (string option -> 'a) * string
    type 'a opt_descr = {short : string, long : string list, desc : 'a arg_descr, help : string}

    fun shown (NoArg _, name, _, _) = name
      | shown (ReqArg (_, what), name, sign, _) = name ^ sign ^ what
      | shown (OptArg (_, what), name, _, sign) = name ^ "[" ^ sign ^ what ^ "]"
    fun row ({short, long, desc, help} : 'a opt_descr) =
        (String.concatWith ", " (map (fn c => shown (desc, "-" ^ str c, " ", "")) (explode short)),
         String.concatWith ", " (map (fn name => shown (desc, "--" ^ name, "=", "=")) long), help)
    fun usageInfo {header, options} =
        let val rows = map row options
            fun widest part = foldl (fn (r, n) => Int.max (String.size (part r), n)) 0 rows
            val first = widest (fn (a, _, _) => a)
            val second = widest (fn (_, b, _) => b)
            fun line (a, b, c) =
                concat ["  ", StringCvt.padRight #" " first a, "  ", StringCvt.padRight #" " second b, "  ", c]
            fun lines (a, b, c) =
                case String.fields (fn c => c = #"\n") c of
                    nil => nil
                  | c :: more => line (a, b, c) :: map (fn c => StringCvt.padLeft #" " (first + second + 6) "" ^ c) more
        in String.concatWith "\n" (header :: foldr (fn (row, rest) => List.@ (lines row, rest)) [""] rows) end

    fun getOpt {argOrder, options : 'a opt_descr list, errFn} =
        let fun refused (name, why) = errFn ("option `" ^ name ^ "' " ^ why)
            fun unknown name = errFn ("unrecognized option `" ^ name ^ "'")
            fun ambiguous (name, found) =
                errFn (usageInfo {header = "option `" ^ name ^ "' is ambiguous; could be one of:", options = found})
            (* The value of an option, if it has one, and the arguments that remain. *)
            fun long (name, given, rest) =
                let val shown = "--" ^ name
                    fun begins ({long, ...} : 'a opt_descr) = List.exists (String.isPrefix name) long
                    val found = List.filter begins options
                in
                    case map #desc found of
                        nil => (unknown shown; (NONE, rest))
                      | _ :: _ :: _ => (ambiguous (shown, options); (NONE, rest))
                      | [NoArg make] =>
                        if isSome given then (refused (shown, "does not allow an argument"); (NONE, rest))
                        else (SOME (make ()), rest)
                      | [OptArg (make, _)] => (SOME (make given), rest)
                      | [ReqArg (make, what)] =>
                        (case (given, rest) of
                             (SOME text, _) => (SOME (make text), rest)
                           | (NONE, text :: rest) => (SOME (make text), rest)
                           | (NONE, nil) => (refused (shown, "requires an argument " ^ what); (NONE, nil)))
                end
            fun short (c, more, rest) =
                let val shown = "-" ^ str c
                    val found = List.filter (fn {short, ...} : 'a opt_descr => Char.contains short c) options
                in
                    case map #desc found of
                        nil => (unknown shown; (NONE, rest))
                      | _ :: _ :: _ => (ambiguous (shown, options); (NONE, rest))
                      | [NoArg make] => (SOME (make ()), if more = "" then rest else "-" ^ more :: rest)
                      | [OptArg (make, _)] => (SOME (make (if more = "" then NONE else SOME more)), rest)
                      | [ReqArg (make, what)] =>
                        if more <> "" then (SOME (make more), rest)
                        else
                            (case rest of
                                 text :: rest => (SOME (make text), rest)
                               | nil => (refused (shown, "requires an argument " ^ what); (NONE, nil)))
                end
            fun split text =
                let val (name, value) = Substring.splitl (fn c => c <> #"=") (Substring.full text)
                in
                    (Substring.string name,
                     if Substring.isEmpty value then NONE else SOME (Substring.string (Substring.triml 1 value)))
                end
            fun from n text = String.extract (text, n, NONE)
            fun each (nil, found, others) = (rev found, rev others)
              | each ("--" :: rest, found, others) =
                (case argOrder of
                     ReturnInOrder make => (List.revAppend (found, map make (List.revAppend (others, rest))), nil)
                   | _ => (rev found, List.revAppend (others, rest)))
              | each (text :: rest, found, others) =
                if String.isPrefix "--" text then
                    let val (name, given) = split (from 2 text)
                    in taken (long (name, given, rest), text, found, others) end
                else if String.isPrefix "-" text then
                    taken (short (String.sub (text, 1), from 2 text, rest), text, found, others)
                else
                    case argOrder of
                        RequireOrder => (rev found, List.revAppend (others, text :: rest))
                      | Permute => each (rest, found, text :: others)
                      | ReturnInOrder make => each (rest, make text :: found, others)
            and taken ((SOME x, rest), _, found, others) = each (rest, x :: found, others)
              | taken ((NONE, rest), text, found, others) = each (rest, found, text :: others)
        in fn arguments => each (arguments, nil, nil) end
end
