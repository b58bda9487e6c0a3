"""Whether each owner of a cell keeps to its own places, which the net itself shows."""

from __future__ import annotations

from pn2code.cell.partition import OwnerKind, Partition
from pn2code.net.flat import ArcKind
from pn2code.verify.controller.control_types import OWNERSHIP, Check


def ownership(partition: Partition) -> Check:
    """Each arc leads to a place of the transition's owner, or to a channel in its direction."""
    net = partition.net
    channels = {c.place: c for c in partition.channels}
    wrong: list[str] = []
    arcs = 0
    for t, owner in zip(net.transitions, partition.transition_owner, strict=True):
        who = partition.owners[owner]
        for arc in t.arcs:
            arcs += 1
            channel = channels.get(arc.place)
            if channel is None:
                is_fine = partition.place_owner[arc.place] == owner
            else:
                is_fine = (arc.kind is ArcKind.INPUT and channel.reader == owner) or (
                    arc.kind is ArcKind.OUTPUT and channel.writer == owner
                )
            if not is_fine:
                whose = "the supervisor" if who.kind is OwnerKind.SUPERVISOR else f"`{who.name}`"
                wrong.append(f"`{t.name}` of {whose} touches `{net.places[arc.place].name}`")
    if wrong:
        return Check(OWNERSHIP, "no", "; ".join(wrong[:5]), len(wrong), transitions=tuple(wrong))
    says = f"all {arcs:,} arcs keep to places of their owner and channels in their direction"
    return Check(OWNERSHIP, "yes", says, arcs)
