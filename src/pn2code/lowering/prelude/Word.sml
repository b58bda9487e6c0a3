(* A word is a number from 0 to 2^bits - 1; `Word8` and others have other values for `bits`. *)
val bits = 31

fun prim_and (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_or (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_xor (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_shift_left (a : IntInf.int, n : int) : IntInf.int = a
fun prim_shift_right (a : IntInf.int, n : int) : IntInf.int = a

val size : IntInf.int = IntInf.pow (2, bits)
val half : IntInf.int = IntInf.pow (2, bits - 1)
val large : IntInf.int = IntInf.pow (2, 32)
val zero : IntInf.int = 0

fun cut n = IntInf.mod (n, size)
fun signed w = if IntInf.>= (w, half) then IntInf.- (w, size) else w

val Word_wordSize = bits
fun Word_fromInt n = cut (IntInf.fromInt n)
fun Word_toInt w = IntInf.toInt w
fun Word_toIntX w = IntInf.toInt (signed w)
fun Word_fromLargeInt n = cut n
fun Word_toLargeInt (w : IntInf.int) = w
fun Word_toLargeIntX w = signed w
fun Word_toLarge w = IntInf.mod (w, large)
fun Word_toLargeX w = IntInf.mod (signed w, large)
fun Word_fromLarge w = cut w
fun Word_toLargeWord w = Word_toLarge w
fun Word_toLargeWordX w = Word_toLargeX w
fun Word_fromLargeWord w = cut w
fun Word_neg a = cut (IntInf.~ a)
fun Word_plus (a, b) = cut (IntInf.+ (a, b))
fun Word_minus (a, b) = cut (IntInf.- (a, b))
fun Word_times (a, b) = cut (IntInf.* (a, b))
fun Word_div (a, b) = IntInf.div (a, b)
fun Word_mod (a, b) = IntInf.mod (a, b)
fun Word_andb (a, b) = prim_and (a, b)
fun Word_orb (a, b) = prim_or (a, b)
fun Word_xorb (a, b) = prim_xor (a, b)
fun Word_notb a = IntInf.- (IntInf.- (size, 1), a)
fun places (n : IntInf.int) = if IntInf.> (n, IntInf.fromInt bits) then bits else IntInf.toInt n
fun Word_left (a, n) = cut (prim_shift_left (a, places n))
fun Word_right (a, n) = prim_shift_right (a, places n)
fun Word_arithmetic_right (a, n) = cut (prim_shift_right (signed a, places n))
fun Word_lt (a, b) = IntInf.< (a, b)
fun Word_le (a, b) = IntInf.<= (a, b)
fun Word_gt (a, b) = IntInf.> (a, b)
fun Word_ge (a, b) = IntInf.>= (a, b)
fun Word_compare (a, b) = IntInf.compare (a, b)
fun Word_min (a, b) = IntInf.min (a, b)
fun Word_max (a, b) = IntInf.max (a, b)
fun Word_fmt radix w = String.map Char.toUpper (IntInf.fmt radix w)
fun Word_toString w = Word_fmt StringCvt.HEX w

fun is_digit StringCvt.BIN c = c = #"0" orelse c = #"1"
  | is_digit StringCvt.OCT c = Char.isDigit c andalso c < #"8"
  | is_digit StringCvt.DEC c = Char.isDigit c
  | is_digit StringCvt.HEX c = Char.isHexDigit c

(* Behind the letters in front of the digits, if digits follow; the 0 of them is a digit, too. *)
fun behind radix getc stream =
    let fun letter wanted stream =
            case getc stream of
                SOME (c, rest) => if wanted c then SOME rest else NONE
              | NONE => NONE
        fun digits stream = case letter (is_digit radix) stream of SOME _ => SOME stream | NONE => NONE
        fun x stream = if radix = StringCvt.HEX then letter (fn c => c = #"x" orelse c = #"X") stream else NONE
        fun w stream = letter (fn c => c = #"w") stream
        fun first nil = stream
          | first (NONE :: others) = first others
          | first (SOME found :: others) = (case digits found of SOME found => found | NONE => first others)
        fun join NONE = NONE | join (SOME found) = found
    in
        case letter (fn c => c = #"0") stream of
            NONE => stream
          | SOME rest => first [join (Option.map x (w rest)), x rest, w rest]
    end

fun Word_scan radix getc stream =
    let val start = behind radix getc (StringCvt.skipWS getc stream)
        fun here stream =
            case getc stream of
                SOME (c, rest) => if is_digit radix c then SOME (c, rest) else NONE
              | NONE => NONE
    in
        case here start of
            NONE => NONE
          | SOME _ =>
            (case IntInf.scan radix here start of
                 SOME (n, rest) => if IntInf.< (n, size) then SOME (n, rest) else raise Overflow
               | NONE => NONE)
    end

fun Word_fromString s = StringCvt.scanString (Word_scan StringCvt.HEX) s
