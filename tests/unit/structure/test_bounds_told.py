"""How far the search for bounds says that it is: what it counts is what takes time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module

import pytest

from pn2code.structure import flows

bounds = import_module("pn2code.structure.bounds")  # the package has a function of this name


def test_only_programs_that_will_be_solved_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Places that are in no invariant cost nothing, and no more programs are solved than are permitted."""
    told: list[int] = []

    def counted(items: Sequence[int], what: str) -> Iterator[int]:
        told.append(len(items))
        yield from items

    solved: list[int] = []
    own = flows.Program.invariant

    def invariant(program: flows.Program, row: int, costs: list[float]) -> flows.Vector | None:
        solved.append(row)
        return own(program, row, costs)

    monkeypatch.setattr(bounds, "counted", counted)
    monkeypatch.setattr(flows.Program, "invariant", invariant)
    search = bounds._Search.__new__(bounds._Search)
    # Pairs of places between which tokens go to and fro, and places that only grow.
    pairs = [{2 * k: d, 2 * k + 1: -d} for k in range(6) for d in (1, -1)]
    search._matrix = [*pairs, *({100 + k: 1} for k in range(20))]
    search._usable = list(range(len(search._matrix)))
    search._tokens = [1] * len(search._matrix)
    search._left = list(search._usable)
    search._offer = lambda place, proof: None
    for programs in (3, 1_000):
        solved.clear()
        search.in_floats(programs)
        assert told.pop() == len(solved)
    assert sorted(solved) == list(range(12))
