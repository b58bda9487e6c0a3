(* A time is a number of nanoseconds. *)
val second : IntInf.int = 1000000000

fun toward_zero (n : IntInf.int, unit_) = IntInf.quot (n, unit_)

val Time_zeroTime : IntInf.int = 0
fun Time_now () : IntInf.int = 0
fun Time_plus (a, b) = IntInf.+ (a, b)
fun Time_minus (a, b) = IntInf.- (a, b)
fun Time_lt (a, b) = IntInf.< (a, b)
fun Time_le (a, b) = IntInf.<= (a, b)
fun Time_gt (a, b) = IntInf.> (a, b)
fun Time_ge (a, b) = IntInf.>= (a, b)
fun Time_compare (a, b) = IntInf.compare (a, b)

fun Time_fromReal x =
    Real.toLargeInt IEEEReal.TO_NEAREST (x * 1000000000.0)

fun Time_toReal t = Real.fromLargeInt t / 1000000000.0
fun Time_fromSeconds n = n * second
fun Time_fromMilliseconds (n : IntInf.int) = n * 1000000
fun Time_fromMicroseconds (n : IntInf.int) = n * 1000
fun Time_fromNanoseconds (n : IntInf.int) = n
fun Time_toSeconds t = toward_zero (t, second)
fun Time_toMilliseconds t = toward_zero (t, 1000000)
fun Time_toMicroseconds t = toward_zero (t, 1000)
fun Time_toNanoseconds (t : IntInf.int) = t

fun Time_fmt decimals (t : IntInf.int) =
    if decimals < 0 then raise Size
    else
        let val shown = if decimals > 9 then 9 else decimals
            val unit_ : IntInf.int = IntInf.pow (10, 9 - shown)
            val (below, rest) = IntInf.divMod (IntInf.abs t, unit_)
            val half = IntInf.compare (2 * rest, unit_) (* the even neighbour, if it is just between two *)
            val is_up = half = GREATER orelse (half = EQUAL andalso IntInf.mod (below, 2) = 1)
            val number = if is_up then below + 1 else below
            val scale : IntInf.int = IntInf.pow (10, shown)
            val whole = IntInf.toString (IntInf.div (number, scale))
            val fraction = StringCvt.padLeft #"0" shown (IntInf.toString (IntInf.mod (number, scale)))
            val sign = if t < 0 then "~" else ""
        in
            sign ^ whole
            ^ (if decimals = 0 then "" else "." ^ StringCvt.padRight #"0" decimals fraction)
        end

fun Time_toString t = Time_fmt 3 t

fun Time_fromString s =
    case Real.fromString s of
        SOME x => if Real.isFinite x then SOME (Time_fromReal x) else NONE
      | NONE => NONE
