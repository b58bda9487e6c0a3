"""How long runs wait that nothing stops, in random graphs, next to all ways through them one by one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from types import SimpleNamespace
from typing import Any

import pytest

from helpers.thorough import amount
from pn2code.timing.doings import NS
from pn2code.timing.longest import Arc
from pn2code.timing.search import TIE
from pn2code.timing.unstopped import Unstopped

WORK, ASK, END = range(3)
FOREVER = 10**6


@dataclass
class Made:
    """A graph whose arcs lead forwards; times are whole seconds.

    Args:
        owed: by place, the nodes in which an answer is owed.
        timeout: s.
    """

    arcs: Sequence[Sequence[Arc]]
    owed: Mapping[int, set[int]]
    stopped: set[int]
    ends: set[int]
    stuck: set[int]
    timeout: int


def made(r: Random) -> Made:
    count = r.randint(4, 8)
    arcs: list[list[Arc]] = [
        [
            (r.randint(i + 1, count - 1), r.choice([0, 0, 1, 2, 3]), r.choice([WORK, WORK, ASK, END]))
            for _ in range(r.randint(0 if i else 1, 3))
        ]
        for i in range(count - 1)
    ]  # fmt: skip
    arcs.append([])
    nodes = range(count)
    stopped = {i for i in nodes[1:] if r.random() < 0.15}
    sinks = {i for i in nodes if not arcs[i]} - stopped
    ends = {i for i in sinks if r.random() < 0.6}
    owed = {place: {i for i in nodes if r.random() < 0.5} for place in (5, 6)}
    return Made(arcs, owed, stopped, ends, sinks - ends, r.randint(1, 6))


def waits(
    m: Made, node: int, since: Mapping[int, int], wait: int | None, now: int = 0
) -> Iterator[int]:
    """How long each run still waits when it ends, is stopped, or has its event."""
    here = {p: since.get(p, now) for p, nodes in m.owed.items() if node in nodes}
    left = min((t + m.timeout - now for t in here.values()), default=FOREVER)
    if wait is not None:
        yield wait
    if node in m.stopped or node in m.ends:
        return
    if node in m.stuck and wait is not None:
        yield wait + left
    for to, seconds, mark in m.arcs[node]:
        if seconds > left or (
            seconds == left and left > 0
        ):  # whoever is as late as that may be too late
            if wait is not None:
                yield wait + left
            continue
        longer = None if wait is None else wait + seconds
        if mark == END and longer is not None:
            yield longer
        after = {ASK: longer or 0, END: None}.get(mark, longer)
        yield from waits(m, to, here, after, now + seconds)


def unstopped(m: Made) -> Unstopped:
    """The runs that nothing stops, as they are looked for."""
    arcs = [[(to, s * NS, mark) for to, s, mark in x] for x in m.arcs]
    search: Any = SimpleNamespace(
        successors=arcs,
        surely=lambda: arcs,
        situations=[(i,) for i in range(len(arcs))],
        stuck=list(m.stuck),
        ends=m.ends,
        stopped=lambda: m.stopped,
        graph=SimpleNamespace(
            over=set(),
            marked=[{p: 1 for p, nodes in m.owed.items() if i in nodes} for i in range(len(arcs))],
            running=SimpleNamespace(owing={1: 5, 2: 6}),
        ),
    )
    return Unstopped(search, m.timeout * NS)


def lost(
    m: Made, node: int, since: Mapping[int, int], now: int, *, is_waiting: bool, is_lost: bool
) -> bool:
    """Whether a run comes to where the event is not possible any more, and goes on without being stopped."""
    here = {p: since.get(p, now) for p, nodes in m.owed.items() if node in nodes}
    left = min((t + m.timeout - now for t in here.values()), default=FOREVER)
    is_lost |= is_waiting and not possible(m, node)
    if node in m.stopped:
        return False
    if node in m.ends or (node in m.stuck and left == FOREVER):
        return is_lost
    return any(
        lost(
            m, to, here, now + seconds,
            is_waiting=mark == ASK or (is_waiting and mark != END), is_lost=is_lost,
        )
        for to, seconds, mark in m.arcs[node]
        if not (seconds > left or (seconds == left and left > 0))
    )  # fmt: skip


def possible(m: Made, node: int) -> bool:
    """Whether the event may still come, also where a run would be stopped before."""
    return any(mark == END or possible(m, to) for to, _, mark in m.arcs[node])


@pytest.mark.parametrize("seed", range(amount(120, 3000)))
def test_a_wait_is_as_long_as_the_longest_of_all_runs(seed: int) -> None:
    m = made(Random(seed))
    runs = unstopped(m)
    longest = max(waits(m, 0, {}, None), default=0)
    for limit in range(10):
        found = runs.too_long(lambda mark: mark == ASK, lambda mark: mark == END, limit * NS + TIE)
        assert (found is not None) == (longest > limit), (limit, longest)


@pytest.mark.parametrize("seed", range(amount(120, 3000)))
def test_an_event_is_waited_for_in_vain_where_some_run_does(seed: int) -> None:
    m = made(Random(seed))
    found = unstopped(m).never(lambda mark: mark == ASK, lambda mark: mark == END, ())
    assert (found is not None) == lost(m, 0, {}, 0, is_waiting=False, is_lost=False)
