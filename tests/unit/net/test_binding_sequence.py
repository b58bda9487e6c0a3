"""Summands of one arc that share variables: accepted where the engine of CPN Tools accepts them (it was asked)."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

HEAD = """
    net N
      standard
      colset R = product INT * INT * INT;
      colset E = with e1 | e2;
      colset S = product E * E;
      colset L = list INT;
      colset TR = product INT * INT timed;
      var a, b, c, d, e: INT; var u, v, w: E; var l, m: L;
      place P : R
      place P2 : R
      place Q : INT
      place QE : S
      place T : TR
      place LL : L
      trans X
"""
ACCEPTED = (
    "P : 1`(a,b,1)++1`(a,b,c)", "P : 1`(a,b,c)++1`(c,1,1)", "P : 1`(a,1,1)++1`(a,b,1)++1`(b,2,2)",
    "P : 1`(a,b,1)++1`(b,c,1) | guard [c = a+b]", "P : 1`(a,b,1)++1`(b,c,1) | guard [b = 3]",
    "P : 1`(a,b,1)++1`(b,c,1) | guard [a = 3]", "P : 2`(a,b,1)++3`(a,b,1)", "QE : 1`(u,v)++1`(u,e1)",
    "P : 1`(a,b,c)++1`(a,b,d);Q : d", "P : 1`(a,b,c)++1`(a,b,d);Q : 1`c++1`d", "Q : 1`c++1`d++1`c",
    "LL : 1`(a::l)++1`l", "LL : 1`[a]++1`[a,b]", "P : 1`(a,b,1)++1`(c,d,1)++1`(a,c,1)", "P : 1`(a,a,1)++1`(a,b,1)",
    "P : 1`(a,b,1)++1`(b,c,1);P2 : (b,1,1)", "P : 1`(a,b,1)++1`(b,c,1);P2 : 1`(b,1,1)++1`(b,d,1)",
    "P : 1`(a,b,c)++1`(d,e,1)", "P2 : (a,b,c);P : 1`(a,b,d)++1`(a,c,e)", "Q : a;P : 1`(a,b,c)++1`(a,d,e)",
)  # fmt: skip
REFUSED = (
    "P : 1`(a,b,c)++1`(a,d,1)", "QE : 1`(u,v)++1`(v,w)", "T : 1`(a,b)++1`(a,d)", "LL : 1`(a::l)++1`(b::l)",
    "LL : 1`(a::l)++1`(a::m)", "P : 1`(a,b,1)++1`(c,d,1)++1`(a,e,1)", "P : 1`(a,b,c)++1`(d,b,c)",
    "Q : a;P : 1`(a,b,c)++1`(a,b,d)",
)  # fmt: skip


def said(case: str) -> list[str]:
    arcs, _, guard = case.partition(" | ")
    lines = [f"        {guard}"] * bool(guard) + [f"        in {a}" for a in arcs.split(";")]
    return [e.code for e in diagnose(HEAD + "\n".join(lines)).errors]


@pytest.mark.parametrize("case", ACCEPTED)
def test_accepted(case: str) -> None:
    assert said(case) == []


@pytest.mark.parametrize("case", REFUSED)
def test_refused(case: str) -> None:
    assert said(case) == ["summands-share-variables"]
