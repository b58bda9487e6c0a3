"""Nets whose state space is one of many are told so."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.chance import warn

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
        (" code input (n); action count := n", "!count", ""),
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
