IntInf.pow (2, 100)
IntInf.toString (IntInf.pow (~3, 41))
IntInf.fromInt 5 + IntInf.fromInt 6
(IntInf.fromInt 1000000 * 1000000 * 1000000)
IntInf.fromInt ~7 div 2
IntInf.fromInt ~7 mod 2
IntInf.quot (~7, 2)
IntInf.rem (~7, 2)
IntInf.divMod (~17, 5)
IntInf.quotRem (~17, 5)
IntInf.toInt (IntInf.fromInt 9)
IntInf.toInt (IntInf.pow (2, 40)) handle Overflow => ~1
IntInf.fromString "123456789012345678901234567890"
IntInf.compare (IntInf.pow (2, 70), IntInf.pow (2, 71))
IntInf.pow (2, 70) < IntInf.pow (3, 50)
IntInf.abs ~5
~ (IntInf.fromInt 3)
IntInf.sign (IntInf.pow (~2, 63))
IntInf.min (3, ~3)
IntInf.log2 1023
IntInf.log2 1024
IntInf.andb (12, 10)
IntInf.orb (12, 10)
IntInf.xorb (12, 10)
IntInf.notb 5
String.map Char.toUpper (IntInf.fmt StringCvt.HEX 255)
fun fact (n : IntInf.int) = if n = 0 then 1 else n * fact (n - 1) ==> fact 25
fun fib n = let fun go (0, a, _) = a | go (k, a, b) = go (k - 1, b, a + b) in go (n, 0 : IntInf.int, 1) end ==> fib 120
IntInf.fromInt 1 div 0
(IntInf.pow (10, 20) + 1) mod 7
IntInf.toLarge 5 = LargeInt.fromInt 5
