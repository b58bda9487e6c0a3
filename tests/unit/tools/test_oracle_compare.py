"""What is known of the engine of CPN Tools explains how it ends, also in a run that names a transition."""

from __future__ import annotations

from pathlib import Path

import pytest
from tools.oracle.compare import FUSED, TWICE, Seen

from helpers.netbuilder import write

NET = """
net N
  standard
  colset P = product INT * INT timed;
  var n, m: INT;
  page Top
    place A fusion Both : INT = 2`1
    place B fusion Both : INT = 2`1
    place C : P = 1`(1, 2)
    trans Fused
      in A : n
      in B : m
    trans Twice
      in C : (n, n)
    trans Other
      in A : n
"""
SUBTRACT = (
    "Error: The exception Subtract is raised outside the code region while transition {} occured, "
    "and the state might be incorrect!"
)
REMOVED = (
    "Error: An Internal Error occured while transition {} occured! Internal Error: rm ID42 CPN'p31"
)


@pytest.mark.parametrize("words", [SUBTRACT, REMOVED])
def test_a_token_that_is_not_there_is_explained_by_the_net(words: str, tmp_path: Path) -> None:
    seen = Seen(write(NET, tmp_path / "N.cpn"))
    assert seen._unraised(words.format("Fused")) is FUSED
    assert seen._unraised(words.format("Twice")) is TWICE
    assert seen._unraised(words.format("Other")).state == "differs"
