"""A partition as text: owners, channels, who runs what."""

from __future__ import annotations

from pn2code.cell.partition import Partition


def dump_partition(partition: Partition) -> str:
    """Readable, deterministic; for `pn2code dump --stage partition` and for tests."""
    net = partition.net
    out = [f"partition of {net.name}"]
    for owner in partition.owners:
        transitions = [
            t.name
            for t, o in zip(net.transitions, partition.transition_owner, strict=True)
            if o == owner.index
        ]
        places = [
            p.name
            for p, o in zip(net.places, partition.place_owner, strict=True)
            if o == owner.index
        ]
        out.append(f"\n{owner.kind.value} {owner.name}: {owner.instance or 'the whole net'}")
        out += [f"  transition {name}" for name in transitions]
        out += [f"  place {name}" for name in places]
    for c in partition.channels:
        writer, reader = partition.owners[c.writer].name, partition.owners[c.reader].name
        place = net.places[c.place]
        out.append(
            f"\nchannel {c.name} ({c.kind.value}): {writer} -> {reader}, place {place.name} : "
            f"{place.colset.name}, file {c.file}"
        )
    for i in partition.inputs:
        out.append(f"\ninput {i.name}: file {i.file} -> place {net.places[i.place].name}")
    for index in partition.final_places:
        out.append(f"\nfinal {net.places[index].name}")
    return "\n".join(out) + "\n"
