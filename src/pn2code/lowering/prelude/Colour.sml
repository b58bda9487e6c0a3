(* Functions of colour sets, given the ones that the runtime has. A stream is what TextIO.sml makes of it: its name, its text, where
   reading goes on, and whether it is closed. *)
fun prim_do_read_accept (text : string, at : int ref, word : string) : bool = false
fun prim_do_read_integer (text : string, at : int ref) : IntInf.int = IntInf.fromInt 0
fun prim_do_read_is_done (text : string, at : int ref) : bool = true
fun prim_do_read_fail () : unit = ()
fun prim_timed_value (token : 'a timed) : 'a = raise Empty
fun prim_timed_stamp (token : 'a timed) : time = raise Empty

(* --- what is wrong with a value, in the words of CPN Tools --- *)

fun Colour_illegal (legal, mkstr) (x, first, last) = if legal x then "" else first ^ mkstr x ^ last

fun Colour_illegal_number (legal, mkstr) (x, low, high) =
    if legal x then "" else " Illegal color: " ^ mkstr x ^ " not in range " ^ mkstr low ^ ".." ^ mkstr high ^ "."

fun Colour_illegal_index (legal, mkstr) (x, stem, range) =
    if legal x then ""
    else
        let val text = mkstr x
            val first = String.size stem + 1
            val number = String.substring (text, first, String.size text - first - 1)
        in "Illegal color: " ^ text ^ ", index " ^ number ^ " not in range " ^ range ^ "." end

fun Colour_illegal_subset (legal, mkstr, illegal_msg) x =
    if legal x then ""
    else
        case illegal_msg x of
            "" => "Illegal color: " ^ mkstr x ^ " is not in subset color set."
          | other => other

fun of_length (what, out_of, n, low, high) =
    if n >= low andalso n <= high then ""
    else what ^ " length " ^ out_of ^ Int.toString n ^ (if out_of = "" then " is" else "") ^ " out of range "
         ^ Int.toString low ^ ".." ^ Int.toString high ^ "."

(* `letters`: the first and the last one, or nothing; without bounds `high` is below zero. *)
fun Colour_illegal_string (legal, mkstr) (x, letters, low, high) =
    if legal x then ""
    else
        let fun wrong c = letters <> "" andalso (c < String.sub (letters, 0) orelse String.sub (letters, 1) < c)
            val bad = List.filter wrong (explode x)
            val first = "\"" ^ String.substring (letters, 0, if letters = "" then 0 else 1) ^ "\""
            val last = if letters = "" then "" else "\"" ^ String.substring (letters, 1, 1) ^ "\""
            val range =
                if List.null bad then ""
                else " Range " ^ first ^ ".." ^ last ^ " does not contain ["
                     ^ String.concatWith "," (List.map (fn c => "\"" ^ Char.toString c ^ "\"") bad) ^ "]."
        in "Illegal color: " ^ mkstr x ^ "." ^ range
           ^ (if high < 0 then "" else of_length (" String", "", String.size x, low, high))
        end

fun Colour_illegal_list (legal, mkstr) (items, low, high) =
    let val bad = List.filter (fn x => not (legal x)) items
        val values =
            if List.null bad then "" else " Illegal values in list: " ^ String.concatWith "," (List.map mkstr bad) ^ "."
        val size = if high < 0 then "" else of_length (" List", "of ", length items, low, high)
    in if values = "" andalso size = "" then "" else "Illegal color." ^ values ^ size end

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
        EQUAL => ModelTime.cmp (prim_timed_stamp b, prim_timed_stamp a)
      | other => other

fun Colour_timed_lt cmp pair = Colour_timed_cmp cmp pair = LESS
fun Colour_timed_legal legal token = legal (prim_timed_value token)
fun Colour_timed_illegal_msg illegal_msg token = illegal_msg (prim_timed_value token)
fun Colour_no_bounds name = raise CPN'Error ("colour set " ^ name ^ " has no bounds")

(* --- colour sets whose values the runtime cannot number: their values are a list --- *)

fun out_of_range () = raise CPN'Error "out of range"

fun Colour_size values = length values

fun Colour_ord cmp (values, x) =
    let fun find (nil, _) = out_of_range ()
          | find (y :: rest, i) = if cmp (x, y) = EQUAL then i else find (rest, i + 1)
    in find (values, 0) end

fun Colour_in_range (i, size) = if i < 0 orelse i >= size then out_of_range () else i

fun Colour_col (values, i) = if i < 0 orelse i >= length values then out_of_range () else List.nth (values, i)

fun Colour_ran values = if List.null values then out_of_range () else random values

(* All lists with `low` to `high` items, the shorter ones first, the first item fastest. *)
fun Colour_sequences (items, low, high) =
    let fun each (0, behind, out) = behind :: out
          | each (n, behind, out) = List.foldl (fn (x, out) => each (n - 1, x :: behind, out)) out items
        fun lengths (n, out) = if n > high then rev out else lengths (n + 1, each (n, nil, out))
    in lengths (low, nil) end

(* All strings, the shorter ones first, the last letter fastest. *)
fun Colour_strings (letters, low, high) =
    List.map (fn letters => implode (rev letters)) (Colour_sequences (letters, low, high))

(* How many sequences with `low` to `high` of so many items there are. *)
fun Colour_sequences_size (items, low, high) =
    let fun power (0, out) = out
          | power (n, out) = power (n - 1, out * items)
        fun sum (n, out) = if n > high then out else sum (n + 1, out + power (n, 1))
    in sum (low, 0) end

(* CPN Tools has its own numbers: an item counts as often as there are items from it on. *)
fun weighted (nil, _, out) = out
  | weighted (x :: rest, n, out) = weighted (rest, n - 1, out + n * x)

fun Colour_sequence_ord (legal, position) (items, size, low) =
    if legal items then
        let val n = length items
            val own = List.map position items
        in Colour_sequences_size (size, low, n - 1) + weighted (own, n, 0) end
    else out_of_range ()

fun Colour_string_ord legal (x, first, size, low) =
    if legal x then
        let val n = String.size x
            val own = List.map (fn c => ord c - first) (explode x)
        in Colour_sequences_size (size, low, n - 1) + weighted (own, n, 0) end
    else out_of_range ()

fun Colour_letters (low, high) = List.tabulate (high - low + 1, fn i => chr (low + i))
