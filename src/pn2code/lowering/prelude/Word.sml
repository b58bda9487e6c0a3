(* A word is a number from 0 to 2^31 - 1. *)
fun prim_and (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_or (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_xor (a : IntInf.int, b : IntInf.int) : IntInf.int = a
fun prim_shift_left (a : IntInf.int, n : int) : IntInf.int = a
fun prim_shift_right (a : IntInf.int, n : int) : IntInf.int = a

val size : IntInf.int = 2147483648
val half : IntInf.int = 1073741824
val zero : IntInf.int = 0

fun cut n = IntInf.mod (n, size)
fun signed w = if IntInf.>= (w, half) then IntInf.- (w, size) else w

val Word_wordSize = 31
fun Word_fromInt n = cut (IntInf.fromInt n)
fun Word_toInt w = IntInf.toInt w
fun Word_toIntX w = IntInf.toInt (signed w)
fun Word_fromLargeInt n = cut n
fun Word_toLargeInt (w : IntInf.int) = w
fun Word_toLargeIntX w = signed w
fun Word_plus (a, b) = cut (IntInf.+ (a, b))
fun Word_minus (a, b) = cut (IntInf.- (a, b))
fun Word_times (a, b) = cut (IntInf.* (a, b))
fun Word_div (a, b) = IntInf.div (a, b)
fun Word_mod (a, b) = IntInf.mod (a, b)
fun Word_andb (a, b) = prim_and (a, b)
fun Word_orb (a, b) = prim_or (a, b)
fun Word_xorb (a, b) = prim_xor (a, b)
fun Word_notb a = IntInf.- (IntInf.- (size, 1), a)
fun bits (n : IntInf.int) = if IntInf.> (n, 31) then 31 else IntInf.toInt n
fun Word_left (a, n) = cut (prim_shift_left (a, bits n))
fun Word_right (a, n) = prim_shift_right (a, bits n)
fun Word_arithmetic_right (a, n) = cut (prim_shift_right (signed a, bits n))
fun Word_lt (a, b) = IntInf.< (a, b)
fun Word_le (a, b) = IntInf.<= (a, b)
fun Word_gt (a, b) = IntInf.> (a, b)
fun Word_ge (a, b) = IntInf.>= (a, b)
fun Word_compare (a, b) = IntInf.compare (a, b)
fun Word_min (a, b) = IntInf.min (a, b)
fun Word_max (a, b) = IntInf.max (a, b)
fun Word_fmt radix w = String.map Char.toUpper (IntInf.fmt radix w)
fun Word_toString w = Word_fmt StringCvt.HEX w

fun is_hex c = Char.isHexDigit c

fun Word_fromString s =
    let fun getc i = if i < String.size s then SOME (String.sub (s, i), i + 1) else NONE
        val start = StringCvt.skipWS getc 0
        fun begins text = String.isPrefix text (String.extract (s, start, NONE))
        fun digit_at i = i < String.size s andalso is_hex (String.sub (s, i))
        val from =
            if (begins "0wx" orelse begins "0wX") andalso digit_at (start + 3) then start + 3
            else if (begins "0x" orelse begins "0X") andalso digit_at (start + 2) then start + 2
            else if begins "0w" andalso digit_at (start + 2) then start + 2
            else start
        val text = StringCvt.takel is_hex getc from
    in
        if text = "" then NONE
        else
            case IntInf.scan StringCvt.HEX (fn i => if i < String.size text then SOME (String.sub (text, i), i + 1) else NONE) 0 of
                SOME (n, _) => if IntInf.< (n, size) then SOME n else raise Overflow
              | NONE => NONE
    end
