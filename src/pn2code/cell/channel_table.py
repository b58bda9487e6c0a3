"""The channels of a cell, as `check` tells them: who says what to whom, in which file, and as what.

rows(partition, config)[0].why      # "one value"
lines(rows(partition, config))      # a table, with its head
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, fields

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.cell.scalars import ScalarKind, message_scalars


@frozen
class ChannelRow:
    """A channel.

    Args:
        place: its name in the net.
        writer, reader: "supervisor", or the names of robots and devices.
        colset: what its messages are.
        kind: "data" or "flag".
        why: where the kind comes from.
        file: its name in the shared directory.
    """

    place: str
    writer: str
    reader: str
    colset: str
    kind: str
    why: str
    file: str


def rows(partition: Partition, config: CellConfig) -> tuple[ChannelRow, ...]:
    """One for each channel; data come before flags, as they are written."""
    given = {c.file for c in config.channels if c.is_kind_given}
    out = []
    for channel in partition.channels:
        place = partition.net.places[channel.place]
        scalars = message_scalars(place.colset) or ()
        default = "one value" if len(scalars) == 1 else f"{len(scalars)} values"
        default = "a list" if any(s.kind is ScalarKind.LIST for s in scalars) else default
        out.append(
            ChannelRow(
                place.name,
                partition.owners[channel.writer].name,
                partition.owners[channel.reader].name,
                place.colset.name,
                channel.kind.value,
                "cell.toml" if channel.file in given else default,
                channel.file,
            )
        )
    return tuple(out)


def lines(channels: Sequence[ChannelRow]) -> list[str]:
    """A table for people; nothing where there are no channels."""
    if not channels:
        return []
    titles = {"writer": "from", "reader": "to", "colset": "colour set", "why": "decided by"}
    head = tuple(titles.get(f.name, f.name) for f in fields(ChannelRow))
    table = [head, *(astuple(c) for c in channels)]
    widths = [max(len(row[i]) for row in table) for i in range(len(head))]
    return [
        "  "
        + "  ".join(f"{text:<{width}}" for text, width in zip(row, widths, strict=True)).rstrip()
        for row in table
    ]
