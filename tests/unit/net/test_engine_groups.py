"""Arcs from one place that share variables: warned of where the engine of CPN Tools breaks off (it was asked)."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.netbuilder import write
from pn2code.diagnostics import Diagnostics
from pn2code.net import front

NET = """
net n
  standard
  colset P = product INT * INT timed;
  colset R = record x: INT * y: INT;
  colset L = list INT;
  colset U = union one: INT + none;
  var a, b, c : INT;  var p : P;  var l, m : L;
  page Top
    place A : P = 1`(1,2) ++ 1`(2,1)
    place B : INT
    place C : INT = 1`1
    place D : R
    place E : L
    place F : U
    trans Go
{arcs}
      out B : 1
"""


@pytest.mark.parametrize(
    ("arcs", "is_refused"),
    [
        (("A : (a,b)", "A : (c,b)"), True),
        (("A : (a,b)", "A : (b,c)"), True),
        (("A : (b,a)", "A : (a,1)"), True),
        (("A : (b,a)", "A : (a, a+1)"), True),
        (("C : b", "A : (a,b)", "A : (c,b)"), True),
        (("A : (a,b)", "A : (c,b)", "C : b"), True),
        (("A : (b,c)", "A : (a,b)"), False),
        (("A : (a,b)", "A : (b,a)"), False),
        (("A : (a,b)", "A : (a,c)"), False),
        (("A : (1,b)", "A : (c,b)"), False),
        (("A : (a,b)", "A : p"), False),
        (("A : (a,b)", "C : b"), False),
        (("D : {x=a,y=b}", "D : {x=c,y=b}"), True),
        (("D : {x=a,y=b}", "D : {x=a,y=c}"), False),
        (("E : a::l", "E : b::l"), True),
        (("E : [a,b]", "E : [b,c]"), True),
        (("E : a::l", "E : [a]"), False),
        (("E : [a]", "E : a::l"), False),
        (("A : (a,b)", "A : (b,a)", "C : b"), False),
        (("C : a", "A : (b,b)", "C : b"), False),
        (("A : (a,c)", "F : one b", "A : (a,b)"), False),
        (("A : (c,a)", "F : one b", "A : (a,b)"), True),
    ],
)
def test_what_the_engine_refuses(arcs: tuple[str, ...], is_refused: bool, tmp_path: Path) -> None:
    text = NET.replace("{arcs}", "\n".join(f"      in {arc}" for arc in arcs))
    d = Diagnostics()
    assert front.examine(write(text, tmp_path / "n.cpn"), d).flat is not None
    assert ("arcs-share-variables" in [x.code for x in d.sorted()]) is is_refused


OPERATORS = """
net n
  standard
  colset L = list INT;  colset TL = list INT timed;  colset TI = int timed;
  var n, h, x : INT;  var t, l : L;
  fun f n = n + 1;
  page Top
    place B : INT
    place P : {colset}
    trans Go
      in B : n
{arcs}
"""


@pytest.mark.parametrize(
    "value", ["h::t", "n+1", "n*2", "(n - 1)", "[h]", "f n", "if n > 1 then 1 else n"]
)
@pytest.mark.parametrize("is_timed", [False, True])
def test_what_the_engine_cannot_compile(value: str, is_timed: bool, tmp_path: Path) -> None:
    is_list = value in ("h::t", "[h]")
    colset = ("TL" if is_list else "TI") if is_timed else "L" if is_list else "INT"
    other = "l" if is_list else "x"
    is_open = value not in ("[h]", "f n")
    expected = {
        (value,): False,
        (f"1`({value})",): False,
        (f"2`({value})",): is_timed and is_open,
        (f"1`({value}) ++ 1`{other}",): False,
        (value, other): is_open,
        (f"1`({value})", other): is_open,
    }
    for arcs, is_warned in expected.items():
        lines = "\n".join(f"      in P : {arc}" for arc in arcs)
        text = OPERATORS.replace("{colset}", colset).replace("{arcs}", lines)
        d = Diagnostics()
        assert front.examine(write(text, tmp_path / "n.cpn"), d).flat is not None
        assert ("engine-code" in [x.code for x in d.sorted()]) is is_warned, arcs
