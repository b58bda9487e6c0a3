let val t = List.tabulate (256, chr) in map (fn p => length (List.filter p t)) [Char.isAlpha, Char.isDigit, Char.isAlphaNum, Char.isSpace, Char.isUpper, Char.isLower, Char.isPunct, Char.isHexDigit, Char.isPrint, Char.isGraph, Char.isCntrl, Char.isAscii] end
String.concat (map Char.toString (List.tabulate (40, chr)))
String.concat (map Char.toString (List.tabulate (40, fn i => chr (i + 120))))
String.concat (map Char.toCString (List.tabulate (40, chr)))
map (str o Char.toUpper) [#"a", #"z", #"{", #"\200"]
Int.scan StringCvt.DEC List.getItem (explode " ~12rest")
Int.scan StringCvt.HEX Substring.getc (Substring.full "0xFFg")
Int.scan StringCvt.OCT List.getItem (explode "789")
Int.scan StringCvt.DEC List.getItem [#" ", #"-"]
Bool.scan Substring.getc (Substring.full "  trueish")
Char.scan List.getItem (explode "\\nrest")
StringCvt.splitl Char.isDigit List.getItem (explode "12ab")
StringCvt.takel Char.isAlpha Substring.getc (Substring.full "ab1")
StringCvt.dropl Char.isSpace List.getItem (explode "  x")
StringCvt.skipWS List.getItem (explode " \n\tx ")
StringCvt.scanString Real.scan "2.5"
StringCvt.scanString Bool.scan "false"
Int.fmt StringCvt.HEX ~255
map (Int.fmt StringCvt.BIN) [0, 1, 2, 1073741823]
Int.fromString "1_000"
Int.fromString " \t\n 7"
Int.fromString "~ 7"
Int.fromString "+-7"
Int.fromString "007"
Real.fromString "1."
Real.fromString "~1.5e~2"
Real.fromString "1.5E+2"
Real.fromString "+.25"
Real.fromString "1e"
Real.fromString "e5"
Real.fromString "-3"
Real.fmt (StringCvt.FIX (SOME 3)) ~0.0006
Real.fmt (StringCvt.FIX (SOME 1)) 123456.789
Real.fmt (StringCvt.SCI (SOME 0)) 12345.0
Real.fmt (StringCvt.SCI (SOME 2)) ~0.00012345
Real.fmt (StringCvt.FIX (SOME 2)) 0.0
Real.fmt (StringCvt.FIX (SOME 2)) (1.0 / 0.0)
Real.fmt (StringCvt.SCI (SOME 2)) 0.0
Real.fmt (StringCvt.GEN (SOME 3)) 0.5
Real.fmt (StringCvt.GEN NONE) 100.0
Real.fmt (StringCvt.GEN (SOME 0)) 1.0
Real.rem (5.5, ~2.0)
Real.rem (~5.5, 2.0)
Real.toManExp ~0.75
Real.toManExp 0.0
Real.split ~2.25
Real.realMod ~2.25
Real.nextAfter (1.0, 2.0) > 1.0
Real.isNormal (1E~300 / 1E10)
Real.sign ~0.0
Real.compare (~0.0, 0.0)
Real.min (1.0, 0.0 / 0.0)
Real.max (0.0 / 0.0, 1.0)
Real.toInt IEEEReal.TO_POSINF 2.1
Real.toInt IEEEReal.TO_NEGINF ~2.1
Real.toInt IEEEReal.TO_NEAREST 2.5
Real.round 1073741823.4
Math.atan2 (0.0, ~1.0)
Math.atan2 (~1.0, 0.0)
Math.pow (0.0, 0.0)
Math.pow (2.0, ~1.0)
Math.pow (~2.0, 0.5)
Math.exp 710.0
Math.exp ~1000.0
Math.ln ~1.0
Math.asin 2.0
Math.sqrt 0.0
Math.tanh 20.0
Math.log10 0.001
IntInf.andb (~4, 7)
IntInf.orb (~8, 3)
IntInf.xorb (~1, 5)
IntInf.notb ~1
IntInf.<< (3, Word.fromInt 4)
IntInf.~>> (~17, Word.fromInt 2)
IntInf.log2 1
IntInf.divMod (17, ~5)
IntInf.quotRem (17, ~5)
IntInf.pow (3, 0)
IntInf.pow (~1, 5)
IntInf.fmt StringCvt.HEX ~256
IntInf.fromString "~12x"
IntInf.sameSign (~1, 1)
IntInf.compare (~5, 3)
String.tokens (fn c => c = #"-") "--a--b--"
String.fields (fn c => c = #"-") "-a--b"
String.tokens (fn _ => true) "abc"
String.fields (fn _ => false) "abc"
String.fromString "a\\tb\\\\c\\\"d\\065\\^A"
String.fromString "\\u0041"
String.fromString "\\300"
String.fromString "line\nbreak"
String.fromString "\\   \n  \\end"
String.toString "caf\233"
String.concatWith "," ["only"]
String.isSuffix "" "abc"
String.isSubstring "aab" "aaab"
String.translate (fn #"\n" => "\\n" | #"<" => "&lt;" | c => str c) "a<b\nc"
String.extract ("abc", 1, SOME 0)
String.extract ("abc", ~1, NONE)
String.compare ("a", "B")
String.map (fn c => chr (ord c + 1)) "HAL"
substring ("abc", 3, 0)
List.take ([1, 2, 3], 3)
List.take ([1], ~1)
List.drop ([1, 2], 0)
List.drop ([1, 2], 3)
List.tabulate (3, fn i => if i = 2 then raise Fail "two" else i)
List.getItem [1]
List.mapPartial Int.fromString ["1", "x", "3"]
List.concat ([] : int list list)
List.revAppend ([], [1])
List.collate String.compare (["a", "b"], ["a", "c"])
List.find (fn x => x > 1) [1, 2, 3]
ListPair.foldrEq (fn (a, b, c) => a + b + c) 0 ([1, 2], [3, 4])
ListPair.foldlEq (fn (a, b, c) => a + b + c) 0 ([1], [3, 4])
ListPair.appEq (fn (a, b) => ()) ([1], [2, 3])
ListPair.mapEq (fn (a, b) => a + b) ([1], [])
ListPair.all (fn (a, b) => a = b) ([1, 2], [1, 2, 3])
ListPair.allEq (fn (a, b) => a = b) ([1, 2], [1, 2])
Option.app (fn _ => ()) NONE
Option.compose (fn x => x * 2, fn x => if x > 0 then SOME x else NONE) ~1
(General.o (fn x => x + 1, fn x => x * 2)) 4
General.before (1, ())
Word.toIntX (Word.fromInt ~5)
Word.toInt (Word.notb (Word.notb (Word.fromInt 9)))
Word.toInt (Word.- (Word.fromInt 9, Word.fromInt 4))
Word.compare (Word.fromInt 3, Word.fromInt 4)
Word.toInt (Word.~>> (Word.fromInt 16, Word.fromInt 2))
Word.fmt StringCvt.BIN (Word.fromInt 10)
Word.fromString "ff"
Word.toInt (Word.max (Word.fromInt 3, Word.fromInt 7))
Byte.bytesToString (Byte.stringToBytes "round")
Substring.string (Substring.trimr 1 (Substring.triml 1 (Substring.full "(x)")))
Substring.triml ~1 (Substring.full "a")
Substring.sub (Substring.full "abc", 3)
Substring.splitAt (Substring.full "abc", 4)
Substring.position "" (Substring.full "abc")
Substring.isSubstring "bc" (Substring.full "abcd")
Substring.collate Char.compare (Substring.full "ab", Substring.full "b")
Vector.sub (Vector.tabulate (3, fn i => i * 10), 2)
Vector.foldri (fn (i, x, l) => (i, x) :: l) [] (Vector.fromList ["a", "b"])
Vector.map Int.toString (Vector.fromList [1, 2])
Vector.update (Vector.fromList [1], 1, 2)
Array.foldr (op ::) [] (Array.tabulate (3, fn i => i))
Array.exists (fn x => x = 3) (Array.fromList [1, 2, 3])
Array.collate Int.compare (Array.fromList [1, 2], Array.fromList [1])
let val a = Array.fromList [1, 2, 3, 4] in Array.copy {src = a, dst = a, di = 0}; Array.modifyi (fn (i, x) => i + x) a; a end
Array.copy {src = Array.fromList [1, 2], dst = Array.fromList [1], di = 0}
Time.toSeconds (Time.fromSeconds 90)
Time.toMilliseconds (Time.fromReal 1.5)
Time.fmt 2 (Time.fromReal 1.239)
Time.toString (Time.fromReal 2.5)
Time.compare (Time.fromSeconds 1, Time.fromSeconds 2)
Time.toReal (Time.+ (Time.fromSeconds 1, Time.fromReal 0.25))
Time.< (Time.zeroTime, Time.fromSeconds 1)
OS.Path.concat ("a", "b/c")
OS.Path.concat ("", "b")
OS.Path.concat ("a/", "b")
OS.Path.file "/a/b.c.txt"
OS.Path.ext "a.tar.gz"
OS.Path.ext "noext"
OS.Path.ext ".hidden"
OS.Path.base "dir.d/file"
OS.Path.splitBaseExt "a.b"
OS.Path.joinBaseExt {base = "a", ext = SOME "txt"}
OS.Path.joinBaseExt {base = "a", ext = NONE}
OS.Path.dir "file"
OS.Path.dir "/file"
OS.Path.splitDirFile "a/b/c"
OS.Path.joinDirFile {dir = "", file = "f"}
OS.Path.mkCanonical "./a/../b//c/"
OS.Path.mkCanonical ""
OS.Path.mkCanonical "/.."
OS.Path.isCanonical "a/./b"
OS.Path.getParent "a"
OS.Path.getParent "/"
OS.Path.getParent ".."
OS.Path.fromString "/a/b"
OS.Path.fromString "a//b"
OS.Path.toString {isAbs = true, vol = "", arcs = ["x", "y"]}
OS.Path.mkAbsolute {path = "a/b", relativeTo = "/c"}
OS.Path.mkRelative {path = "/a/b/c", relativeTo = "/a/d"}
OS.Path.isRoot "/"
