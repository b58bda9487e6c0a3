fun Int_sameSign (a, b) = (a < 0) = (b < 0)

(* Of an `int` the digits are capital letters. *)
fun Int_fmt radix n = String.map Char.toUpper (IntInf.fmt radix (Int.toLarge n))

fun Int_scan radix getc stream =
    case IntInf.scan radix getc stream of
        SOME (n, rest) => SOME (Int.fromLarge n, rest)
      | NONE => NONE

fun Int_fromString s = StringCvt.scanString (Int_scan StringCvt.DEC) s
