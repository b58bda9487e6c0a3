"""Transitions of a robot that compete for tokens: the order in which its script asks for their messages decides."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.cell.partition import Partition
from pn2code.net.flat import ArcKind, FlatTransition


def meek(partition: Partition) -> Iterator[int]:
    """Transitions of robots that wait for a message which another one, that comes later in order, does not need."""
    for t, rivals in _rivals(partition):
        if any(needed - others for needed, others in rivals):
            yield t


def hasty(partition: Partition) -> Iterator[tuple[int, bool]]:
    """Transitions of robots that another one may overtake while the script looks for a third one's messages.

    The third one, the last in order, has ended the wait. Then the script asks for the first one, of which a message is
    missing; now this comes, and all that the second one needs; and the script asks for that one. With each, whether
    the second one needs a message of it as well, so that all others may have been there for long.
    """
    for t, rivals in _rivals(partition):
        for i, (needed, second) in enumerate(rivals):
            if any(needed - third and second - third for _, third in rivals[i + 1 :]):
                yield t, bool(needed & second)


def _rivals(partition: Partition) -> Iterator[tuple[int, list[tuple[set[int], set[int]]]]]:
    """Transitions of robots, and for each that competes with it and comes later: the messages of both."""
    net = partition.net
    channels = {c.place for c in partition.channels}

    def inputs(t: FlatTransition, which: bool) -> set[int]:
        return {
            a.place
            for a in t.arcs
            if a.kind in (ArcKind.INPUT, ArcKind.BOTH) and (a.place in channels) is which
        }

    for owner in range(1, len(partition.owners)):
        own = [t for t in net.transitions if partition.transition_owner[t.index] == owner]
        own.sort(key=lambda t: (t.priority, t.index))
        for i, t in enumerate(own):
            rivals = [u for u in own[i + 1 :] if inputs(t, False) & inputs(u, False)]
            yield t.index, [(inputs(t, True), inputs(u, True)) for u in rivals]
