Bool.toString (1 < 2)
Bool.fromString "true!"
Bool.fromString " false"
Bool.fromString "yes"
Bool.not false
Int.toString (ord #"a")
Real.toString (real 5)
floor (real 7 / 2.0)
Real.round (Real.fromInt 5)
implode (map chr [72, 105])
String.concat (map Int.toString [1, 2, 3])
valOf (Int.fromString "12") + 1
Option.map Real.toString (Real.fromString "2.50")
Int.fromString (Int.toString ~99)
Char.toString #"a" ^ str #"b"
(Int.toString o Real.floor) 9.99
IntInf.toInt (Real.toLargeInt IEEEReal.TO_NEGINF 2.9)
Substring.string (Substring.substring ("hello", 1, 3))
Word.toInt (Word.fromInt 5)
Word.toInt (Word.andb (Word.fromInt 12, Word.fromInt 10))
Word.toInt (Word.orb (Word.fromInt 12, Word.fromInt 10))
Word.toInt (Word.xorb (Word.fromInt 12, Word.fromInt 10))
Word.toInt (Word.<< (Word.fromInt 3, Word.fromInt 4))
Word.toInt (Word.>> (Word.fromInt 48, Word.fromInt 4))
Word.toString (Word.fromInt 255)
Word.fromInt 3 < Word.fromInt 5
Word.toInt (Word.div (Word.fromInt 17, Word.fromInt 5) + Word.mod (Word.fromInt 17, Word.fromInt 5))
Byte.byteToChar (Byte.charToByte #"x")
General.ignore 5
LargeInt.toString (LargeInt.fromInt 12)
