"""The sizes of a state space: counted, and with diagrams, side by side."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

from pn2code.contest.diagrams import METHOD, Diagrams
from pn2code.contest.engine import Space, Task, ask, grace_of
from pn2code.contest.tables import Tables


def _until(ends: float, tasks: Iterable[Task]) -> Iterator[Task]:
    """None of them goes on after the end, however long it took to make them."""
    for task in tasks:
        left = ends - time.monotonic()
        if left > 0:
            yield replace(task, seconds=min(task.seconds, left))


def space(
    program: Path, tables: Tables, *, seconds: float, mebibytes: int, only: str = ""
) -> Space | None:
    """The sizes of the state space, if it can be seen to its end: counted, and with diagrams, side by side."""
    if not tables.fits():
        return None
    ends = time.monotonic() + seconds
    lanes: list[Iterable[Task]] = []
    diagrams = Diagrams(tables)
    if only in ("", "explore"):
        lanes.append(Task("count", tables.text([]), seconds, mebibytes // 3) for _ in range(1))
    if only in ("", METHOD):
        lanes += diagrams.sizes(seconds, mebibytes // 3)
    try:
        for found in ask(
            program, [_until(ends, lane) for lane in lanes], until=ends + grace_of(seconds)
        ):
            if isinstance(found, Space):
                return found
    finally:
        diagrams.ended.set()
    return None
