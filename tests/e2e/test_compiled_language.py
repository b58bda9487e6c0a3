"""CPN ML in compiled nets: functions, references, exceptions and data types as values, against the token game.

Each program is a net with one transition, whose output arcs are the expressions, for three values of `n`. Compiled
with all warnings as errors, run under sanitizers.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.ml_programs import INTS, PROGRAMS, net_of
from helpers.netbuilder import flat
from helpers.thorough import amount

pytestmark = pytest.mark.cc


@pytest.mark.parametrize("name", [*PROGRAMS][:: amount(3, 1)])
def test_programs(name: str, workshop: Workshop, tmp_path: Path) -> None:
    net = flat(net_of(*PROGRAMS[name]))
    compiled, d = lowered(net)
    assert compiled is not None, [f"{e.message} ({e.origin.describe()})" for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    for seed in (1, 2):
        assert agrees(net, program, seed=seed, steps=10) == 3


STATE = """
    net Cell
      standard
      colset LST = list INT;
      val a = ref [0]
      val alias = a
      val cells = [ref "x", ref "y"]
      val same = List.nth (cells, 1)
      val counter = let val r = ref 0 in {get = fn () => !r, up = fn () => r := !r + 1} end
      val hooks = ref ([] : (int -> int) list)
      exception Last of string
      val last = ref Div
      datatype node = End | Link of int * node ref
      val ring = let val e = ref End val h = Link (1, e) in (e := h; ref h) end
      fun turn () = case !ring of Link (x, r) =>
          (case !r of Link (y, q) => (ring := Link (y + 1, ref (Link (x, r)))) | End => ())
        | End => ()
      fun value () = case !ring of Link (x, r) => x | End => ~1
      fun trim l = if length l > 40 then List.take (l, 40) else l
      fun turned n = (a := trim (n :: !alias); same := Int.toString n ^ !same; same := substring (!same, 0, 2);
         #up counter ();
         hooks := (fn x => x + n) :: (if length (!hooks) > 5 then List.take (!hooks, 5) else !hooks);
         last := (if n mod 2 = 0 then Last (Int.toString n) else (raise !last) handle e => e);
         turn (); List.tabulate (300, fn i => i + n))
      fun seen () = length (!a) + hd (!alias) + #get counter () + foldl (fn (f, x) => f x) 0 (!hooks) + value ()
      fun word () = !(List.last cells) ^ !same ^ ((raise !last) handle Last s => s | e => exnName e)
      var n: INT;
      var l: LST;
      place P : INT = 1`1
      place Q : INT
      place S : STRING
      place L : LST = 1`[]
      trans T code input (n); output (l); action turned n
        in P : n
        out P : (n * 7 + 3) mod 1000
        out L : l
        out Q : seen ()
        out S : word ()
        reset Q
        reset S
        reset L
"""


def test_references_stay_shared_when_values_move(workshop: Workshop, tmp_path: Path) -> None:
    """The steps fill the arena several times; aliases, captured references and rings are still the same."""
    net = flat(STATE)
    compiled, _ = lowered(net)
    assert compiled is not None
    assert agrees(net, workshop.build(compiled, tmp_path), seed=1, steps=700) == 701


DELAYS = """
    net Cell
      standard
      colset JOB = int timed;
      val two = 2
      fun delay n = n mod 4
      var n: INT;
      var j: JOB;
      place N : INT = 1`1 ++ 1`2 ++ 1`3 ++ 1`7
      place P : JOB = 1`1@5 +++ 1`2@9 +++ 1`3@30
      place Q : JOB
      trans T
        in N : n
        in P : j@+(delay n)
        out N : n + 1
        out P : j@+12
      trans U
        in P : j@+two
        out Q : j
"""


def test_computed_delays_of_input_arcs(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(DELAYS)
    compiled, _ = lowered(net)
    assert compiled is not None
    program = workshop.build(compiled, tmp_path)
    assert all(agrees(net, program, seed=seed, steps=40) > 3 for seed in (1, 2, 3))


def test_what_declarations_do_is_done(workshop: Workshop, tmp_path: Path) -> None:
    text = net_of(
        """
        val seen = ref 1
        val _ = seen := 5
        val unused = (seen := !seen * 3; 7)
        val () = seen := !seen + 1
        """,
        {INTS: ["n + !seen"]},
    )
    net = flat(text)
    compiled, _ = lowered(net)
    assert compiled is not None
    assert agrees(net, workshop.build(compiled, tmp_path), seed=1, steps=10) == 3
