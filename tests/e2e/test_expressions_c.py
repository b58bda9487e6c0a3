"""CPN ML over the whole library and all kinds of colour sets: compiled code and the evaluator say the same.

`./dev fuzz --expressions N` and `--inscriptions N` take more of the random ones.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.compiled_expressions import PER_NET, Expressions, differing
from helpers.declarations import wrong
from helpers.netbuilder import flat
from helpers.random_inscriptions import Inscriptions
from helpers.thorough import amount

pytestmark = pytest.mark.cc

UNITS = r"""
let val r = ref (ref ()) in (!r := (); r := ref (); !(!r)) end
let val r = ref () in (r := print ""; !r) end
let val r = ref (SOME ()) in (r := NONE; !r) end
let val (r, s) = (ref (), ref 1) in (s := (r := (); 4); !s) end
let fun f () = () fun g x = (f (); f (); x) in g (f ()) end
let fun f (x : unit) = if x = () then 1 else 2 in f () end
let exception X of unit in (raise X ()) handle X u => u end
let val a = Array.array (2, ()) in Array.update (a, 0, ()); Array.sub (a, 0) end
Vector.sub (Vector.fromList [(), ()], 1)
UNIT.illegal_msg (UNIT.base)
(raise Bare; ()) = () handle Bare => false
foldl (fn ((), ()) => ()) () [(), ()]
List.nth ([()], 1) handle Subscript => ()
cf ((), [(), (), ()])
case () of () => 1
case STRING.ord "x" of 0 => () | _ => ()
case hd [] of 0 => () | _ => ()
"""
KNOWN = r"""
case [] of x :: y :: nil => 1 | nil => 2 | _ => 3
case [] of [[x]] => x | nil => 2 | _ => 3
case [] of {a, b} :: _ => a + b | _ => 3
case [] of Num x :: _ => x + 0 | _ => 3
let val [x] = [] in x + 1 end
(fn x :: _ => x + 0 | nil => 7) []
case NONE of SOME (SOME x) => x + 1 | _ => 2
case ([], [1]) of (x :: _, _) => x + 1 | (_, y :: _) => y | _ => 0
case Num 3 of Txt x => x | Num n => Int.toString n | Quit => "q"
case Knot (Leaf, (), Leaf) of Knot (Leaf, x, Knot (_, y, _)) => 1 | Knot (Leaf, _, Leaf) => 2 | _ => 3
let exception X of int list in ((raise X []) handle X (x :: _) => x | X nil => 9) end
"""
UNREAD = r"""
let val r = ref 1 in (r := 2; 5) end
let val r = ref [1] val s = ref r in (s := ref [3]; r := [2]; 5) end
let val r = ref 1 in (r := hd []; 5) end
let val r = ref 1 val s = ref 1 in (while !r < 3 do (r := !r + 1; s := !r); 5) end
let val x = (down, EvenOf four) in 3 end
"""
LISTS = r"""
cf ([1, 2], [[1], [1, 2]])
cf (([1], 2), [([1], 2), ([], 2)])
rm [1] [[2], [1], [3]]
rmall [1] [[2], [1], [3], [1]]
mem [[1], [2]] [2]
contains [[1], [2]] [[2]]
listsub [[1], [2]] [[2]]
2`[1] ++ 3`[2] -- 1`[1]
(1`[1]) <<= (1`[] ++ 1`[1])
"""
COLOURS = r"""
FEW.size ()
EVEN.all ()
MIX.base
LW.illegal_msg [green, FEWL.base, blue]
UE.col 1
UE.col 3
UE.col 5
UE.col 6
MIX.col 2
MIX.col 3
REC.ord {b = ~1073741824 * ~2, a = "a"}
PAIR.col (1073741823 + 1)
UT'timed.col (raise Bare)
Int.max (hd [], SMALL.col 9)
StringCvt.padRight (String.sub ("", 2)) (SMALL.col 9) "a"
TRIPLE.mult ([true], [ph 1], LONG.col (~1))
let val r = ref 0 fun f () = (r := !r + 1; ["a"]) in (PAIR.mult ([1, 2, 3], f ()), !r) end
let val r = ref 0 fun f () = (r := !r + 1; !r) in (SPAIR.set_1 (1, red) (f ()), !r) end
"""
NOT_FINITE = r"""
let val n = 0.0/0.0 in (n = n, n <> n, n < n, n >= n, [n] = [n], (1,n) = (1,n), SOME n = SOME n) end
let val n = 0.0/0.0 in (mem [n] n, contains [n] [n], rm n [n], rmall n [n], cf (n, [n]), remdupl [n,n]) end
let val n = 0.0/0.0 in ([n] == [n], [n] <<== [n], [n] <<= [n], size (1`n ++ 1`n)) end
let val n = 0.0/0.0 in [n] -- [n] end
let val n = 0.0/0.0 in 1`n ++ 1`1.0 ++ 1`n end
let val n = 0.0/0.0 in (REAL.lt (n, 1.0), REAL.lt (1.0, n)) end
let val n = 0.0/0.0 in REAL.legal n end
let val n = 0.0/0.0 in Real.compare (n, 1.0) end
let val n = 0.0/0.0 in Real.min (n, 1.0) end
let val n = 0.0/0.0 in Real.max (1.0, n) end
let val n = 0.0/0.0 in sort REAL.lt [3.0, n, 1.0] end
let val n = 0.0/0.0 in (floor n) end
let val n = 0.0/0.0 in (round n) end
Real.copySign (1.0, 0.0/0.0)
Real.sameSign (1.0, 0.0/0.0)
Real.signBit (Math.sqrt ~1.0)
Real.fromString "nan"
Real.fromString "~inf"
REALP.cmp ((1.0,1),(0.0/0.0,2))
REAL.cmp (0.0/0.0, 1.0)
let val n = 0.0/0.0 in (PART.lt (n, 1.0), PART.lt (1.0, n)) end
let val n = 0.0/0.0 in sort REALP.lt [(n,2),(1.0,1),(n,1)] end
"""
LARGE = r"""
Real.fmt (StringCvt.FIX (SOME 1110)) Real.minPos
Real.fmt (StringCvt.SCI (SOME 1110)) 1.5E~300
Real.fmt (StringCvt.FIX (SOME 2000)) ~1.5
Real.fmt (StringCvt.GEN (SOME 2000)) 0.1
Real.fmt (StringCvt.FIX (SOME 1073741823)) 1.5
Real.fmt (StringCvt.SCI (SOME 20000000)) 1.5
StringCvt.padLeft #"x" ~1073741824 "a"
StringCvt.padRight #"x" 16777216 "a"
IntInf.pow (1, ~5)
IntInf.pow (0, ~1)
IntInf.pow (~1, ~3)
Real.fromString "1e1073741824"
Real.fromString "1e~1073741823"
Real.fromString "1.e5"
Vector.tabulate (16777216, fn i => (raise Empty) : int)
Array.tabulate (16777216, fn i => (raise Empty) : int)
Array.copy {src = Array.array (3, 0), dst = Array.array (3, 1), di = 1073741821}
ignore (Time.fromReal (0.0 / 0.0))
StringCvt.padLeft #"a" 1073741823 "b"
Array.array (1073741823, 1)
Array.copyVec {src = Vector.fromList [1], dst = Array.fromList [1, 2], di = 1073741823}
String.extract ("abc", ~1073741824, NONE)
Substring.slice (Substring.full "abc", ~1073741824, NONE)
split (~1073741824, [1], [])
Real.signBit (Real.realRound (~0.5))
Real.signBit (Real.realCeil (~0.5))
"""


def test_corners(tmp_path: Path, fast_workshop: Workshop) -> None:
    """Units, what is known when code is made, what nobody reads, lists in lists, colour sets with subsets."""
    made = Expressions(1, tmp_path)
    texts = [
        t for t in (UNITS + KNOWN + UNREAD + LISTS + COLOURS + NOT_FINITE + LARGE).splitlines() if t
    ]
    found = [one for text in texts for one in made.defined(text)]
    assert [one.text for one in found] == texts
    assert differing(made, found, fast_workshop) == []


@pytest.mark.parametrize("seed", range(amount(1, 25)))
def test_random_expressions(tmp_path: Path, fast_workshop: Workshop, seed: int) -> None:
    made = Expressions(seed, tmp_path)
    assert differing(made, made.some(PER_NET), fast_workshop) == []


@pytest.mark.parametrize("number", range(amount(1, 40)))
def test_random_inscriptions(tmp_path: Path, fast_workshop: Workshop, number: int) -> None:
    why = wrong(Inscriptions(tmp_path).sheet(number, 10), fast_workshop)
    assert not why, why[:3000]


DATATYPE = """
net Own
  standard
  var n : INT;
  place A : INT = 1`1 ++ 1`2
  place B : INT
  trans T guard [let datatype d = X | Y of int in case Y n of Y k => k < 2 | X => false end]
    in A : n
    out B : let datatype d = X of int | Z in case (if n = 1 then X 5 else Z) of Z => 1`n | X k => 2`k end
"""


def test_datatypes_of_inscriptions(tmp_path: Path, fast_workshop: Workshop) -> None:
    net = flat(DATATYPE)
    ir, d = lowered(net)
    assert ir is not None, [e.message for e in d.errors]
    assert agrees(net, fast_workshop.build(ir, tmp_path / "own"), seed=1, steps=3) == 1


LARGE_ONLY = """
net Large
  standard
  colset PAIR = product INTINF * BOOL;
  var n : INTINF;
  var b : BOOL;
  place A : INTINF = 1`(IntInf.pow (10, 30))
  place B : PAIR = 1`(IntInf.pow (7, 40), true)
  trans T
    in A : n
    out A : n * 3
  trans U
    in B : (n, b)
    out B : (n + IntInf.pow (2, 90), not b)
"""


def test_large_integers_stay(tmp_path: Path, workshop: Workshop) -> None:
    """Where nothing else in the net lies in the arena, which is compacted between the steps."""
    net = flat(LARGE_ONLY)
    ir, _ = lowered(net)
    assert ir is not None
    assert agrees(net, workshop.build(ir, tmp_path / "large"), seed=1, steps=20) == 21
