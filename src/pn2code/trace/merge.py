"""One occurrence sequence out of several: the traces of parties that ran at the same time.

Each party's own order stands. Between parties only channels matter: an occurrence that takes a
message comes after the one that put it,
one that puts a message comes after the last one was taken. Among what may come next the earlier time goes first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind


def merge(partition: Partition, traces: Sequence[Sequence[dict[str, Any]]]) -> list[dict[str, Any]]:
    """Merges the lines of several traces (docs/trace.md) of one cell; notes go where their time puts them.

    When no order fits (a trace is incomplete, or the run was not one of the net) the rest follows
    in order of time: a replay will
    then say what is wrong.
    """
    takes, puts = _channel_arcs(partition)
    held = dict.fromkeys((c.place for c in partition.channels), 0)
    position = [0] * len(traces)
    out: list[dict[str, Any]] = []

    def ready(line: dict[str, Any]) -> bool:
        name = line.get("transition")
        return name is None or (
            all(held[p] > 0 for p in takes.get(name, ()))
            and all(held[p] == 0 or p in takes.get(name, ()) for p in puts.get(name, ()))
        )

    while True:
        heads = [
            (float(lines[at]["t"]), i)
            for i, (lines, at) in enumerate(zip(traces, position, strict=True))
            if at < len(lines)
        ]
        if not heads:
            return out
        fitting = [h for h in heads if ready(traces[h[1]][position[h[1]]])]
        _, i = min(fitting or heads)
        line = traces[i][position[i]]
        position[i] += 1
        for place in takes.get(line.get("transition", ""), ()):
            held[place] -= 1
        for place in puts.get(line.get("transition", ""), ()):
            held[place] += 1
        out.append(line)


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
