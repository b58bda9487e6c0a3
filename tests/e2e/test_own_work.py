"""What programs do themselves bounds a wait, also where a timed net has belts: nothing was said of those."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from random import Random

import pytest
from tools.adversary import bed, times
from tools.adversary.cells import random_cell

from e2e.test_belts_within_seconds import soon
from helpers import belt_cell, timed_runs_cell
from helpers.thorough import amount
from pn2code.base.deadline import TimeIsOverError
from pn2code.timing.look import Measured
from pn2code.timing.own_work import by_own_work
from pn2code.timing.search import TIE, Search
from pn2code.timing.waits import Is, longest_wait

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

MOST = 2_000
"""Situations of a random cell that is looked at: all of them are gone through for each pair."""


def compared(one: Measured, pairs: int = 60) -> int:
    """Pairs of transitions: the longest wait of all runs is within the bound. How many have one."""
    graph = one.search.graph
    firing = {e.transition for e in graph.elements if not e.is_step and e.owner >= 0}

    def event(transition: int) -> Is:
        marks = {
            i for i, e in enumerate(graph.elements) if not e.is_step and e.transition == transition
        }
        return lambda mark: mark in marks

    found = 0
    all_pairs = list(product(sorted(firing), repeat=2))
    for a, b in Random(0).sample(all_pairs, min(pairs, len(all_pairs))):
        bound = by_own_work(one.anyhow, event(a), event(b))
        if bound is None or bound.ns is None:
            continue
        exact = longest_wait(one.search.successors, event(a), event(b), one.search.ends)
        assert exact.ns is not None, (a, b, exact.why)
        held_up = one.search.held_up(exact.way[0][0], exact.way[1:]) if exact.way else 0
        assert bound.ns >= exact.ns - held_up - TIE, (a, b, bound.ns, exact.ns)
        found += bool(bound.ns)
    return found


def test_it_is_no_less_than_the_longest_wait(tmp_path: Path) -> None:
    """Of a cell with a choice of times; when thorough, of random cells as well."""
    measured: list[Measured] = []
    folder = timed_runs_cell.write(tmp_path / "cell")
    assert times.cycle_of(folder, measured) is not None
    (one,) = measured
    assert not one.search.why and compared(one) > 5
    for seed in range(100, 100 + amount(0, 40)):
        folder = tmp_path / str(seed)
        folder.mkdir()
        bed.write(random_cell(Random(seed)), folder)
        measured.clear()
        times.cycle_of(folder, measured)
        for x in measured:
            if not x.search.why and len(x.search.situations) < MOST:
                compared(x, 12)


_FIRST = "    place Next : PART = 1`1\n"
_WANT = "    trans Want guard"
_RING = "    trans Ring\n      in Timer : ()\n      out Rung : ()\n"
assert belt_cell.NET.count(_FIRST) == belt_cell.NET.count(_WANT) == 1
TIMED = (
    belt_cell.NET.replace("  var n : PART;", "  colset TIMER = unit timed;\n  var n : PART;")
    .replace(_FIRST, f"{_FIRST}    place Timer : TIMER = 1`()@5\n    place Rung\n")
    .replace(_WANT, f"{_RING}{_WANT}")
)


@pytest.mark.bullet
def test_a_timed_net_with_belts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The arm and the feeder are at work all the time; how far the belt runs is bounded by its way."""
    untimed = soon(tmp_path / "untimed", 60)
    monkeypatch.setattr(belt_cell, "NET", TIMED)
    belt = belt_cell.belt_cell
    monkeypatch.setattr(belt_cell, "belt_cell", lambda f, toml: belt(f, net=TIMED, toml=toml))
    said = soon(tmp_path / "timed", 60)
    assert said["answer"] == "yes", said
    assert said["value"] == pytest.approx(untimed["value"], abs=0.01)
    assert any("nobody owes an answer for longer" in x for x in said["assumes"])
    short = soon(tmp_path / "short", 5)
    assert short["answer"] == "inconclusive"
    assert f"no wait is longer than {said['value'] - 0.001:.2f}" in short["why"]


@pytest.mark.bullet
def test_what_is_known_when_the_time_is_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All was *not known*, also what holds in whatever order commands end."""

    def over(_search: Search, _more: object) -> None:
        raise TimeIsOverError

    monkeypatch.setattr(Search, "explore", over)
    said = soon(tmp_path / "cell", 60)
    assert said["answer"] == "yes", said
    folder = timed_runs_cell.write(tmp_path / "times")
    cycle = times.cycle_of(folder)
    assert cycle is not None and cycle.at_most is not None
    assert cycle.why == "the time was over before all situations were looked at"
