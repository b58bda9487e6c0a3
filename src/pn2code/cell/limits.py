"""What a supervisor has room for: channels, robots, values in a message."""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Channel, Input
from pn2code.cell.scalars import MOST_ROOM, least_values, message_scalars
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet

MOST_CHANNELS, MOST_PEERS = 128, 64
"""What cnative/include/pn/pn_cell.h has room for."""


def report_limits(
    net: FlatNet,
    channels: tuple[Channel, ...],
    inputs: tuple[Input, ...],
    config: CellConfig,
    d: Diagnostics,
) -> None:
    """What a supervisor has no room for: an error each, for the cell or at the place of the message."""
    at = config.supervisor.origin
    if len(channels) > MOST_CHANNELS:
        text = (
            f"the cell has {len(channels)} channels, and a supervisor has room for {MOST_CHANNELS}"
        )
        d.error(codes.CHANNEL_LIMIT, text, at, hint="send several values in one message")
    if len(config.programs) > MOST_PEERS:
        many = len(config.programs)
        text = f"the cell has {many} robots and devices, and a supervisor has room for {MOST_PEERS}"
        d.error(
            codes.CHANNEL_LIMIT, text, at, hint="combine several small devices into one program"
        )
    for name, place in (
        *((c.name, c.place) for c in channels),
        *((i.name, i.place) for i in inputs),
    ):
        flat = net.places[place]
        count = least_values(message_scalars(flat.colset) or ())
        if count > MOST_ROOM:
            d.error(
                codes.CHANNEL_LIMIT,
                f"a message of `{name}` has {count:,} values, but at most {MOST_ROOM:,} are possible",
                flat.origins[0],
                hint=f"divide colour set `{flat.colset.name}` among several places",
            )
