(* A stream that is read is its name, its whole text, where reading goes on, and whether it is closed. A stream that is written is its
   name, a handle of the runtime (pn_file.h), and whether it is closed. *)
fun prim_do_file_read (name : string) : string = ""
fun prim_do_file_open (name : string, append : bool) : int = 0
fun prim_do_file_write (h : int, text : string) : unit = ()
fun prim_do_file_close (h : int) : unit = ()
fun prim_do_file_problem () : string = ""
fun prim_do_file_problem_name () : OS.syserror = raise Empty
fun prim_do_file_has_failed () : bool = false

fun problem (name, function) =
    raise IO.Io {name = name, function = function,
                 cause = OS.SysErr (prim_do_file_problem (), SOME (prim_do_file_problem_name ()))}

fun reading (name : string, text : string) = (name, text, ref 0, ref false)

fun TextIO_openIn name =
    let val text = prim_do_file_read name
    in if prim_do_file_has_failed () then problem (name, "openIn") else reading (name, text) end

fun TextIO_openString text = reading ("<string>", text)

fun writing (name, function, append) =
    let val handle_ = prim_do_file_open (name, append)
    in if handle_ < 0 then problem (name, function) else (name, handle_, ref false) end

fun TextIO_openOut name = writing (name, "openOut", false)
fun TextIO_openAppend name = writing (name, "openAppend", true)

fun TextIO_closeIn (_ : string, _ : string, _ : int ref, closed) = closed := true

fun TextIO_closeOut (_ : string, handle_, closed) =
    if handle_ = 1 orelse !closed then () else (closed := true; prim_do_file_close handle_)

(* The next characters, at most so many. *)
fun take ((_ : string, text, at, closed), n) =
    if !closed then ""
    else
        let val left = String.size text - !at
            val m = if n < left then n else left
            val taken = substring (text, !at, m)
        in at := !at + m; taken end

fun rest (_ : string, text, at, closed) = if !closed then 0 else String.size text - !at

fun TextIO_input stream = take (stream, 4096)
fun TextIO_inputN (stream, n) = if n < 0 then raise Size else take (stream, n)
fun TextIO_inputAll stream = take (stream, rest stream)

fun TextIO_input1 stream =
    if rest stream = 0 then NONE else SOME (String.sub (take (stream, 1), 0))

fun TextIO_lookahead (name : string, text, at, closed) =
    if rest (name, text, at, closed) = 0 then NONE else SOME (String.sub (text, !at))

(* What was scanned is read; nothing, where there was no value. *)
fun TextIO_scanStream scan (name : string, text, at, closed) =
    let val start = !at
        val stop = if !closed then start else String.size text
    in
        case scan (fn i => if i < stop then SOME (String.sub (text, i), i + 1) else NONE) start of
            SOME (x, i) => (at := i; SOME x)
          | NONE => NONE
    end

fun TextIO_endOfStream stream = rest stream = 0

fun TextIO_canInput (stream, n) =
    if n < 0 then raise Size
    else let val m = rest stream in SOME (if n < m then n else m) end

(* Where the line ends: behind its line end, or at the end of the text. *)
fun line_end (text, i) =
    if i >= String.size text then i
    else if String.sub (text, i) = #"\n" then i + 1
    else line_end (text, i + 1)

fun TextIO_inputLine (name : string, text, at, closed) =
    if rest (name, text, at, closed) = 0 then NONE
    else
        let val start = !at
            val stop = line_end (text, start)
            val line = substring (text, start, stop - start)
        in
            at := stop;
            SOME (if String.sub (text, stop - 1) = #"\n" then line else line ^ "\n")
        end

fun write ((name, handle_, closed), function, text) =
    if !closed then raise IO.Io {name = name, function = function, cause = Fail "ClosedStream"}
    else prim_do_file_write (handle_, text)

fun TextIO_output (stream, text) = write (stream, "output", text)
fun TextIO_output1 (stream, c) = write (stream, "output1", str c)
fun TextIO_outputSubstr (stream, (s, i, n)) = write (stream, "outputSubstr", substring (s, i, n))
fun TextIO_flushOut (_ : string, _ : int, _ : bool ref) = ()

val TextIO_stdIn = ("<stdIn>", "", ref 0, ref false)
val TextIO_stdOut = ("<stdOut>", 1, ref false)
val TextIO_stdErr = ("<stdErr>", 1, ref false)
