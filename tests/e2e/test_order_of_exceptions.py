"""Which exceptions are raised where a transition is not enabled: both engines look at the same, in the same order."""

from __future__ import annotations

from itertools import permutations

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc


def net(guard: str, arcs: tuple[str, ...], places: str = "") -> str:
    """`V` holds 0, `Empty` and `A` nothing, `B` a 4; `U` can occur beside `T`."""
    lines = "\n".join(f"              {a}" for a in arcs)
    return f"""
        net Order
          standard
          colset LATER = int timed;
          var n, m: INT;
          page Top
            place Empty
            place V : INT = 1`0
            place A : INT
            place B : INT = 1`4
            place Late : LATER = 1`1@5
            place Go = 1
            place Done
            trans T {guard}
{lines}
            trans U
              in Go : ()
              out Done : ()
    """


@pytest.mark.parametrize(
    ("guard", "arcs", "expected"),
    [
        ("guard [10 div n > 2]", ("in Empty : ()", "in V : n"), "same"),
        ("guard [10 div n > 2]", ("in V : n", "in Empty : ()"), "same"),
        ("guard [10 div n > 2]", ("in V : n", "in A : 1"), "same"),
        ("guard [10 div n > 2]", ("in V : n", "in A : m"), "exception"),
        ("guard [10 div n > 2]", ("in V : n", "in A : n + 1"), "exception"),
        ("guard [10 div m > 2]", ("in V : n", "in A : n + 1", "in V : m"), "same"),
        ("guard [n > 0]", ("in V : n", "in B : 10 div n"), "same"),
        ("guard [10 div n > 2]", ("in V : n", "in Late : 1"), "exception"),
    ],
)
def test_what_is_wanted_is_looked_at_when_it_is_known(
    explorers: Explorers, guard: str, arcs: tuple[str, ...], expected: str
) -> None:
    assert agrees(explorers, flat(net(guard, arcs))) == expected


@pytest.mark.parametrize("order", [*permutations(("in V : n", "in A : n + 1", "in B : 10 div n"))])
def test_a_place_that_lacks_something_ends_the_question(
    explorers: Explorers, order: tuple[str, ...]
) -> None:
    early = order.index("in A : n + 1") < order.index("in B : 10 div n")
    assert agrees(explorers, flat(net("", order))) == ("same" if early else "exception")
