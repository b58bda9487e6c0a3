"""`IntInf.int` in compiled nets: against Python's integers, in places against the token game, and where memory ends."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

NUMBERS = """
    net Numbers
      standard
      fun read s = valOf (IntInf.fromString s)
      fun order (a, b) = case IntInf.compare (a, b) of LESS => "<" | EQUAL => "=" | GREATER => ">"
      fun yes true = "t" | yes false = "f"
      fun texts (a, b, n) =
        let val shown = List.map IntInf.toString
            fun safe f = f () handle Div => [] | Domain => [] | Overflow => []
            val w = Word.fromInt n
        in String.concatWith " " (List.concat [
          shown [a + b, a - b, a * b, ~ a, abs a, IntInf.min (a, b), IntInf.max (a, b)],
          shown (safe (fn () => [a div b, a mod b, IntInf.quot (a, b), IntInf.rem (a, b)])),
          shown (safe (fn () => let val (q, r) = IntInf.divMod (a, b) in [q, r] end)),
          shown (safe (fn () => let val (q, r) = IntInf.quotRem (a, b) in [q, r] end)),
          shown [IntInf.andb (a, b), IntInf.orb (a, b), IntInf.xorb (a, b), IntInf.notb a],
          shown [IntInf.<< (a, w), IntInf.~>> (a, w), IntInf.pow (a, n mod 7)],
          [order (a, b), yes (a = b), yes (a < b), yes (a <= b), yes (a > b), yes (a >= b)],
          [Int.toString (IntInf.sign a), yes (IntInf.sameSign (a, b))],
          List.map Int.toString (safe (fn () => [IntInf.log2 a])),
          List.map Int.toString (safe (fn () => [IntInf.toInt a])),
          [IntInf.fmt StringCvt.HEX a, IntInf.fmt StringCvt.BIN b, IntInf.fmt StringCvt.OCT a],
          [Real.fmt (StringCvt.SCI (SOME 11)) (Real.fromLargeInt a)]])
        end
"""


STEPS = """
var i : INT;
var s : STRING;
place Todo : INT = 0
place Done : STRING = ""
trans Next
  in Todo : i
  in Done : s
  out Todo : i + 1
  out Done : texts (case_ i)
"""


def quotient(a: int, b: int) -> int:
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


def sml(number: int | str) -> str:
    return str(number).replace("-", "~")


def expected(a: int, b: int, n: int) -> Iterator[int | str]:
    yield from (a + b, a - b, a * b, -a, abs(a), min(a, b), max(a, b))
    if b != 0:
        q = quotient(a, b)
        yield from (a // b, a % b, q, a - b * q, a // b, a % b, q, a - b * q)
    yield from (a & b, a | b, a ^ b, ~a, a << n, a >> n, a ** (n % 7))
    yield "=" if a == b else "<" if a < b else ">"
    yield from ("ft"[x] for x in (a == b, a < b, a <= b, a > b, a >= b))
    sign = (a > 0) - (a < 0)
    yield from (sign, "ft"[sign == (b > 0) - (b < 0)])
    if a > 0:
        yield a.bit_length() - 1
    if -(2**30) <= a < 2**30:
        yield a
    yield from (format(a, "x"), format(b, "b"), format(a, "o"))
    digits, exponent = format(float(a), ".11e").split("e")
    yield f"{digits}E{int(exponent)}"


def any_number(chance: random.Random) -> int:
    """Around powers of two, where carries and the change of representation are, or anywhere."""
    bits = chance.choice([1, 8, 30, 31, 32, 33, 62, 63, 64, 65, 95, 96, 97, 128, 200, 320])
    number = chance.choice(
        [
            2**bits + chance.randint(-2, 2),
            chance.randrange(2**bits),
            chance.randrange(2**bits) << chance.choice([31, 32, 64]),
            (2**bits - 1) << chance.choice([1, 32, 33]),
        ]
    )
    return number * chance.choice([1, -1])


def test_operations_agree_with_python(tmp_path: Path, workshop: Workshop) -> None:
    chance = random.Random(1)
    cases = [
        (any_number(chance), any_number(chance), chance.choice([0, 1, 31, 32, 33, 64, 100]))
        for _ in range(300)
    ]
    cases += [(-(2**63), -1, 1), (-(2**63), 1, 63), (2**63, -1, 1), (0, 0, 0), (5, 0, 3)]
    clauses = [
        # half of the numbers are literals, half are read
        f'case_ {i} = ({sml(a)}, read "{sml(b)}", {n})'
        if i % 2
        else f'case_ {i} = (read "{sml(a)}", {sml(b)}, {n})'
        for i, (a, b, n) in enumerate(cases)
    ]
    lines = [f"fun {' | '.join(clauses)} | case_ _ = (0, 0, 0)", *STEPS.splitlines()]
    net, d = lowered(flat(NUMBERS + "\n".join(f"      {line}" for line in lines)))
    assert net is not None, [(e.code, e.message) for e in d.errors]
    _, *steps = run(workshop.build(net, tmp_path / "net"), 1, len(cases))
    for (a, b, n), line in zip(cases, steps, strict=True):
        [[_, text]] = line["marking"]["Top.Done"]
        assert text == " ".join(map(sml, expected(a, b, n))), (a, b, n)


PLACES = """
    net Places
      standard
      colset I = intinf;
      colset Small = intinf with 3..6;
      colset Wide = intinf with ~1000000000000000000000000..1000000000000000000000000;
      colset L = list I;
      colset R = record n: I * items: L;
      colset U = union None + Number: I + Pair: R;
      colset T = intinf timed;
      exception Large of IntInf.int
      val limit : IntInf.int = 340282366920938463463374607431768211456
      fun half (n : IntInf.int) = if n > limit then raise Large (n div 2) else n * 3 + 1
      fun grow n = half n handle Large m => m
      val last = ref (0 : IntInf.int)
      var n, m : I;
      var r : R;
      var u : U;
      var s : Small;
      var t : T;
      var w : Wide;
      place A : I = 1`7 ++ 2`18446744073709551616 ++ 1`(~18446744073709551617) ++ 1`9223372036854775808
      place B : R = 1`{n = 5, items = [1, 2]}
      place C : U = 1`None ++ 1`Number 36893488147419103232
      place D : Small = Small.all ()
      place E : T = 1`99999999999999999999 @ 3
      place F : Wide = 1`0
      trans Grow
        in A : n
        in B : r
        out A : grow (n * n + 1)
        out B : R.set_items r (List.take (n :: #items r, Int.min (4, 1 + length (#items r))))
        code input (n); action (last := n);
      trans Swap
        in C : u
        in A : n
        out A : case u of None => n + 1 | Number 36893488147419103232 => n - 1 | Number k => k | Pair {n = k, ...} => k
        out C : case u of None => Number n | Number k => Pair {n = k, items = [k, n]} | Pair _ => None
      trans Pick
        in D : s
        in B : r
        out B : R.set_n r (!last + s * s)
        out D : s
      trans Tick
        in E : t
        in F : w
        out E : t * ~3 @+ 2
        out F : if abs (w * 1000003 + time ()) > 1000000000000000000000000 then 1 else w * 1000003 + time ()
"""


def test_places_agree_with_the_token_game(tmp_path: Path, workshop: Workshop) -> None:
    net = flat(PLACES)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(ir, tmp_path / "net")
    for seed in range(4):
        assert agrees(net, program, seed=seed, steps=60) == 61


def test_a_number_too_large_for_the_memory(tmp_path: Path, workshop: Workshop) -> None:
    net = flat("""
        net Huge
          standard
          place A : INTINF = IntInf.<< (1, Word.fromInt 1000000000) handle _ => 1
    """)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    [line] = run(workshop.build(ir, tmp_path / "net"), 1, 0)
    assert line["error"] == "memory for lists and strings is full"


def test_beyond_the_reals_and_long_texts(tmp_path: Path, workshop: Workshop) -> None:
    net = flat("""
        net Reals
          standard
          fun safe f = IntInf.toString (f ()) handle Overflow => "Overflow" | Domain => "Domain"
          place A : STRING = 1`(Real.toString (Real.fromLargeInt (IntInf.pow (10, 400))))
            ++ 1`(Real.toString (Real.fromLargeInt (~ (IntInf.pow (10, 400)))))
            ++ 1`(safe (fn () => Real.toLargeInt IEEEReal.TO_ZERO (1.0 / 0.0)))
            ++ 1`(safe (fn () => Real.toLargeInt IEEEReal.TO_ZERO (0.0 / 0.0)))
            ++ 1`(safe (fn () => Real.toLargeInt IEEEReal.TO_NEAREST 1E300))
          place Long : STRING = 1`(INTINF.mkstr (IntInf.pow (7, 6000)))
    """)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(ir, tmp_path / "net")
    assert agrees(net, program, seed=1, steps=0) == 0
