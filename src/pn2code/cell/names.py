"""What `cell.toml` names and the partition does not use: all of it must be there in the net.

A name that the net does not have would have no effect, and nobody would notice.
"""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.divide import PlaceFinder
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.near import did_you_mean
from pn2code.ml.colsets import Colset, Kind
from pn2code.net.flat import FlatNet


def check_names(net: FlatNet, config: CellConfig, d: Diagnostics) -> None:
    """Reports the colour sets, places and transitions that the net does not have."""
    _storage(net, config, d)
    find = PlaceFinder(net, d)
    bounds: dict[int, str] = {}
    for name in config.capacity:
        at = config.locator.origin("capacity", name)
        place = find(name, at, "capacity")
        if place is not None and place.index in bounds:
            d.error(
                codes.CELL_VALUE,
                f"`{name}` and `{bounds[place.index]}` are the same place",
                at,
                hint="remove one of them",
            )
        elif place is not None:
            bounds[place.index] = name
    names = [x.name for x in net.transitions]
    for label, name in config.report.occurrences:
        if not any(f".{x}".endswith(f".{name}") for x in names):
            short = [x.rpartition(".")[2] for x in names]
            d.error(
                codes.CELL_VALUE,
                f"`occurrences.{label}` names `{name}`, which is not a transition of the net",
                config.locator.origin("report", "occurrences", label),
                hint=did_you_mean(name, [*short, *names]),
            )


def _storage(net: FlatNet, config: CellConfig, d: Diagnostics) -> None:
    for name in config.raw.get("storage", {}):
        colset = net.program.colsets.get(name)
        if colset is None:
            d.error(
                codes.CELL_VALUE,
                f"`storage` names `{name}`, which is not a colour set of the net",
                config.locator.origin("storage", name),
                hint=did_you_mean(name, net.program.colsets),
            )
        elif not _is_real(colset):
            d.error(
                codes.CELL_VALUE,
                f"`storage` names `{name}`, which is not a colour set of reals",
                config.locator.origin("storage", name),
                hint="name the colour set of the components that are reals",
            )


def _is_real(colset: Colset) -> bool:
    while colset.kind in (Kind.ALIAS, Kind.SUBSET) and colset.components[0] is not None:
        colset = colset.components[0]
    return colset.kind is Kind.REAL
