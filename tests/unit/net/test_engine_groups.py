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
  var a, b, c : INT;  var p : P;
  page Top
    place A : P = 1`(1,2) ++ 1`(2,1)
    place B : INT
    place C : INT = 1`1
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
    ],
)
def test_what_the_engine_refuses(arcs: tuple[str, ...], is_refused: bool, tmp_path: Path) -> None:
    text = NET.replace("{arcs}", "\n".join(f"      in {arc}" for arc in arcs))
    d = Diagnostics()
    assert front.examine(write(text, tmp_path / "n.cpn"), d).flat is not None
    assert ("arcs-share-variables" in [x.code for x in d.sorted()]) is is_refused
