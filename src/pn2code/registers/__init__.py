"""Values that one program of a cell sets and others look at: see `compose`."""

from __future__ import annotations

from dataclasses import replace

from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import Examined


def as_messages(
    net: FlatNet | None, config: CellConfig | None, d: Diagnostics
) -> tuple[FlatNet | None, CellConfig | None]:
    """The net and the cell with registers made of messages; as they are where there are none, or after an error."""
    if net is None or config is None or not any(c.is_register for c in config.channels):
        return net, config
    from pn2code.registers.compose import with_messages  # most cells have none

    return with_messages(net, config, d)


def examined(
    result: Examined, config: CellConfig | None, d: Diagnostics
) -> tuple[Examined, CellConfig | None]:
    """The same for what the front end made of a net."""
    net, config = as_messages(result.flat, config, d)
    return replace(result, flat=net), config
