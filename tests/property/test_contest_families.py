"""The contest's examinations of place/transition nets of known kinds, by each method alone: none is ever wrong."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.examined import examined, sizes
from helpers.random_tables import Graph
from helpers.table_families import FAMILIES, readers_and_writers
from helpers.thorough import amount
from pn2code.contest.engine import engine
from pn2code.contest.portfolio import answers
from pn2code.contest.space import space
from pn2code.diagnostics import Diagnostics

SECONDS = 600.0
"""Ends what hangs; nothing takes that long, on however busy a machine."""
WHOLE = ("", "diagrams")
"""Methods that know all of a small net."""
PARTS = ("explore", "reach", "ctl", "ltl")
"""Methods that come to their end, and have answers for some of the lines."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


@pytest.mark.parametrize("family", [*FAMILIES][:: amount(2, 1)])
def test_each_method_alone(program: Path, family: str) -> None:
    tables = FAMILIES[family]()
    graph = Graph.of(tables, 2000)
    assert graph is not None
    lines, expected = examined(random.Random(family), graph)
    for only in (*WHOLE, *PARTS):
        found = {
            a.name: a.value for a in answers(program, tables, lines, seconds=SECONDS, only=only)
        }
        assert found.items() <= expected.items(), only
        assert found and (only not in WHOLE or len(found) == len(expected)), only
    for only in ("explore", "diagrams"):
        found_space = space(program, tables, seconds=SECONDS, mebibytes=256, only=only)
        assert sizes(found_space) == graph.sizes


def test_wide_transitions_do_not_spoil_the_order(program: Path) -> None:
    """Each of 60 readers reads or not, or one of 10 writers writes."""
    tables = readers_and_writers(60, 10)
    found = space(program, tables, seconds=60.0, mebibytes=1024, only="diagrams")
    assert found is not None and found.states == 2**60 + 10
    assert found.arcs == 60 * 2**60 + 2 * 10
