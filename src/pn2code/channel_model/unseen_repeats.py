"""Which transitions of scripts may repeat for ever without anybody else being able to notice."""

from __future__ import annotations

from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind


def repeated_unseen(partition: Partition) -> frozenset[int]:
    """The transitions of scripts that touch no message and that may follow themselves without one that does."""
    messages = {c.place for c in partition.channels}
    takers: dict[int, set[int]] = {}
    puts: dict[int, set[int]] = {}
    for t in partition.net.transitions:
        if partition.transition_owner[t.index] and not any(a.place in messages for a in t.arcs):
            puts[t.index] = {a.place for a in t.arcs if a.kind in (ArcKind.OUTPUT, ArcKind.BOTH)}
            for a in t.arcs:
                if a.kind in (ArcKind.INPUT, ArcKind.BOTH):
                    takers.setdefault(a.place, set()).add(t.index)
    found = set()
    for first in puts:
        seen: set[int] = set()
        todo = [first]
        while todo:
            after = {x for place in puts[todo.pop()] for x in takers.get(place, ())} - seen
            seen |= after
            todo += after
        if first in seen:
            found.add(first)
    return frozenset(found)
