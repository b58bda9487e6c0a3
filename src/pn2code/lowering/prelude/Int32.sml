(* A number from -2^(bits - 1) to 2^(bits - 1) - 1; `Int64` has another value for `bits`. *)
val bits = 32
val limit : IntInf.int = IntInf.pow (2, bits - 1)

fun fit n = if IntInf.<= (IntInf.~ limit, n) andalso IntInf.< (n, limit) then n else raise Overflow

(* The engine does not divide the smallest number by ~1, even where only the remainder is asked for. *)
fun divides (a : IntInf.int, b : IntInf.int) =
    if a <> IntInf.~ limit orelse b <> ~1 then () else if bits = 32 then raise Div else raise Overflow

val Int32_precision = SOME bits
val Int32_minInt = SOME (IntInf.~ limit)
val Int32_maxInt = SOME (IntInf.- (limit, 1))

fun Int32_plus (a, b) = fit (IntInf.+ (a, b))
fun Int32_minus (a, b) = fit (IntInf.- (a, b))
fun Int32_times (a, b) = fit (IntInf.* (a, b))
fun Int32_neg a = fit (IntInf.~ a)
fun Int32_abs a = fit (IntInf.abs a)
fun Int32_div (a, b) = (divides (a, b); IntInf.div (a, b))
fun Int32_mod (a, b) = (divides (a, b); IntInf.mod (a, b))
fun Int32_quot (a, b) = (divides (a, b); IntInf.quot (a, b))
fun Int32_rem (a, b) = (divides (a, b); IntInf.rem (a, b))
fun Int32_lt (a, b) = IntInf.< (a, b)
fun Int32_le (a, b) = IntInf.<= (a, b)
fun Int32_gt (a, b) = IntInf.> (a, b)
fun Int32_ge (a, b) = IntInf.>= (a, b)
fun Int32_min (a, b) = IntInf.min (a, b)
fun Int32_max (a, b) = IntInf.max (a, b)
fun Int32_sign a = IntInf.sign a
fun Int32_sameSign (a, b) = (IntInf.sign a < 0) = (IntInf.sign b < 0)
fun Int32_compare (a, b) = IntInf.compare (a, b)
fun Int32_toString a = IntInf.toString a
fun Int32_toInt a = IntInf.toInt a
fun Int32_fromInt n = fit (IntInf.fromInt n)
fun Int32_toLarge (a : IntInf.int) = a
fun Int32_fromLarge a = fit a
fun Int32_fmt radix a = String.map Char.toUpper (IntInf.fmt radix a)

fun Int32_scan radix getc stream =
    case IntInf.scan radix getc stream of
        SOME (a, rest) => SOME (fit a, rest)
      | NONE => NONE

fun Int32_fromString s = StringCvt.scanString (Int32_scan StringCvt.DEC) s
