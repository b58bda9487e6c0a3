"""What `cell.toml` names and the partition does not use: all of it must be there in the net.

A name that the net does not have would have no effect, and nobody would notice.
"""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.place_finder import PlaceFinder
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.ml.core.colsets import Kind
from pn2code.net.finding import Finder
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
    _occurrences(net, config, d)


def counted(net: FlatNet, config: CellConfig) -> dict[str, tuple[str, ...]]:
    """Of each label of `[report] occurrences` the paths of the transitions that are counted together."""
    finder = Finder.of_transitions(net)
    return {
        label: tuple(net.transitions[i].name for i in finder.ending(name))
        for label, name in config.report.occurrences
    }


def _occurrences(net: FlatNet, config: CellConfig, d: Diagnostics) -> None:
    """All instances of a transition are counted together, but not those of several transitions."""
    finder = Finder.of_transitions(net)
    for label, name in config.report.occurrences:
        at = config.locator.origin("report", "occurrences", label)
        found = [net.transitions[i] for i in finder.ending(name)]
        if not found:
            short = [x.short for x in net.transitions]
            d.error(
                codes.CELL_VALUE,
                f"`occurrences.{label}` names `{name}`, which is not a transition of the net",
                at,
                hint=did_you_mean(name, [*short, *finder.paths]),
            )
        elif len({t.id for t in found}) > 1:
            paths = {t.id: f"`{t.name}`" for t in reversed(found)}
            d.error(
                codes.CELL_VALUE,
                f"`occurrences.{label}`: `{name}` is the name of {len(paths)} transitions",
                at,
                hint=f"write more of the path: {' or '.join(reversed(paths.values()))}",
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
        elif colset.whole.kind is not Kind.REAL:
            d.error(
                codes.CELL_VALUE,
                f"`storage` names `{name}`, which is not a colour set of reals",
                config.locator.origin("storage", name),
                hint="name the colour set of the components that are reals",
            )
