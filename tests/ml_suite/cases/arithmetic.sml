1 + 2 * 3 - 4
(1 + 2) * (3 - 4)
~7 div 2
~7 mod 2
7 div ~2
7 mod ~2
~7 div ~2
~7 mod ~2
0 div 5
Int.quot (~7, 2)
Int.rem (~7, 2)
Int.quot (7, ~2)
Int.rem (7, ~2)
1 div 0
1 mod 0
Int.quot (1, 0)
Int.rem (1, 0)
1073741823 + 1
~1073741823 - 2
1073741823 * 2
32768 * 32768
32768 * ~32768
Int.+ (1073741823, 1) handle Overflow => ~1
Int.- (~1073741824, 1) handle Overflow => ~1
Int.* (46341, 46341) handle Overflow => ~1
Int.~ (~1073741824) handle Overflow => ~1
Int.abs (~1073741824) handle Overflow => ~1
Int.div (~1073741824, ~1) handle Overflow => ~1
Int.quot (~1073741824, ~1) handle Overflow => ~1
Int.mod (~1073741824, ~1)
~(~5)
abs ~3 + abs 3
Int.min (3, ~4)
Int.max (3, ~4)
Int.sign ~9
Int.sign 0
Int.sameSign (3, ~3)
Int.sameSign (2, 3)
Int.compare (1, 2)
Int.compare (2, 2)
Int.compare (3, 2)
1 < 2 andalso 2 <= 2 andalso 3 > 2 andalso 2 >= 2
1 <> 2
Int.maxInt
Int.minInt
Int.precision
let val x = 5 val y = x * x in (x, y, y mod x) end
(10 - 3 - 2, 100 div 10 div 5, 7 - ~2)
let fun gcd (a, 0) = a | gcd (a, b) = gcd (b, a mod b) in gcd (1071, 462) end
let fun power (_, 0) = 1 | power (b, n) = b * power (b, n - 1) in (power (2, 29), power (~3, 5)) end
Int.toString ~42
Int.toString 0
Int.fromString "42abc"
Int.fromString "  ~17"
Int.fromString "+5"
Int.fromString "-5"
Int.fromString "abc"
Int.fromString ""
Int.fromString "~"
Int.fromString "0x10"
Int.fromString "99999999999" handle Overflow => SOME 0
Int.fmt StringCvt.HEX 255
Int.fmt StringCvt.BIN ~10
Int.fmt StringCvt.OCT 64
Int.fmt StringCvt.DEC ~64
StringCvt.scanString (Int.scan StringCvt.HEX) "ffz"
StringCvt.scanString (Int.scan StringCvt.BIN) "0112"
StringCvt.scanString (Int.scan StringCvt.DEC) "x"
Int.toLarge 5
Int.fromLarge (IntInf.fromInt 5)
0x1F + 0xa
fun collatz 1 = 0 | collatz n = 1 + collatz (if n mod 2 = 0 then n div 2 else 3 * n + 1) ==> collatz 27
fun isqrt n = let fun go i = if i * i > n then i - 1 else go (i + 1) in go 0 end ==> map isqrt [0, 1, 15, 16, 1000]
fun digits n = if n < 10 then [n] else digits (n div 10) ^^ [n mod 10] ==> digits 90210
