fun prim_real_format (style : int, digits : int, x : real) : string = ""
fun prim_real_read (s : string) : real = 0.0
fun prim_real_exponent (x : real) : int = 0
fun prim_real_scale (x : real, n : int) : real = x
fun prim_real_next (x : real, y : real) : real = x
fun prim_real_fused (x : real, y : real, z : real) : real = x
fun prim_real_sign_bit (x : real) : bool = false
fun prim_real_copy_sign (x : real, y : real) : real = x
fun prim_real_is_normal (x : real) : bool = false
fun prim_real_to_large (x : real) : IntInf.int = IntInf.fromInt 0

val Real_radix = 2
val Real_precision = 53
val Real_maxFinite = 1.7976931348623157E308
val Real_minPos = 2.2250738585072014E~308 / 4503599627370496.0
val Real_minNormalPos = 2.2250738585072014E~308

fun Real_times_plus (a, b, c) = prim_real_fused (a, b, c)
fun Real_times_minus (a, b, c) = prim_real_fused (a, b, ~ c)
fun Real_unordered (a, b) = Real.isNan a orelse Real.isNan b
fun Real_unordered_equal (a, b) = Real_unordered (a, b) orelse Real.== (a, b)
fun Real_signBit x = prim_real_sign_bit x
fun Real_sameSign (x, y) = prim_real_sign_bit x = prim_real_sign_bit y
fun Real_copySign (x, y) = prim_real_copy_sign (x, y)
fun Real_isNormal x = prim_real_is_normal x
fun Real_nextAfter (x, y) = prim_real_next (x, y)

fun Real_checkFloat x =
    if Real.isNan x then raise Div else if Real.isFinite x then x else raise Overflow

fun Real_split x =
    if Real.isFinite x then
        let val whole = if Real.== (x, 0.0) then x else Real.realTrunc x
        in {whole = whole, frac = x - whole} end
    else if Real.isNan x then {whole = x, frac = x}
    else {whole = x, frac = x - x}

fun Real_realMod x = #frac (Real_split x)

fun Real_toManExp x =
    if not (Real.isFinite x) orelse Real.== (x, 0.0) then {man = x, exp = 0}
    else
        let val e = prim_real_exponent x
        in {man = prim_real_scale (x, ~ e), exp = e} end

fun Real_fromManExp {man, exp} = prim_real_scale (man, exp)

fun rounded (IEEEReal.TO_NEAREST, x) = Real.realRound x
  | rounded (IEEEReal.TO_NEGINF, x) = Real.realFloor x
  | rounded (IEEEReal.TO_POSINF, x) = Real.realCeil x
  | rounded (IEEEReal.TO_ZERO, x) = Real.realTrunc x

fun Real_toLargeInt mode x =
    if Real.isNan x then raise Domain
    else if not (Real.isFinite x) then raise Overflow
    else prim_real_to_large (rounded (mode, x))

fun Real_toInt IEEEReal.TO_POSINF x = ceil x
  | Real_toInt mode x = trunc (rounded (mode, x))

fun Real_toLarge (x : real) = x
fun Real_fromLarge (mode : IEEEReal.rounding_mode) (x : real) = x

fun places (NONE, default) = default
  | places (SOME n, _) = if n < 0 then raise Size else n

(* No real has more digits than that behind the point: the others are zeros, and come before the exponent. *)
val most_digits = 1100

fun format (style, n, x) =
    if n <= most_digits orelse not (Real.isFinite x) then prim_real_format (style, n, x)
    else
        let val text = prim_real_format (style, most_digits, x)
            val (digits, exponent) = Substring.splitl (fn c => c <> #"E") (Substring.full text)
            val zeros = n - most_digits
        in
            StringCvt.padRight #"0" (Substring.size digits + zeros) (Substring.string digits)
            ^ Substring.string exponent
        end

fun Real_fmt (StringCvt.SCI n) x = format (0, places (n, 6), x)
  | Real_fmt (StringCvt.FIX n) x = format (1, places (n, 6), x)
  | Real_fmt (StringCvt.GEN n) x =
    (case places (n, 12) of 0 => raise Size | k => prim_real_format (2, k, x))
  | Real_fmt StringCvt.EXACT x = raise Fail "RealFormat: fmtReal: EXACT not supported"

(* Digits of a stream in front of `out`, which is in reverse. *)
fun digits (getc, stream, out) =
    case getc stream of
        SOME (c, rest) => if Char.isDigit c then digits (getc, rest, c :: out) else (out, stream)
      | NONE => (out, stream)

(* Digits, the last one first, are an integer. *)
fun checked digits = foldr (fn (c, n) => 10 * n + (ord c - ord #"0")) 0 digits

fun exponent (getc, stream, out) =
    case getc stream of
        SOME (e, after) =>
        if e = #"e" orelse e = #"E" then
            let val (sign, after) =
                    case getc after of
                        SOME (#"~", rest) => ([#"-"], rest)
                      | SOME (#"-", rest) => ([#"-"], rest)
                      | SOME (#"+", rest) => (nil, rest)
                      | _ => (nil, after)
                val (more, rest) = digits (getc, after, nil)
            in if List.null more then (out, stream) else (checked more; (more ^^ sign ^^ (#"e" :: out), rest)) end
        else (out, stream)
      | NONE => (out, stream)

fun number (getc, stream) =
    let val (whole, rest) = digits (getc, stream, nil)
        val (all, after) =
            case getc rest of
                SOME (#".", point) =>
                let val (part, behind) = digits (getc, point, nil)
                in if List.null part then (whole, rest) else (part ^^ (#"." :: whole), behind) end
              | _ => (whole, rest)
    in
        if List.null all then NONE
        else
            let val (all, after) = exponent (getc, after, all)
            in SOME (prim_real_read (implode (rev all)), after) end
    end

fun Real_scan getc stream =
    let val stream = StringCvt.skipWS getc stream
        val (minus, stream) =
            case getc stream of
                SOME (#"~", rest) => (true, rest)
              | SOME (#"-", rest) => (true, rest)
              | SOME (#"+", rest) => (false, rest)
              | _ => (false, stream)
        fun signed (x, rest) = SOME (if minus then ~ x else x, rest)
    in
        case number (getc, stream) of
            SOME found => signed found
          | NONE => NONE
    end

fun Real_fromString s = StringCvt.scanString Real_scan s
