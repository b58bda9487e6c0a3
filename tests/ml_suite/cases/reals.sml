1.5 + 2.25
1.0 / 3.0
~1.5 * 2.0
1.0 / 0.0
~1.0 / 0.0
0.0 / 0.0
1E10 * 1E~10
1.5e3 - 0.5
real 3 / 2.0
Real.fromInt ~7 / 2.0
floor 2.7
floor ~2.7
ceil 2.1
ceil ~2.1
trunc 2.9
trunc ~2.9
round 2.5
round 3.5
round ~2.5
round 2.4999
floor 1E10 handle Overflow => ~1
round (0.0 / 0.0) handle Domain => ~1 | Overflow => ~2
Real.realFloor ~2.5
Real.realCeil ~2.5
Real.realTrunc ~2.5
Real.realRound 2.5
Real.min (1.5, ~2.5)
Real.max (1.5, ~2.5)
Real.abs ~2.5
abs ~2.5
Real.sign ~2.5
Real.sign 0.0
Real.compare (1.0, 2.0)
Real.== (0.5, 1.0 / 2.0)
Real.!= (0.1 + 0.2, 0.3)
Real.isNan (0.0 / 0.0)
Real.isFinite (1.0 / 0.0)
1.0 < 2.0 andalso 2.0 >= 2.0
Real.rem (7.5, 2.0)
Real.rem (~7.5, 2.0)
Real.fromString "3.25"
Real.fromString "  ~1.5E2xyz"
Real.fromString "12"
Real.fromString ".5"
Real.fromString "abc"
Real.fromString "1e3"
Real.fmt (StringCvt.FIX (SOME 2)) 3.14159
Real.fmt (StringCvt.FIX (SOME 0)) 2.0
Real.fmt (StringCvt.FIX NONE) ~1.5
Real.fmt (StringCvt.SCI (SOME 3)) 12345.678
Real.fmt (StringCvt.SCI NONE) 0.00123
Real.fmt (StringCvt.GEN (SOME 5)) 3.14159265
Real.fmt (StringCvt.FIX (SOME ~1)) 1.0 handle Size => "size"
Real.toString 0.5
Real.toString ~1.25
Real.toString 100.0
Real.toString 123456.789
Real.toString (1.0 / 3.0)
Real.toString (2.0 / 3.0)
Real.toString (1.0 / 0.0)
Real.toString (~1.0 / 0.0)
Real.toString 0.001
Math.sqrt 2.0
Math.sqrt ~1.0
Math.sin 1.0
Math.cos 1.0
Math.tan 0.5
Math.atan 1.0 * 4.0
Math.atan2 (1.0, ~1.0)
Math.asin 1.0
Math.acos 0.0
Math.exp 1.0
Math.ln 10.0
Math.log10 1000.0
Math.pow (2.0, 0.5)
Math.pow (~8.0, 3.0)
Math.sinh 1.0
Math.cosh 1.0
Math.tanh 1.0
Math.ln 0.0
Math.pi
Math.e
Real.fromLargeInt (IntInf.pow (2, 60))
Real.toLargeInt IEEEReal.TO_NEAREST 1E18
Real.toInt IEEEReal.TO_ZERO ~2.7
Real.split 3.75
Real.toManExp 8.0
Real.fromManExp {man = 0.5, exp = 4}
Real.signBit ~0.0
Real.copySign (3.0, ~1.0)
Real.sameSign (~1.0, ~2.0)
Real.unordered (0.0 / 0.0, 1.0)
Real.?= (0.0 / 0.0, 1.0)
Real.checkFloat (1.0 / 0.0) handle Overflow => 0.0
Real.*+ (2.0, 3.0, 4.0)
Real.*- (2.0, 3.0, 4.0)
fun mean xs = foldl (op +) 0.0 xs / real (length xs) ==> mean [1.0, 2.5, 4.0]
fun newton (x, n) = let fun go (g, 0) = g | go (g, k) = go ((g + x / g) / 2.0, k - 1) in go (x, n) end ==> newton (2.0, 6)
fun horner cs x = foldr (fn (c, acc) => c + x * acc) 0.0 cs ==> horner [1.0, 2.0, 3.0] 2.0
