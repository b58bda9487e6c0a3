"""Channels whose messages come out one after the other, so that somebody could notice in which order."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.partition import SUPERVISOR, Channel, Partition
from pn2code.net.flat import ArcKind


def staged(partition: Partition) -> Iterator[Channel]:
    """Channels of robots whose messages come out in an order that somebody could notice, in that order.

    What is written after a message that comes out later than it is put has to come out later still, wherever the two
    are put together.
    """
    channels = {c.place: c for c in partition.channels}
    order = [c.place for c in partition.channels]
    found: set[int] = set()
    together: list[list[int]] = []
    for t, owner in zip(partition.net.transitions, partition.transition_owner, strict=True):
        put = {a.place for a in t.arcs if a.kind is ArcKind.OUTPUT and a.place in channels}
        if owner == SUPERVISOR or len(put) < 2:
            continue
        together.append(sorted(put, key=order.index))
        if len({channels[place].reader for place in put}) > 1 or _acts_early(partition, put):
            found |= put
    size = -1
    while size < len(found):
        size = len(found)
        for row in together:
            after = next((i for i, place in enumerate(row) if place in found), len(row))
            found.update(row[after:])
    return (c for c in partition.channels if c.place in found)


def _acts_early(partition: Partition, put: set[int]) -> bool:
    """Whether somebody needs one of these messages, and not all that are written after it."""
    order = [c.place for c in partition.channels if c.place in put]
    for t in partition.net.transitions:
        taken = {a.place for a in t.arcs if a.kind is ArcKind.INPUT and a.place in put}
        if taken and not taken.issuperset(order[min(map(order.index, taken)) :]):
            return True
    return False
