(* Functions of colour sets, given the ones that the runtime has. A stream is what TextIO.sml makes of it: its name, its text, where
   reading goes on, and whether it is closed. *)
fun prim_do_read_accept (text : string, at : int ref, word : string) : bool = false
fun prim_do_read_integer (text : string, at : int ref) : IntInf.int = IntInf.fromInt 0
fun prim_do_read_is_done (text : string, at : int ref) : bool = true
fun prim_do_read_fail () : unit = ()
fun prim_timed_value (token : 'a timed) : 'a = raise Empty
fun prim_timed_stamp (token : 'a timed) : time = raise Empty

fun Colour_illegal_msg (legal, mkstr) (x, name) =
    if legal x then "" else mkstr x ^ " is not in the colour set " ^ name

(* --- texts --- *)

(* Neighbours in the sorted list are counted together. *)
fun lines (text, less, joint, ms) =
    let fun line (n, x) = Int.toString n ^ "`" ^ text x
        fun count (x, n, nil, out) = rev (line (n, x) :: out)
          | count (x, n, y :: rest, out) =
            if less (x, y) then count (y, 1, rest, line (n, x) :: out) else count (x, n + 1, rest, out)
    in
        case sort less ms of
            nil => "empty"
          | x :: rest => String.concatWith joint (count (x, 1, rest, nil))
    end

fun Colour_mkstr_ms (mkstr, lt) ms = lines (mkstr, lt, "++\n", ms)

fun Colour_timed_mkstr mkstr token = mkstr (prim_timed_value token) ^ "@" ^ ModelTime.toString (prim_timed_stamp token)

(* Of one colour the later stamps come first. *)
fun shown_before lt (a, b) =
    lt (prim_timed_value a, prim_timed_value b)
    orelse (not (lt (prim_timed_value b, prim_timed_value a))
            andalso ModelTime.lt (prim_timed_stamp b, prim_timed_stamp a))

fun Colour_timed_mkstr_ms (mkstr, lt) tms =
    lines (fn token => Colour_timed_mkstr mkstr token, fn pair => shown_before lt pair, "+++\n", tms)

fun Colour_output mkstr (stream, x) = TextIO.output (stream, mkstr x ^ " ")
fun Colour_output_ms (mkstr, lt) (stream, ms) = TextIO.output (stream, lines (mkstr, lt, " ++ ", ms) ^ " ")
fun Colour_timed_output mkstr (stream, token) = TextIO.output (stream, Colour_timed_mkstr mkstr token ^ " ")

fun Colour_timed_output_ms (mkstr, lt) (stream, tms) =
    TextIO.output (stream, lines (fn token => Colour_timed_mkstr mkstr token, fn pair => shown_before lt pair, " +++ ", tms) ^ " ")

(* --- reading --- *)

fun unread (text, closed) = if !closed then "" else text

fun expect (text, at, word) = if prim_do_read_accept (text, at, word) then () else prim_do_read_fail ()

(* The blank behind what was read. *)
fun blank (text, at) =
    if !at < String.size text andalso String.sub (text, !at) = #" " then at := !at + 1 else ()

fun Colour_input read (name : string, text, at, closed) =
    let val text = unread (text, closed)
        val x = read (text, at)
    in blank (text, at); x end

fun token (read, stamp, text, at) =
    let val x = read (text, at)
    in expect (text, at, "@"); x @ (stamp (text, at)) end

fun Colour_timed_input (read, stamp) (name : string, text, at, closed) =
    let val text = unread (text, closed)
        val x = token (read, stamp, text, at)
    in blank (text, at); x end

fun copies (n, x, out) = if n <= 0 then out else copies (n - 1, x, x :: out)

fun elements (read, joint, text, at, out) =
    let val n = IntInf.toInt (prim_do_read_integer (text, at))
        val () = expect (text, at, "`")
        val out = copies (n, read (text, at), out)
    in
        if prim_do_read_is_done (text, at) then rev out
        else (expect (text, at, joint); elements (read, joint, text, at, out))
    end

fun Colour_input_ms read (name : string, text, at, closed) =
    let val text = unread (text, closed)
        val ms = if prim_do_read_accept (text, at, "empty") then nil else elements (read, "++", text, at, nil)
    in blank (text, at); ms end

fun Colour_timed_input_ms (read, stamp) (name : string, text, at, closed) =
    let val text = unread (text, closed)
        val tms =
            if prim_do_read_accept (text, at, "empty") then nil
            else elements (fn (text, at) => token (read, stamp, text, at), "+++", text, at, nil)
    in blank (text, at); tms end

(* --- tokens --- *)

fun Colour_timed_cmp cmp (a, b) =
    case cmp (prim_timed_value a, prim_timed_value b) of
        EQUAL => ModelTime.cmp (prim_timed_stamp a, prim_timed_stamp b)
      | other => other

fun Colour_timed_lt cmp pair = Colour_timed_cmp cmp pair = LESS
fun Colour_timed_legal legal token = legal (prim_timed_value token)
fun Colour_timed_illegal_msg (legal, mkstr) (token, name) = Colour_illegal_msg (legal, mkstr) (prim_timed_value token, name)
fun Colour_no_bounds name = raise CPN'Error ("colour set " ^ name ^ " has no bounds")

(* --- colour sets whose values the runtime cannot number: their values are a list --- *)

fun out_of_range () = raise CPN'Error "out of range"

fun Colour_size values = length values

fun Colour_ord cmp (values, x) =
    let fun find (nil, _) = out_of_range ()
          | find (y :: rest, i) = if cmp (x, y) = EQUAL then i else find (rest, i + 1)
    in find (values, 0) end

fun Colour_col (values, i) = if i < 0 orelse i >= length values then out_of_range () else List.nth (values, i)

fun Colour_ran values = if null values then out_of_range () else random values

(* All sequences with `low` to `high` items in lexicographic order, prefixes first. *)
fun Colour_sequences (items, low, high) =
    let fun visit (prefix, n, out) =
            let val out = if n >= low then rev prefix :: out else out
            in if n < high then each (items, prefix, n + 1, out) else out end
        and each (nil, _, _, out) = out
          | each (x :: rest, prefix, n, out) = each (rest, prefix, n, visit (x :: prefix, n, out))
    in rev (visit (nil, 0, nil)) end

fun Colour_strings (letters, low, high) = List.map implode (Colour_sequences (letters, low, high))

fun Colour_letters (low, high) = List.tabulate (high - low + 1, fn i => chr (low + i))
