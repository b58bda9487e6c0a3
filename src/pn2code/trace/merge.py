"""One occurrence sequence out of several: the traces of parties that ran at the same time.

Each party's own order stands. Between parties only channels matter: an occurrence that takes a
message comes after the one that put it,
one that puts a message comes after the last one was taken. Among what may come next the earlier time goes first.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind


def merge(partition: Partition, traces: Sequence[Sequence[dict[str, Any]]]) -> list[dict[str, Any]]:
    """Merges the lines of several traces (docs/trace.md) of one cell; notes go where their time puts them.

    When no order fits (a trace is incomplete, or the run was not one of the net) the rest follows
    in order of time: a replay will
    then say what is wrong.
    """
    merger = Merger(partition, len(traces))
    for party, lines in enumerate(traces):
        merger.add(party, lines)
    return list(merger.rest())


class Merger:
    """Merges traces that still grow.

    Args:
        partition: the cell.
        count: how many traces there are.
    """

    def __init__(self, partition: Partition, count: int) -> None:
        self._takes, self._puts = _channel_arcs(partition)
        self._held = dict.fromkeys((c.place for c in partition.channels), 0)
        self._waiting: list[deque[dict[str, Any]]] = [deque() for _ in range(count)]

    def add(self, party: int, lines: Iterable[dict[str, Any]]) -> None:
        """More lines of a trace."""
        self._waiting[party].extend(lines)

    def fitting(self) -> Iterator[dict[str, Any]]:
        """What can have happened next, as far as it is known; the rest waits for lines that are not there yet."""
        while (party := self._next()) is not None:
            yield self._take(party)

    def rest(self) -> Iterator[dict[str, Any]]:
        """All that waits; where nothing fits, in order of time."""
        while any(self._waiting):
            party = self._next()
            if party is None:
                party = min((float(w[0]["t"]), i) for i, w in enumerate(self._waiting) if w)[1]
            yield self._take(party)

    def _next(self) -> int | None:
        fitting = [
            (float(w[0]["t"]), i) for i, w in enumerate(self._waiting) if w and self._is_ready(w[0])
        ]
        return min(fitting)[1] if fitting else None

    def _is_ready(self, line: dict[str, Any]) -> bool:
        name = line.get("transition")
        takes = self._takes.get(name, ()) if name is not None else ()
        return name is None or (
            all(self._held[p] > 0 for p in takes)
            and all(self._held[p] == 0 or p in takes for p in self._puts.get(name, ()))
        )

    def _take(self, party: int) -> dict[str, Any]:
        line = self._waiting[party].popleft()
        for place in self._takes.get(line.get("transition", ""), ()):
            self._held[place] -= 1
        for place in self._puts.get(line.get("transition", ""), ()):
            self._held[place] += 1
        return line


def _channel_arcs(partition: Partition) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """Per transition name: the channel places it takes from, and puts to."""
    channels = {c.place for c in partition.channels}
    takes: dict[str, list[int]] = {}
    puts: dict[str, list[int]] = {}
    for t in partition.net.transitions:
        for arc in t.arcs:
            if arc.place in channels:
                side = takes if arc.kind is ArcKind.INPUT else puts
                side.setdefault(t.name, []).append(arc.place)
    return takes, puts
