"""Names of declared values in patterns are compared: what the engine of CPN Tools answered, both evaluators."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat, load
from pn2code.semantics.game.token_game import Game

HEAD = """
net Constants
  standard
  colset PAIR = product INT * INT;
  colset PAIRT = product INT * INT timed;
  colset NEST = product PAIR * INT;
  colset LIGHT = with red | green;
  colset REC = record a: LIGHT * b: INT;
  colset LIST = list INT;
  colset LISTED = product LIST * INT;
  colset U = union A: PAIR + B + C: INT;
  colset TEXTS = product STRING * INT;
  colset BOOLS = product BOOL * INT;
  colset REALS = product REAL * INT;
  val four = 4; val (one, five) = (1, 5); val go = green; val ab = "a" ^ "b"; val few = [1, 2];
  val yes = true; val none = []; val pair = (4, 1); val half = 0.5;
  val first = 4;
  var first, second: INT;
  val second = 4;
  var x, y: INT; var p: PAIR; var l: LIST;
"""

PAIRS = "1`(4,1)++1`(5,2)++1`(4,3)"
CASES = (
    ("PAIR", PAIRS, "(four, x)", "", ["x=1", "x=3"]),
    ("PAIR", PAIRS, "1`(four : INT, x)", "", ["x=1", "x=3"]),
    ("PAIR", PAIRS, "(x, one)", "", ["x=4"]),
    ("PAIR", PAIRS, "1`(x, one)++1`(five, y)", "", ["x=4,y=2"]),
    ("PAIR", PAIRS, "pair", "", [""]),
    ("PAIR", PAIRS, "(first, x)", "", ["x=1", "x=3"]),
    ("PAIR", PAIRS, "(second, x)", "", ["second=4,x=1", "second=4,x=3", "second=5,x=2"]),
    ("PAIR", PAIRS, "(second, x)", "guard [second > four]", ["second=5,x=2"]),
    ("PAIR", PAIRS, "(x, y)", "guard [(four, x) = (x, 4)]", ["x=4,y=1", "x=4,y=3"]),
    ("PAIR", "1`(4,4)", "(x, x)", "guard [(four, y) = (x, 4)]", ["x=4,y=4"]),
    ("PAIR", PAIRS, "p as (four, x)", "", ["p=(4,1),x=1", "p=(4,3),x=3"]),
    ("PAIRT", PAIRS, "(four, x)@+1", "", ["x=1", "x=3"]),
    ("NEST", "1`((4,4),2)++1`((4,3),7)", "((y, four), x)", "", ["x=2,y=4"]),
    ("REC", "1`{a=red,b=1}++1`{a=green,b=2}", "{a = go, b = x}", "", ["x=2"]),
    ("LIST", "1`[4,1]++1`[5,2]++1`[4,7]", "four :: x :: nil", "", ["x=1", "x=7"]),
    ("LIST", "1`[4]++1`[5,1]", "x :: none", "", ["x=4"]),
    ("LIST", "1`[4,1]++1`[5,2]++1`[4,7]", "l as four :: x :: _", "", ["l=[4,1],x=1", "l=[4,7],x=7"]),
    ("LISTED", "1`([1,2],2)++1`([],3)", "(few, x)", "", ["x=2"]),
    ("LISTED", "1`([1,2],2)++1`([],3)", "(none, x)", "", ["x=3"]),
    ("U", "1`A(4,2)++1`B++1`A(3,3)", "A(four, x)", "", ["x=2"]),
    ("TEXTS", '1`("ab",2)++1`("b",3)', "(ab, x)", "", ["x=2"]),
    ("BOOLS", "1`(true,2)++1`(false,3)", "(yes, x)", "", ["x=2"]),
    ("REALS", "1`(0.5,2)++1`(1.5,3)", "(half, x)", "", ["x=2"]),
)  # fmt: skip


def net_text() -> str:
    pages = []
    for i, (colset, initial, arc, guard, _) in enumerate(CASES):
        lines = (
            f"page P{i}\n  place P : {colset} = {initial}\n  trans T {guard}\n    in P : {arc}\n"
        )
        pages.append(textwrap.indent(lines, "  "))
    return HEAD + "".join(pages)


def test_what_the_engine_binds_is_bound() -> None:
    net = flat(net_text())
    game = Game(net)
    found: list[list[str]] = [[] for _ in CASES]
    for e in game.enabled():
        values = sorted(
            f"{s.name}={game.colours.text(s.colset, v)}" for s, v in e.values if s.colset
        )
        found[int(net.transitions[e.transition].page[1:])].append(",".join(values))
    assert [sorted(f) for f in found] == [sorted(c[-1]) for c in CASES]


@pytest.mark.parametrize("arc", ["(four + 0, x)", "(f 4, x)", "(S.four, x)", "(!cell, x)"])
def test_what_is_computed_is_no_pattern(arc: str) -> None:
    more = "  fun f x = x;\n  structure S = struct val four = 4 end;\n  globref cell = 4;\n"
    body = f"  place P : PAIR = {PAIRS}\n  trans T\n    in P : {arc}\n"
    assert [e.code for e in load(HEAD + more + body)[1].errors] == ["unbound-variable"]


@pytest.mark.cc
def test_compiled_nets_agree(fast_workshop: Workshop, tmp_path: Path) -> None:
    net = flat(net_text())
    ir, d = lowered(net)
    assert ir is not None, [e.message for e in d.errors]
    program = fast_workshop.build(ir, tmp_path / "net")
    assert agrees(net, program, seed=3, steps=60) > 20
