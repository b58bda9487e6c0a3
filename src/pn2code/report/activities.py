"""The activities of a run, each once: when it was under way, and how long who worked for it.

An activity is one of the pages below the supervisor's own. It is under way while a robot or device carries out what it
ordered; and from a firing on its page to the next one on another page, but not while work is done for others alone. So
several may be under way at a time, and each as often as the supervisor comes back to it.

    activities(record, ("robot1", "mill"))[0].seconds
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import frozen
from pn2code.run.record import RunRecord

Span = tuple[float, float]
"""From when to when, s."""


@frozen
class Activity:
    """An activity over the whole run.

    Args:
        name: of the supervisor's page.
        times: how often it was under way.
        intervals: from when to when, in order, none of them meeting another.
        busy: by robot or device, seconds of the commands that it ordered.
    """

    name: str
    times: int
    intervals: tuple[tuple[float, float], ...]
    busy: dict[str, float]

    @property
    def seconds(self) -> float:
        """How long it was under way, altogether."""
        return sum(end - start for start, end in self.intervals)


def activities(record: RunRecord, robots: tuple[str, ...]) -> tuple[Activity, ...]:
    """All of them, in the order in which they began."""
    names = dict.fromkeys(a.name for a in record.activities)
    found = []
    for name in names:
        own = [a for a in record.actions if a.activity == name]
        work = [(a.start, a.end) for a in own]
        spans = [(a.start, a.end) for a in record.activities if a.name == name]
        others = _merged((a.start, a.end) for a in record.actions if a.activity != name)
        intervals = _merged([*_without(spans, others), *work])
        busy = {robot: sum(a.end - a.start for a in own if a.robot == robot) for robot in robots}
        found.append(Activity(name, len(intervals), intervals, busy))
    return tuple(found)


def busy_seconds(record: RunRecord, robot: str) -> float:
    """How long a robot or device carried out commands. It carries out one at a time."""
    return sum(a.end - a.start for a in record.actions if a.robot == robot)


def _without(spans: Iterable[Span], others: Iterable[Span]) -> Iterable[Span]:
    """What is left of spans outside of others, and the instant in which each begins."""
    firings = [(start, start) for start, _ in spans]
    left = [(start, end) for start, end in spans if start < end]
    for start, end in others:
        pieces = [piece for a, b in left for piece in ((a, min(b, start)), (max(a, end), b))]
        left = [(a, b) for a, b in pieces if a < b]
    return [*firings, *left]


def _merged(spans: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Spans that overlap or touch are one."""
    merged: list[tuple[float, float]] = []
    for start, end in sorted(spans):
        if merged and start <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(merged[-1][1], end))
        else:
            merged.append((start, end))
    return tuple(merged)
