"""Code segments in the unfolded net: computed with the values of a binding, where nothing else decides."""

from __future__ import annotations

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.unfold.unfold import unfold

NET = """
    net Code
      standard
      colset N = int with 0..3;
      var n, m : N;
      globref count = 0;
      place P : N = 1`0
      place Q : N
      trans T
        code input (n); output (m); action ({action})
        in P : n
        out Q : m
"""


def test_what_a_code_segment_gives() -> None:
    net = netbuilder.flat(NET.format(action="(n + 1) mod 4"))
    d = Diagnostics()
    found = unfold(net, d, with_code=True)
    assert found is not None and not d.items
    (only,) = found.transitions
    assert [(s.name, v) for s, v in only.binding] == [("n", 0)]
    assert [found.places[i].name for i in only.post] == ["Top.Q[1]"]
    assert unfold(net, d) is None
    assert "has a code segment" in d.errors[0].message


def test_what_depends_on_more() -> None:
    for action in ("count := !count + 1; n", "discrete (0, 3)", "(print (INT.mkstr n); n)"):
        d = Diagnostics()
        assert unfold(netbuilder.flat(NET.format(action=action)), d, with_code=True) is None
        assert "does not depend on the binding alone" in d.errors[0].message, action


def test_a_code_segment_that_raises() -> None:
    d = Diagnostics()
    found = unfold(netbuilder.flat(NET.format(action="n div n")), d, with_code=True)
    assert found is not None and not found.transitions
    assert "Div" in found.faults[0].message
