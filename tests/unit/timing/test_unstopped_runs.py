"""Runs that nothing stops: those that are shown, where faults and late answers stop others."""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any, cast

import pytest

from pn2code.timing.anyhow import Anyhow
from pn2code.timing.doings import NS
from pn2code.timing.longest import Arc
from pn2code.timing.look import Measured
from pn2code.timing.search import Search
from pn2code.timing.too_long import seen_too_long, too_long
from pn2code.timing.unstopped import Unstopped
from pn2code.timing.waits import longest_wait

ASK, WORK, END = 0, 1, 2


def measured(search: Search, timeout: int = 120 * NS) -> Measured:
    """With the runs that nothing stops."""
    return Measured(search, cast(Any, None), Unstopped(search, timeout))


def found(
    arcs: list[list[Arc]],
    *,
    stopped: Iterable[int] = (),
    owed: Iterable[int] = (),
    stuck: Iterable[int] = (),
    ends: Iterable[int] = (),
) -> Any:
    """A search that has found this graph.

    Args:
        owed: the situations in which an answer is owed.
    """
    owes = 5
    return SimpleNamespace(
        why="",
        doings=SimpleNamespace(why="", stops=False),
        successors=arcs,
        surely=lambda: arcs,
        held_up=lambda *_: 0,
        path_to=lambda node: pytest.fail("not a way that is known to be a run"),
        situations=[(i,) for i in range(len(arcs))],
        stuck=list(stuck),
        ends=set(ends),
        stopped=lambda: set(stopped),
        graph=SimpleNamespace(
            over=set(),
            marked=[{owes: 1} if i in set(owed) else {} for i in range(len(arcs))],
            running=SimpleNamespace(owing={1: owes}),
        ),
    )


EVENTS = (lambda mark: mark == ASK), (lambda mark: mark == END)


def test_a_wait_that_begins_behind_a_fault_is_no_run() -> None:
    """Nor is the way to it that which goes through the fault, where there is another one."""
    behind: list[list[Arc]] = [
        [(1, 5, WORK)],
        [(2, 0, WORK)],
        [(3, 1, ASK)],
        [(4, 9 * NS, END)],
        [],
    ]
    beside = [[(1, 5, WORK), (5, 1, WORK)], *behind[1:], [(2, 7, WORK)]]
    for graph, marks in ((behind, None), (beside, [WORK, WORK])):
        one = measured(found(graph, stopped=[1]))
        wait = longest_wait(graph, *EVENTS, ())
        assert (wait.ns, wait.before) == (9 * NS, 2)
        shown = too_long(one, wait, EVENTS, 2 * NS, ())
        assert (None if shown is None else [m for _, m in shown.before]) == marks
        assert shown is None or shown.ns == 9 * NS


@pytest.mark.parametrize(("timeout", "longest"), [(2, 2), (4, 4), (5, 5), (7, 6)])
def test_a_wait_ends_where_an_answer_is_late(timeout: int, longest: int) -> None:
    """It takes 6 s, and as long is the answer owed: the supervisor waits for it no longer than its timeout."""
    graph: list[list[Arc]] = [[(1, 0, ASK)], [(2, 6 * NS, WORK)], [(3, 0, END)], []]
    one = measured(found(graph, owed=[1, 2], ends=[3]), timeout * NS)
    if timeout > 6:
        cast(Any, one.search).path_to = lambda _: []
    wait = longest_wait(graph, *EVENTS, ())
    for limit in range(1, 8):
        shown = too_long(one, wait, EVENTS, limit * NS, ())
        assert (shown is not None) == (limit < longest), limit
        assert shown is None or shown.ns == (6 * NS if timeout > 6 else None)
        one.search.why = "situations"
        assert (seen_too_long(one, *EVENTS, limit * NS) is not None) == (limit < longest)


def test_an_answer_that_is_late_on_one_way_only() -> None:
    """Before the wait, or on the longest way of it; on another way nothing is late."""
    graph: list[list[Arc]] = [
        [(1, 9 * NS, WORK), (2, NS, WORK)],
        [(2, 0, WORK)],
        [(3, 0, ASK)],
        [(4, 8 * NS, WORK), (5, 6 * NS, WORK)],
        [(6, 0, END)],
        [(6, 0, END)],
        [],
    ]
    one = measured(found(graph, owed=[0, 1, 3, 4], ends=[6]), 7 * NS)
    wait = longest_wait(graph, *EVENTS, ())
    assert wait.ns == 8 * NS and not one.runs.is_all
    shown = too_long(one, wait, EVENTS, 5 * NS, ())
    assert shown is not None and [m for _, m in shown.before] == [WORK]
    # In the situation beside it nothing is owed, so that one can be waited for until the other one is late.
    assert too_long(one, wait, EVENTS, 7 * NS, ()) is None


@pytest.mark.parametrize(("timeout", "is_no"), [(3, False), (4, False), (9, True)])
def test_who_is_waited_for_in_vain_may_be_late_before_the_limit(timeout: int, is_no: bool) -> None:
    """Nothing more happens, and the supervisor waits for an answer, but not for ever."""
    graph: list[list[Arc]] = [[(1, 0, ASK)], [(2, NS, WORK)], []]
    wait = longest_wait(graph, *EVENTS, ())
    assert wait.why == "never"
    for owed in ([2], []):
        one = measured(found(graph, owed=owed, stuck=[2]), timeout * NS)
        cast(Any, one.search).path_to = lambda _: []
        assert (too_long(one, wait, EVENTS, 5 * NS, ()) is not None) == (is_no or not owed)


def test_what_comes_after_the_last_chance_may_be_stopped() -> None:
    """The event is not possible any more; a run goes on to its end, unless it is stopped before."""
    graph: list[list[Arc]] = [[(1, 0, ASK), (3, 0, END)], [(2, NS, WORK)], [(3, NS, WORK)], []]
    wait = longest_wait(graph, *EVENTS, ())
    assert wait.why == "never"
    for stopped, is_no in (([2], False), ([1], False), ([4], True)):
        one = measured(found(graph, stopped=stopped, ends=[3]))
        assert (too_long(one, wait, EVENTS, 9 * NS, (3,)) is not None) == is_no


def test_a_repetition_in_which_an_answer_is_late_is_none() -> None:
    """Of two that take time, one is stopped in its first round."""
    graph: list[list[Arc]] = [
        [(1, 0, 1), (2, 0, 2), (3, 0, END)],
        [(0, 3 * NS, 3)],
        [(0, 5 * NS, 4)],
        [],
    ]
    for timeout, stopped, around in (
        (9, [], {1, 3}),
        (4, [1], set()),
        (4, [], {1, 3}),
        (9, [1], {2, 4}),
        (2, [], set()),
    ):
        runs = measured(found(graph, owed=[1, 2], stopped=stopped, ends=[3]), timeout * NS).runs
        assert set(runs.around()) == around
        if not around:
            longest = runs.longest({3})
            assert longest is not None and longest.ns == 0


@pytest.mark.parametrize(
    ("fault", "halts", "latest", "is_sure"),
    [
        ("", False, 5, True),
        ("", False, 4, False),
        ("out of reach", False, 5, False),
        ("", True, 5, False),
    ],
)
def test_what_may_stop_a_run_in_some_order(
    fault: str, *, halts: bool, latest: int, is_sure: bool
) -> None:
    """A "yes" for shorter commands, too, says that no run is stopped before."""
    anyhow: Any = SimpleNamespace(
        graph=SimpleNamespace(running=SimpleNamespace(owing={1: 5})),
        inside=lambda _: 5 * NS,
        faults={(0, 0): fault} if fault else {},
        halts=halts,
    )
    assert Anyhow.never_stops(anyhow, latest * NS) == is_sure
