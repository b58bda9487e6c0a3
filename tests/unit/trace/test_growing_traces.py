"""Traces that grow are put into one order as far as it is known; whole ones as ever."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pn2code import pipeline
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics
from pn2code.trace.merge import Merger, merge


@pytest.fixture(scope="module")
def partition(root: Path) -> Partition:
    d = Diagnostics()
    generated = pipeline.generate(root / "examples/minimal", d, checked=False)
    assert generated is not None
    return generated.partition


def line(t: float, transition: str) -> dict[str, Any]:
    return {"t": t, "transition": f"Cell.{transition}"}


SUPERVISOR = [
    line(0.5, "Supervisor.Order"),
    line(2.5, "Supervisor.Placed"),
    line(2.5, "Supervisor.Order"),
]
ROBOT = [
    line(0.1, "Robot.Accept"),
    line(1.0, "Robot.Place"),
    line(1.0, "Robot.Report"),
    line(1.1, "Robot.Accept"),
]


def test_a_taker_waits_for_the_giver(partition: Partition) -> None:
    merger = Merger(partition, 2)
    merger.add(1, ROBOT[:3])
    assert list(merger.fitting()) == []
    merger.add(0, SUPERVISOR[:1])
    assert list(merger.fitting()) == [SUPERVISOR[0], *ROBOT[:3]]
    merger.add(1, ROBOT[3:])
    assert list(merger.fitting()) == []
    merger.add(0, SUPERVISOR[1:])
    assert list(merger.fitting()) == [SUPERVISOR[1], SUPERVISOR[2], ROBOT[3]]


def test_piece_by_piece_gives_what_all_at_once_gives(partition: Partition) -> None:
    merger, found = Merger(partition, 2), []
    for i in range(4):
        merger.add(0, SUPERVISOR[i : i + 1])
        merger.add(1, ROBOT[i : i + 1])
        found += list(merger.fitting())
    assert found == merge(partition, (SUPERVISOR, ROBOT))


def test_what_never_fits_comes_at_the_end(partition: Partition) -> None:
    merger = Merger(partition, 2)
    merger.add(1, ROBOT[:1])
    assert list(merger.fitting()) == [] and list(merger.rest()) == ROBOT[:1]
