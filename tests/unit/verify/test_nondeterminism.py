"""Nets whose state space is one of many are told so."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.nondeterminism import refuse, warn

NET = """
net Chance
  standard
  globref count = 0;
  var n, m : INT;
  place P : INT = 1`1
  trans T%s
    in P : n
    out P : %s
"""


@pytest.mark.parametrize(
    ("clauses", "text", "words"),
    [
        ("", "discrete (1, 6)", "draws random numbers"),
        (
            " code input (n); output (m); action n + IntInf.toInt (step ())",
            "m",
            "asks for the number of steps",
        ),
        (" code input (n); action count := n", "!count", ""),  # references are a part of the state
        ("", "n + 1", ""),
        ("", "!count", ""),  # never changed
        (" code input (n); output (m); action n + 1", "m", ""),
    ],
)
def test_what_is_said(clauses: str, text: str, words: str) -> None:
    d = Diagnostics()
    warn(flat(NET % (clauses, text)), d)
    said = [i.message for i in d.items if i.code == "state-space-random"]
    assert len(said) == (1 if words else 0)
    assert all(words in message for message in said)


def test_references_that_change_are_a_part_of_the_state() -> None:
    d = Diagnostics()
    warn(flat(NET % (" code input (n); action count := n", "!count")), d)
    assert [i.code for i in d.items] == ["state-space-references"]
    assert "`Top.T`" in d.items[0].message


@pytest.mark.parametrize(
    ("clauses", "arc"),
    [(" guard [(count := n; true)]", "n"), (" guard [(inc count; n > 0)]", "n")],
)
def test_a_guard_that_assigns_is_refused(clauses: str, arc: str) -> None:
    d = Diagnostics()
    assert refuse(flat(NET % (clauses, arc)), d)
    assert [e.code for e in d.errors] == ["state-space-search-effect"]


def test_arrays_may_be_read_in_a_guard() -> None:
    d = Diagnostics()
    net = NET.replace("globref count = 0;", "val cells = Array.array (2, 0);")
    assert not refuse(flat(net % (" guard [Array.sub (cells, 1) = 0]", "n")), d)
