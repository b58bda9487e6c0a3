"""Places for one token are slots in the generated C: all occurs as in the token game, and none is overwritten."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat
from helpers.thorough import amount
from pn2code.emission.c import emit
from pn2code.ir.nodes import NetIR
from pn2code.lowering.passes.analysis import bounded
from pn2code.net.flat import FlatNet

pytestmark = pytest.mark.cc

VALUES: dict[str, tuple[str, Callable[[str, Random], str]]] = {
    "UNIT": ("()", lambda v, r: r.choice((v, "()"))),
    "INT": ("3", lambda v, r: r.choice((v, f"{v} + 1", f"({v} * 7) mod 5", "2"))),
    "BOOL": ("true", lambda v, r: r.choice((v, f"not {v}", "false"))),
    "STRING": (
        '"a"',
        lambda v, r: r.choice((v, f'if size {v} > 6 then "" else {v} ^ "b"', '"zz"')),
    ),
    "PAIR": ("(1, true)", lambda v, r: r.choice((v, f"(#1 {v} + 1, not (#2 {v}))", "(0, false)"))),
    "POSE": (
        "{x = 1.5, n = 2}",
        lambda v, r: r.choice((v, f"{{x = #x {v} / 2.0, n = #n {v} + 1}}", f"POSE.set_n {v} 4")),
    ),
    "LIST": (
        "[1, 2]",
        lambda v, r: r.choice((v, f"if length {v} > 4 then [] else {v} ^^ [7]", f"rev {v}", "[]")),
    ),
    "KIND": ("Num 4", lambda v, r: r.choice((v, "Off", f"if {v} = Off then Num 1 else Off"))),
}
"""For each colour set a value, and expressions over a variable."""

HEAD = """
net Cell
  standard
  colset PAIR = product INT * BOOL;
  colset POSE = record x: REAL * n: INT;
  colset LIST = list INT;
  colset KIND = union Off + Num : INT;
"""


def safe_net(r: Random) -> tuple[str, set[str]]:
    """A net of machines that exchange values, and the places that hold one token at most.

    Each machine is in one of its places; places beside them hold more tokens, or have time stamps.
    """
    machines: list[tuple[str, list[str]]] = []
    lines = [HEAD.strip("\n")]
    for m in range(r.randint(3, 6)):
        kind = r.choice(list(VALUES))
        places = [f"M{m}_{i}" for i in range(r.randint(2, 4))]
        machines.append((kind, places))
        lines.append(f"  var v{m}: {kind};")
        lines += [
            f"  place {p} : {kind}" + (f" = 1`{VALUES[kind][0]}" if i == 0 else "")
            for i, p in enumerate(places)
        ]
    lines += ["  colset LATE = int timed;", "  var k: INT;", "  var late: LATE;"]
    lines += ["  place Many : INT = 2`1 ++ 1`4", "  place Late : LATE = 1`1@0 +++ 1`2@3"]
    for t in range(r.randint(6, 10)):
        lines += [f"  {line}" for line in _transition(t, machines, r)]
    return "\n".join(lines) + "\n", {p for _, places in machines for p in places}


def _transition(t: int, machines: list[tuple[str, list[str]]], r: Random) -> list[str]:
    found: list[str] = []
    for m in r.sample(range(len(machines)), r.randint(1, 3)):
        kind, places = machines[m]
        value, expression = VALUES[kind]
        here, there = r.choice((places[0], places[0], r.choice(places))), r.choice(places)
        taken = r.choice((f"v{m}", f"v{m}", f"v{m}", value, f"1`v{m}"))
        if kind == "LIST" and r.random() < 0.3:
            taken = f"k :: v{m}"
        put = expression(f"v{m}", r) if f"v{m}" in taken else value
        way = r.random()
        if way < 0.15:
            found.append(f"both {here} : v{m}")
        elif way < 0.3 and len(places) > 2:
            one, other = r.sample(places, 2)
            test = f"({put}) = ({put})"
            found += [f"in {here} : {taken}", f"out {one} : if {test} then 1`({put}) else empty"]
            found.append(f"out {other} : if {test} then empty else 1`({put})")
        elif way < 0.4:
            found += [
                f"in {here} : {taken}",
                f"out {there} : (if ({put}) = ({put}) then 1 else 0)`({put})",
            ]
        else:
            found += [f"in {here} : {taken}", f"out {there} : 1`({put})"]
        if r.random() < 0.1:
            found.append(f"inhibit {r.choice(places[1:])}")
    if r.random() < 0.25 and not any(" k ::" in line for line in found):
        found += ["in Many : k", "out Many : (k * 3) mod 7"]
    if r.random() < 0.15:
        found += ["in Late : late", "out Late : late@+2"]
    return [f"trans T{t}", *(f"  {line}" for line in found)]


def with_arrays_of_one(net: NetIR, places: set[str]) -> NetIR:
    """The net with arrays of one where a place holds one token at most."""
    short = [p.name.rsplit(".", 1)[-1] for p in net.places]
    return bounded(
        replace(
            net,
            places=tuple(
                replace(p, capacity=1, bound=1, proof="invariant") if name in places else p
                for p, name in zip(net.places, short, strict=True)
            ),
        )
    )


def compiled(
    text: str, places: set[str], workshop: Workshop, folder: Path
) -> tuple[FlatNet, Path, str]:
    """The walking program of a net with slots, and its net.h."""
    net = flat(text)
    ir, d = lowered(net)
    assert ir is not None, d.errors
    ir = with_arrays_of_one(ir, places)
    (header,) = (f.text for f in emit(ir, "test") if f.path == "net.h")
    return net, workshop.build(ir, folder), header


def slots_of(header: str) -> int:
    """How many places of the marking are slots."""
    return len(re.findall(r"^    \w+_slot(?:_\d+)?_t \w+;$", header, re.MULTILINE))


@pytest.mark.parametrize("seed", range(amount(3, 8)))
def test_random_nets_with_slots_and_token_game_agree(
    seed: int, workshop: Workshop, tmp_path: Path
) -> None:
    text, places = safe_net(Random(seed))
    net, program, header = compiled(text, places, workshop, tmp_path)
    assert slots_of(header) >= len(places) // 2, text
    steps = [agrees(net, program, seed=s, steps=60) for s in range(4)]
    assert sum(steps) > 8, text


@pytest.mark.parametrize(
    "put",
    [
        "1",
        "(if x > 0 then 1 else 0)`x",
        "x`9",
        "if x > 0 then 1`x else empty",
        "List.tabulate (x, fn i => i)",
    ],
)
def test_a_full_slot_stops_the_net(put: str, workshop: Workshop, tmp_path: Path) -> None:
    text = f"""
    net Cell
      standard
      var x: INT;
      place From : INT = 1`1
      place More : INT = 1`5
      place To : INT = 1`4
      trans Go
        in From : x
        in More : 5
        out To : {put}
    """
    _, program, header = compiled(text, {"From", "More", "To"}, workshop, tmp_path)
    assert slots_of(header) == 3
    lines = run(program, 1, 3)
    assert [name for name, _ in lines[0]["enabled"]] == ["Top.Go"]
    error = lines[1]
    assert "place is full" in str(error["error"]) and "To" in str(error), error


UNITS_OUT_OF_VALUES = """
net Found
  standard
  colset UNITS = list UNIT;
  colset WITH = union At : UNIT + Nowhere;
  colset BOTH = product UNIT * INT;
  val several = [(), (), ()];
  fun some n = if n > 0 then SOME () else NONE
  fun at n = if n > 0 then At () else Nowhere
  fun unit_of (At u) = u | unit_of Nowhere = ();
  fun both n = ((), n + 1)
  var i : INT;
  page Top
    place Number : INT = 1`1
    place Free = 1
"""
FOUND = (
    "List.nth (several, i)",
    "hd (List.take (several, i))",
    "List.last (List.drop (several, i))",
    "ms_to_col (List.take (several, i))",
    "valOf (some i)",
    "getOpt (some i, ())",
    "unit_of (at i)",
    "#1 (both i)",
    "if i > 3 then hd several else List.nth (several, i)",
    "case some i of SOME u => u | NONE => List.nth (several, i)",
    "(let val u = List.nth (several, i) in u end)",
    "(List.nth (several, i) handle Subscript => ())",
    "(fn u => u) (hd several)",
)  # fmt: skip


@pytest.mark.parametrize("slots", [{"Free", "Number"}, {"Number"}, set()])
def test_units_that_are_found_somewhere(
    slots: set[str], workshop: Workshop, tmp_path: Path
) -> None:
    """Nobody reads a value of the unit colour set, but finding it may raise, and its C has to compile."""
    text = UNITS_OUT_OF_VALUES
    for k, found in enumerate(FOUND):
        text += f"    trans T{k}\n      both Number : i\n      in Free : {found}\n      out Free : {found}\n"
    net, program, _ = compiled(text, slots, workshop, tmp_path)
    assert agrees(net, program, seed=1, steps=9) == 10
