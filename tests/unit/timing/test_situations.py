"""Which situations come after each other: what happens at one instant, and what nothing comes after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, cast

import pytest

from pn2code.cell.partition import OwnerKind
from pn2code.timing.doings import NS, Doing, Doings
from pn2code.timing.search import Search

ANSWERS, WORKS, RESTS, SEES_BOTH = range(4)
CHANNEL, UNSURE = 7, 8


def explored(
    arcs: Sequence[Sequence[tuple[int, int]]], ns: int, marked: Mapping[int, int] | None = None
) -> Search:
    """One device answers at once, another one after its command.

    Args:
        arcs: of each state.
        ns: how long the command takes.
        marked: of the last state.
    """
    kinds = [OwnerKind.SUPERVISOR, OwnerKind.DEVICE, OwnerKind.DEVICE]
    graph = SimpleNamespace(
        why="",
        partition=SimpleNamespace(
            net=SimpleNamespace(timed=False, places=[]),
            owners=[SimpleNamespace(index=i, kind=kind) for i, kind in enumerate(kinds)],
            final_places=(),
            channels=(SimpleNamespace(place=CHANNEL, name="answer"),),
        ),
        running=SimpleNamespace(firing=9, ending=-1, stopped=10, owing={}, unsure=UNSURE),
        elements=[SimpleNamespace(is_step=False, owner=owner) for owner in (1, 2, 0, 0)],
        arcs=arcs,
        marked=[*({} for _ in arcs[1:]), marked or {}],
        over=set(),
    )
    work = Doing(ns, None, ())
    doings: Any = SimpleNamespace(
        graph=graph,
        why="",
        stops=False,
        homes=(),
        arm_of={},
        of=lambda element, _: work if element == WORKS else None,
        waits=lambda _: 0,
    )
    search = Search(cast(Doings, doings))
    search.explore()
    assert not search.why
    return search


def occurring(search: Search) -> set[int]:
    """The elements that occur."""
    return {mark for arcs in search.successors for *_, mark in arcs if mark >= 0}


@pytest.mark.parametrize(("ns", "is_possible"), [(0, True), (NS, False)])
def test_a_command_that_takes_no_time_may_be_done_before_the_others_go_on(
    ns: int, *, is_possible: bool
) -> None:
    """The supervisor may see both answers when it looks."""
    arcs = [
        [(ANSWERS, 1), (WORKS, 2)],
        [(RESTS, 3), (WORKS, 4)],
        [(ANSWERS, 4)],
        [(WORKS, 5)],
        [(SEES_BOTH, 5)],
        [],
    ]
    occurs = occurring(explored(arcs, ns))
    assert occurs >= {ANSWERS, WORKS, RESTS}
    assert (SEES_BOTH in occurs) == is_possible


@pytest.mark.parametrize(("messages", "goes_on"), [(1, True), (2, False)])
def test_who_writes_a_second_message_stops_the_cell(messages: int, *, goes_on: bool) -> None:
    search = explored([[(WORKS, 2)], [], [(RESTS, 1)]], NS, {CHANNEL: messages})
    assert occurring(search) == ({WORKS, RESTS} if goes_on else {WORKS})
    assert search.overfull() == ([] if goes_on else ["answer"])
    assert bool(search.stopped()) == (not goes_on)
    assert bool(search.stuck) == goes_on


def test_a_run_in_which_a_condition_may_have_raised_an_exception_is_none() -> None:
    """What comes after it is looked at, as nobody knows whether the script comes to it."""
    search = explored([[(WORKS, 2)], [], [(RESTS, 1)]], NS, {UNSURE: 1})
    assert occurring(search) == {WORKS, RESTS} and search.may_raise()
    assert [search.situations[i][0] for i in search.stopped()] == [2]
