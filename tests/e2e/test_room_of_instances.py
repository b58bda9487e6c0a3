"""Places of several instances of one page: that which is full gets more room, not the first of its name."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.explore import explore
from pn2code.verify.exploring.limits import Limits

pytestmark = pytest.mark.cc

NET = """
    net Two
      standard
      colset C = int with 0..1;
      page Top
        place A : C
        subst First = Mid (A -> A)
        subst Second = Mid (A -> A)
      page Mid
        place A port io : C
        place Left : INT = 3`2
        place Made : C = C.all ()
        trans Make
          in Left : 2
          out Made : 0
"""


def test_each_instance_has_room_of_its_own() -> None:
    """Structure does not bound `Made`; it begins with a counter of one bit for each colour, and comes to four."""
    d = Diagnostics()
    found = explore(flat(NET), {}, Limits(traces=0), d)
    assert found is not None and not d.has_errors
    assert (found.complete, found.nodes, found.arcs, found.dead_count) == (True, 16, 24, 1)
    assert found.bounds is not None
    assert [b.upper for b in found.bounds] == [0, 3, 5, 3, 5]
