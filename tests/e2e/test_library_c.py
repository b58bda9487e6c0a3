"""Library functions in compiled code: each expression has the value that a real ML gives it.

The values are those of Poly/ML 5.7.1 (widths of int and word: those of CPN Tools).
"""

from __future__ import annotations

import pytest

from helpers.compiled import Workshop, lowered, run
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

DECLARATIONS = """
    net Library
      standard
      fun int_option NONE = "NONE" | int_option (SOME n) = "SOME " ^ Int.toString n
      fun real_option NONE = "NONE" | real_option (SOME x) = "SOME " ^ Real.toString x
      fun strings xs = "[" ^ String.concatWith "," xs ^ "]"
      fun ints (xs: int list) = strings (map Int.toString xs)
      fun pair f g (a, b) = "(" ^ f a ^ "," ^ g b ^ ")"
      fun same (s: string) = s
      fun order LESS = "<" | order EQUAL = "=" | order GREATER = ">"
      fun up c = Char.toUpper c
      fun is_comma c = c = #","
"""

VALUES = r"""
String.map up "abc-x"
  ABC-X
String.translate (fn #"a" => "<a>" | c => str c) "banana"
  b<a>n<a>n<a>
strings (String.tokens is_comma ",a,,bc,")
  [a,bc]
strings (String.fields is_comma ",a,,bc,")
  [,a,,bc,]
strings (String.fields is_comma "")
  []
String.concatWith "" ["a", "b"]
  ab
String.extract ("hello", 2, NONE) ^ String.extract ("hello", 1, SOME 2)
  lloel
order (String.collate (fn (a, b) => Char.compare (b, a)) ("ab", "b"))
  >
String.toString "a\n\"\200\t\001"
  a\\n\\\"\\200\\t\\^A
valOf (String.fromString "a\\nb\\065")
  a\nbA
Bool.toString (Char.contains "xyz" #"y" andalso Char.notContains "xyz" #"a" andalso Char.isPunct #"!")
  true
str (Char.succ #"a") ^ str (Char.pred #"b")
  ba
Char.toString #"\127" ^ Char.toString (chr 10)
  \\127\\n
int_option (Int.fromString "  ~12ab") ^ int_option (Int.fromString "x")
  SOME ~12NONE
int_option (Int.fromString "+5") ^ int_option (Int.fromString "-5")
  SOME 5SOME ~5
Int.fmt StringCvt.HEX 255 ^ Int.fmt StringCvt.BIN (~5) ^ Int.fmt StringCvt.OCT 8 ^ Int.fmt StringCvt.DEC 0
  FF~101100
int_option (StringCvt.scanString (Int.scan StringCvt.HEX) "0xFf")
  SOME 255
int_option (Int.fromString "99999999999" handle Overflow => SOME 1)
  SOME 1
Bool.toString (Int.sameSign (~1, ~5))
  true
real_option (Real.fromString "1.5e2x") ^ real_option (Real.fromString "~.5") ^ real_option (Real.fromString "abc")
  SOME 150.0SOME ~0.5NONE
real_option (Real.fromString "12.") ^ real_option (Real.fromString " 3E") ^ real_option (Real.fromString "7E~3")
  SOME 12.0SOME 3.0SOME 0.007
Real.fmt (StringCvt.FIX (SOME 2)) 3.14159 ^ Real.fmt (StringCvt.SCI (SOME 3)) 31415.9
  3.143.142E4
Real.fmt (StringCvt.FIX NONE) 0.5
  0.500000
Real.fmt (StringCvt.GEN (SOME 3)) 1234567.0 ^ Real.fmt (StringCvt.FIX (SOME 0)) (~2.5)
  1.23E06~2
IntInf.toString (IntInf.pow (3, 20)) ^ IntInf.toString (IntInf.pow (~2, 5))
  3486784401~32
Int.toString (IntInf.log2 1025)
  10
IntInf.toString (IntInf.orb (5, 10)) ^ IntInf.toString (IntInf.andb (~4, 7)) ^ IntInf.toString (IntInf.notb 5)
  154~6
IntInf.toString (#1 (IntInf.divMod (~7, 2))) ^ IntInf.toString (#2 (IntInf.quotRem (~7, 2)))
  ~4~1
Bool.toString (valOf (Bool.fromString " true")) ^ Bool.toString (Option.isSome (Bool.fromString "True"))
  truefalse
Time.fmt 0 (Time.fromReal 2.5) ^ Time.fmt 0 (Time.fromReal ~3.5) ^ Time.fmt 3 (Time.fromMicroseconds 2501)
  2~40.003
int_option (Option.mapPartial (fn x => if x > 2 then SOME (x * 2) else NONE) (SOME 3))
  SOME 6
int_option (Option.join (SOME (SOME 4))) ^ int_option (Option.filter (fn x => x > 2) 2)
  SOME 4NONE
strings (ListPair.map (fn (a, b) => Int.toString (a * b)) ([1, 2, 3], [4, 5]))
  [4,10]
ints (map (fn (a, b) => a - b) (ListPair.zip ([5, 6], [1, 2, 3])))
  [4,4]
pair ints ints (ListPair.unzip [(1, 2), (3, 4)])
  ([1,3],[2,4])
Int.toString (ListPair.foldl (fn (a, b, c) => a * b + c) 0 ([1, 2, 3], [4, 5, 6]))
  32
strings (ListPair.foldr (fn (a, b, c) => (a ^ b) :: c) [] (["a", "b", "x"], ["c", "d"]))
  [ac,bd]
Bool.toString (ListPair.all (fn (a, b) => a < b) ([1, 2], [2, 3]) andalso ListPair.exists (op =) ([1], [1]))
  true
Int.toString (length (ListPair.zipEq ([1], [2, 3])) handle ListPair.UnequalLengths => 99)
  99
order (List.collate Int.compare ([1, 2], [1, 2, 3]))
  <
(case List.getItem [7, 8] of NONE => "none" | SOME (x, rest) => Int.toString x ^ ints rest)
  7[8]
pair ints ints (List.partition (fn x => x mod 2 = 0) [1, 2, 3, 4, 5, 6])
  ([2,4,6],[1,3,5])
StringCvt.padLeft #"0" 5 "42" ^ StringCvt.padRight #"." 5 "ab"
  00042ab...
Substring.string (Substring.triml 2 (Substring.full "hello"))
  llo
pair Substring.string Substring.string (Substring.splitl Char.isDigit (Substring.full "123abc"))
  (123,abc)
pair Substring.string Substring.string (Substring.position "lo" (Substring.full "hello world"))
  (hel,lo world)
strings (map Substring.string (Substring.tokens is_comma (Substring.full "a,,b")))
  [a,b]
ints (Vector.foldr (op ::) [] (Vector.update (Vector.fromList [1, 2, 3], 1, 9)))
  [1,9,3]
Int.toString (Vector.sub (Vector.tabulate (5, fn i => i * i), 3) + Vector.length (Vector.fromList [1]))
  10
Int.toString (Word.toInt (Word.andb (Word.fromInt 12, Word.fromInt 10)))
  8
Word.toString (Word.fromInt (~1)) ^ Word.toString (Word.<< (Word.fromInt 3, Word.fromInt 4))
  7FFFFFFF30
Real.toString (Real.realMod 2.75) ^ Real.toString (#whole (Real.split (~2.75)))
  0.75~2.0
Int.toString (#exp (Real.toManExp 8.0)) ^ Real.toString (Real.fromManExp {man = 0.5, exp = 3})
  44.0
Bool.toString (Real.signBit (~0.0) andalso Real.isNormal 1.0)
  true
Int.toString (Real.toInt IEEEReal.TO_NEGINF (~1.5)) ^ Int.toString (Real.toInt IEEEReal.TO_NEAREST 2.5)
  ~22
int_option (Option.map (fn x => x + 1) (Option.compose (fn x => x * 2, fn x => SOME x) 4))
  SOME 9
String.concat (ListPair.mapEq (fn (a, b) => a ^ b) (["a"], ["b"]))
  ab
ModelTime.toString (valOf (ModelTime.fromString "12")) ^ ModelTime.toString (ModelTime.maketime "3")
  123
Byte.bytesToString (Byte.stringToBytes "bytes")
  bytes
"""

CASES = list(zip(*[iter(VALUES.strip("\n").splitlines())] * 2, strict=True))


@pytest.fixture(scope="module")
def values(workshop: Workshop) -> dict[str, str]:
    """Expression -> its value, escaped as in ML."""
    places = [f"  place P{i} : STRING = String.toString ({e})" for i, (e, _) in enumerate(CASES)]
    net = flat(DECLARATIONS + "    " + "\n    ".join(places) + "\n")
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message, e.origin.describe()) for e in d.errors]
    [line] = run(workshop.build(ir, workshop.folder / "library"), 1, 0)
    assert "error" not in line, line
    names = {p.short: p.name for p in net.places}
    return {e: line["marking"][names[f"P{i}"]][0][1] for i, (e, _) in enumerate(CASES)}


@pytest.mark.parametrize(("expression", "expected"), CASES)
def test_value(expression: str, expected: str, values: dict[str, str]) -> None:
    assert values[expression] == expected.removeprefix("  ")
