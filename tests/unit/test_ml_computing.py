"""Bounds of colour sets and priorities that are computed by functions of the net."""

from __future__ import annotations

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
