"""What the programs of a cell may do that the model of the cell as it runs does not have."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.cell.partition import SUPERVISOR, Channel, ChannelKind, Partition
from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.net.predicate import Predicate
from pn2code.verify.exploring import time_reduction

MOST_OWNERS = 250


class NotModelledError(Exception):
    """The programs of a cell do something that this model does not have; the text is a clause that says what."""


def check_modelled(partition: Partition, predicates: Sequence[Predicate]) -> None:
    """Raises `NotModelledError` for the first thing of a cell that the model does not have."""
    net = partition.net
    if len(partition.owners) > MOST_OWNERS:
        raise NotModelledError(f"the cell has more than {MOST_OWNERS} programs")
    if net.timed:
        why = time_reduction.why_not_reducible(net, predicates)
        if why is not None:
            raise NotModelledError(
                f"steps may come later than in the net, and {why.message}, so that there would be infinitely many "
                "states"
            )
    for place in partition.final_places:
        if net.places[place].colset.timed:
            raise NotModelledError(f"the final place `{net.places[place].name}` is timed")
    channels = {c.place: c for c in partition.channels}
    for t, owner in zip(net.transitions, partition.transition_owner, strict=True):
        _check_transition(t, owner, channels, partition)


def _check_transition(
    t: FlatTransition, owner: int, channels: dict[int, Channel], partition: Partition
) -> None:
    taken: set[int] = set()
    put: list[Channel] = []
    for arc in t.arcs:
        channel = channels.get(arc.place)
        if channel is None:
            if partition.place_owner[arc.place] not in (owner, None):
                raise NotModelledError(f"`{t.name}` touches a place of another owner")
            continue
        name = channel.name
        if arc.kind is ArcKind.OUTPUT and channel.writer == owner:
            put.append(channel)
        elif arc.kind is ArcKind.INPUT and channel.reader == owner:
            if arc.place in taken or not arc.takes_one:
                raise NotModelledError(
                    f"the net does not show that `{t.name}` takes only one message of `{name}`"
                )
            taken.add(arc.place)
        else:
            raise NotModelledError(f"`{t.name}` does more with channel `{name}` than its direction")
    if owner == SUPERVISOR:
        return
    for kind in ChannelKind:
        readers = [c.reader for c in put if c.kind is kind]
        if len(set(readers)) < len(readers):
            raise NotModelledError(f"`{t.name}` writes two messages of one kind to the same reader")
