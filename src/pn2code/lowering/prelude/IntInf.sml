fun base StringCvt.BIN = 2
  | base StringCvt.OCT = 8
  | base StringCvt.DEC = 10
  | base StringCvt.HEX = 16

val zero : IntInf.int = 0
val one : IntInf.int = 1

fun digit d = if d < 10 then chr (48 + d) else chr (87 + d)

fun IntInf_fmt StringCvt.DEC n = IntInf.toString n
  | IntInf_fmt radix n =
    let val b = base radix
        val big = IntInf.fromInt b
        fun loop (n, out) =
            if n = zero then implode out
            else loop (IntInf.quot (n, big), digit (abs (IntInf.toInt (IntInf.rem (n, big)))) :: out)
    in if n = zero then "0" else if IntInf.< (n, zero) then "~" ^ loop (n, nil) else loop (n, nil) end

fun value c =
    if Char.isDigit c then ord c - 48
    else if Char.isAlpha c then ord (Char.toUpper c) - 55
    else 99

(* Digits to a base; NONE if there is not one. *)
fun digits (b, getc, stream) =
    let val big = IntInf.fromInt b
        fun loop (n, stream) =
            case getc stream of
                SOME (c, rest) =>
                if value c < b then loop (IntInf.- (IntInf.* (n, big), IntInf.fromInt (value c)), rest)
                else (n, stream)
              | NONE => (n, stream)
    in
        case getc stream of
            SOME (c, rest) => if value c < b then SOME (loop (zero, stream)) else NONE
          | NONE => NONE
    end

(* Behind 0x, if digits follow. *)
fun prefixed (b, getc, stream) =
    if b <> 16 then stream
    else
        case getc stream of
            SOME (#"0", rest) =>
            (case getc rest of
                 SOME (x, rest) =>
                 if Char.toLower x <> #"x" then stream
                 else (case getc rest of
                           SOME (c, _) => if value c < 16 then rest else stream
                         | NONE => stream)
               | NONE => stream)
          | _ => stream

(* Digits are summed up as a negative number, so that the smallest number can be read. *)
fun IntInf_scan radix getc stream =
    let val b = base radix
        val stream = StringCvt.skipWS getc stream
        val (minus, stream) =
            case getc stream of
                SOME (#"~", rest) => (true, rest)
              | SOME (#"-", rest) => (true, rest)
              | SOME (#"+", rest) => (false, rest)
              | _ => (false, stream)
    in
        case digits (b, getc, prefixed (b, getc, stream)) of
            SOME (n, rest) => SOME (if minus then n else IntInf.~ n, rest)
          | NONE => NONE
    end

fun IntInf_fromString s = StringCvt.scanString (IntInf_scan StringCvt.DEC) s

fun IntInf_sameSign (a : IntInf.int, b) = IntInf.sign a = IntInf.sign b

fun IntInf_divMod (a : IntInf.int, b) = (a div b, a mod b)

fun IntInf_quotRem (a, b) = (IntInf.quot (a, b), IntInf.rem (a, b))

val IntInf_precision : int option = NONE
val IntInf_minInt : IntInf.int option = NONE
val IntInf_maxInt : IntInf.int option = NONE

fun IntInf_pow (x, n) =
    let val two = IntInf.fromInt 2
        fun power (x, n) =
            if n = 0 then one
            else if n = 1 then x
            else
                let val half = power (x, n div 2)
                in if n mod 2 = 0 then IntInf.* (half, half) else IntInf.* (IntInf.* (half, half), x) end
    in
        if n >= 0 then power (x, n)
        else if x = zero then raise Div
        else zero (* as SML/NJ has it, also for 1 and ~1 *)
    end

fun IntInf_log2 n =
    let val two = IntInf.fromInt 2
        fun loop (n, k) = if n = one then k else loop (IntInf.quot (n, two), k + 1)
    in if IntInf.<= (n, zero) then raise Domain else loop (n, 0) end

fun prim_and (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_or (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_xor (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_not (a : IntInf.int) : IntInf.int = a
fun prim_shift_left (a : IntInf.int, n : int) : IntInf.int = a
fun prim_shift_right (a : IntInf.int, n : int) : IntInf.int = a

fun IntInf_andb (a, b) = prim_and (a, b)
fun IntInf_orb (a, b) = prim_or (a, b)
fun IntInf_xorb (a, b) = prim_xor (a, b)
fun IntInf_notb a = prim_not a
fun IntInf_left (a, n) = prim_shift_left (a, Word.toInt n)
fun IntInf_arithmetic_right (a, n) = prim_shift_right (a, Word.toInt n)
