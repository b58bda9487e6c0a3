"""The final places of a cell: a token in one says that it has finished, in some of them that it has failed."""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.owners import touching
from pn2code.cell.partition import Owner
from pn2code.cell.place_finder import PlaceFinder
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.net.flat import FlatNet, FlatPlace


def final_places(
    net: FlatNet,
    config: CellConfig,
    owners: tuple[Owner, ...],
    transition_owner: tuple[int, ...],
    find: PlaceFinder,
    d: Diagnostics,
) -> tuple[int, ...]:
    """The places whose tokens say that the supervisor has finished: its own, and it puts tokens there.

    Args:
        net: the net.
        config: the cell; names that are no such places are errors (`d`) at their entries.
        owners: supervisor first.
        transition_owner: for each transition the index of its owner.
        find: gives the place of a name, or reports that there is none.
        d: where errors go.

    Returns:
        Indices of places, in the order of cell.toml, also of those in which something is wrong.
    """
    writers, readers = touching(net, transition_owner)
    out: list[int] = []
    supervisor = config.supervisor
    for name, at in zip(supervisor.final, supervisor.final_origins, strict=True):
        place = find(name, at, "final")
        if place is None:
            continue
        others = sorted((writers[place.index] | readers[place.index]) - {0})
        if place.index in out:
            _twice("final", place, at, d)
        elif others:
            who = " and ".join(owners[i].phrase for i in others)
            shared = 0 in writers[place.index] | readers[place.index] or len(others) > 1
            d.error(
                codes.CELL_FINAL,
                f"final: place `{place.name}` "
                + (f"is shared with {who}" if shared else f"belongs to {who}")
                + ", and a final place belongs to the supervisor alone",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="let a transition of the supervisor put a token into a place of its own when the cell has "
                "finished, and name that place",
            )
        elif place.colset.timed:
            d.error(
                codes.CELL_FINAL,
                f"final: place `{place.name}` has the timed colour set `{place.colset.name}`, so that it is not clear "
                "whether the cell has finished when the token is put or when it becomes available",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="let a transition take the timed token and put one without a time stamp into the final place",
            )
        elif 0 not in writers[place.index] and place.initial is None:
            # The cell is as it is drawn; what is proved about its end will say so as well.
            d.warning(
                codes.CELL_FINAL,
                f"final: no transition of the supervisor puts a token into place `{place.name}`",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="name a place that the supervisor marks when the cell has finished",
            )
        out.append(place.index)
    return tuple(out)


def failed_places(
    config: CellConfig, final: tuple[int, ...], find: PlaceFinder, d: Diagnostics
) -> tuple[int, ...]:
    """Those of the final places that `[report]` calls a failure, in its order.

    Args:
        config: the cell; names of other places are errors (`d`) at their entries.
        final: the final places.
        find: gives the place of a name, or reports that there is none.
        d: where errors go.
    """
    out: list[int] = []
    for name, at in zip(config.report.failed, config.report.failed_origins, strict=True):
        place = find(name, at, "failed")
        if place is None:
            continue
        if place.index not in final:
            d.error(
                codes.CELL_VALUE,
                f"`failed` names place `{place.name}`, which is not a final place",
                at,
                notes=[Note("the place is here", place.origins[0])],
                hint="name it in `final` of [supervisor] as well: the cell ends when it holds a token",
            )
        elif place.index in out:
            _twice("failed", place, at, d)
        else:
            out.append(place.index)
    return tuple(out)


def _twice(key: str, place: FlatPlace, at: Origin, d: Diagnostics) -> None:
    text = f"`{key}` names place `{place.name}` twice"
    d.error(codes.CELL_VALUE, text, at, hint="remove one of the names")


def failed_names(net: FlatNet, config: CellConfig | None) -> frozenset[str]:
    """The names of the places that `[report]` calls a failure, of a net that is not divided; others are left out."""
    if config is None:
        return frozenset()
    find, report = PlaceFinder(net, Diagnostics()), config.report
    found = [
        find(n, at, "failed") for n, at in zip(report.failed, report.failed_origins, strict=True)
    ]
    return frozenset(place.name for place in found if place is not None)
