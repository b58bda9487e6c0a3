"""Bounds of colour sets and priorities that are computed by functions of the net."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.netbuilder import diagnose, flat

NET = """
net Bounds
  standard
  val workers = ["ann", "bob", "cid"];
  fun count nil = 0 | count (_ :: rest) = 1 + count rest;
  fun twice x = let val y = x + x in y end;
  fun pick (a, b) = if a > b then a else b;
  fun power 0 = 1 | power n = 2 * power (n - 1);
  val (left, right) = (1, 2);
  colset C = with red | blue;
  globref limit = 3;
  val counted = let val r = ref 0 in while !r < 4 do r := !r + 1; !r end;
  fun tick () = (inc limit; !limit);
  fun endless x : int = endless (x + 1);
  colset W = int with 1..%s
  var w : W;
  place P : W = 1`1
  trans T priority %s
    in P : w
"""


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("length workers", 3),
        ("count workers", 3),
        ("twice (length workers)", 6),
        ("pick (2, 7)", 7),
        ("IntInf.toInt (IntInf.fromInt 7)", 7),
        ("Int.fromLarge (Int.toLarge (twice 2))", 4),
        ("power 10", 1024),
        ("List.length (List.filter (fn s => s = \"bob\") workers) + 1", 2),
        ("List.foldl (fn (x, y) => x + y) 0 [1, 2, 3]", 6),
        ("List.nth ([4, 5, 6], 1)", 5),
        ("case workers of [_, x, _] => String.size x | _ => 9", 3),
        ("#b {a = 1, b = 4}", 4),
        ("hd (rev (map twice [1, 5]))", 10),
        ("if true andalso not false then 8 else 1", 8),
        ("floor (Math.sqrt 9.0)", 3),
        ("length (C.all ())", 2),
        ("C.size ()", 2),
        ("C.ord blue + 4", 5),
        ("(hd [] handle Empty => 6)", 6),
        ("valOf (Int.fromString \"7\")", 7),
        ("Vector.sub (Vector.fromList [3, 4], 1)", 4),
        ("left + right", 3),
        ("twice (foldl (op +) 0 [1, 2])", 6),
    ],
)  # fmt: skip
def test_what_can_be_computed(text: str, value: int) -> None:
    net = flat(NET % (text, text))
    assert net.program.colsets["W"].high == value
    assert net.transitions[0].priority == value


@pytest.mark.parametrize("text", ["endless 1", "hd []", "power ~1", "1 div 0"])
def test_what_cannot_is_said(text: str) -> None:
    codes = {e.code for e in diagnose(NET % (text, "5")).errors}
    assert codes == {"colour-set-range"}
    codes = {e.code for e in diagnose(NET % ("5", text)).errors}
    assert codes == {"priority-not-constant"}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("hd []", "computing it raises Empty"),
        ("discrete (3, 4)", "it draws random numbers, or looks at files or clocks"),
        ("tick ()", "computing it changes a reference"),
        ("endless 1", "no end after"),
    ],
)
def test_why_a_bound_cannot_be_computed(text: str, why: str) -> None:
    [message] = [e.message for e in diagnose(NET % (text, "5")).errors]
    assert message.startswith(f"upper bound is not a constant that can be computed here: {why}")


def test_a_bound_may_read_references_as_they_are_there() -> None:
    """As in CPN Tools, which evaluates it once; a priority must never change."""
    assert flat(NET % ("!limit", "5")).program.colsets["W"].high == 3
    assert flat(NET % ("counted", "5")).program.colsets["W"].high == 4
    [message] = [e.message for e in diagnose(NET % ("5", "!limit")).errors]
    assert message == "priority is not a constant that can be computed here: it reads a reference"


@pytest.mark.parametrize(
    ("colset", "codes"),
    [
        ('string with #"a"..#"c"', "type-mismatch type-mismatch"),
        ("subset INT with []", "colour-set-definition"),
        ("subset INT with xs", "subset-list-computed"),
        ("subset INT with [0] ^^ xs", "subset-list-computed"),
        ("subset INT with [0, hd xs]", ""),
    ],
)
def test_what_cpn_tools_refuses_in_colour_sets(colset: str, codes: str) -> None:
    d = diagnose(f"net N\n  standard\n  val xs = [1];\n  colset S = {colset};\n  place P : INT")
    assert [x.code for x in d.items] == codes.split()


def test_all_callers_of_the_front_end_lend_it_the_evaluator(root: Path) -> None:
    calls = re.compile(r"\bfront\.(?:load|examine)\(")
    texts = {p: p.read_text(encoding="utf-8") for p in (root / "src" / "pn2code").rglob("*.py")}
    found = [
        (p, text[m.start() :].split("\n\n")[0])
        for p, text in texts.items()
        for m in calls.finditer(text)
    ]
    assert len(found) >= 9
    assert [str(p) for p, call in found if "compute=compute" not in call] == []


def test_bounds_of_unlimited_integers() -> None:
    """As CPN Tools wants them written."""
    net = flat(
        """
        net N
          standard
          colset C = intinf with IntInf.fromInt ~1..IntInf.fromInt 5
          place P : C = C.all ()
        """
    )
    assert (net.program.colsets["C"].low, net.program.colsets["C"].high) == (-1, 5)


def test_a_value_is_replaced_that_is_declared_after_a_computed_bound() -> None:
    """The evaluator computes the bound from the declarations before it; what is declared later is not missed there."""
    text = (
        "net N\n  colset C = int with 0..(hd [] handle _ => 3);\n  val n = 3;\n  place P : C = 1`n"
    )
    net = flat(text, {"n": "2"})
    assert net.program.colsets["C"].high == 3
    assert net.places[0].initial is not None
    [error] = diagnose(text, {"m": "2"}).errors
    assert error.message == "the net declares no value `m` that could be replaced"
