"""Who owns what: the owners of a cell, the owner of each transition, and who touches each place."""

from __future__ import annotations

from pn2code.cell import codes
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Owner, OwnerKind
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.net.flat import ArcKind, FlatNet


def owners_of(net: FlatNet, config: CellConfig, d: Diagnostics) -> tuple[Owner, ...]:
    """The supervisor, then the robots and devices in the order of cell.toml.

    A page instance that is not there, or that belongs to two of them, is an error at its entry.
    """
    paths = _instance_paths(net)
    wanted = [
        ("supervisor", OwnerKind.SUPERVISOR, config.supervisor.instance, config.supervisor.origin)
    ]
    wanted += [(r.name, OwnerKind.ROBOT, r.instance, r.origin) for r in config.robots]
    wanted += [(r.name, OwnerKind.DEVICE, r.instance, r.origin) for r in config.devices]
    owners: list[Owner] = []
    for name, kind, instance, origin in wanted:
        found = [p for p in paths if p == instance or p.endswith("/" + instance)]
        if len(found) == 1:
            clash = next((o for o in owners if overlap(o.instance, found[0])), None)
            if clash:
                here = (name, found[0], origin)
                first = next(o for who, _, _, o in wanted if who == clash.name)
                outer, inner = sorted(
                    [(clash.name, clash.instance, first), here], key=lambda x: len(x[1])
                )
                d.error(
                    codes.CELL_OWNER,
                    f"`{name}` and `{clash.name}` would both own page instance `{inner[1]}`",
                    origin if outer[1] == inner[1] else outer[2],
                    hint="give each owner a substitution transition of its own"
                    if outer[1] == inner[1]
                    else f"`{outer[1]}` of `{outer[0]}` has the pages of both below it: name the substitution "
                    "transition whose page is that program alone",
                )
            owners.append(Owner(len(owners), name, kind, found[0]))
        elif not found:
            last = [p.rsplit("/", 1)[-1] for p in paths]
            d.error(
                codes.CELL_UNKNOWN_PAGE,
                f"the net has no page instance `{instance}` for `{name}`",
                origin,
                hint=did_you_mean(
                    instance,
                    [*paths, *last],
                    f"page instances of the net: {', '.join(f'`{p}`' for p in paths[:12])}",
                ),
            )
        else:
            d.error(
                codes.CELL_UNKNOWN_PAGE,
                f"`{instance}` is the name of {len(found)} page instances",
                origin,
                hint="write the path: " + " or ".join(f"`{p}`" for p in found[:4]),
            )
    return tuple(owners)


def overlap(a: str, b: str) -> bool:
    """Whether one of two paths of page instances (`Cell/Robot1`) is, or is above, the other."""
    return a == b or a.startswith(b + "/") or b.startswith(a + "/")


def _instance_paths(net: FlatNet) -> list[str]:
    """All page instances that hold something, and the paths above them, in order."""
    paths: dict[str, None] = {}
    for instance in [*(t.instance for t in net.transitions), *(p.instance for p in net.places)]:
        parts = instance.split("/")
        for i in range(1, len(parts) + 1):
            paths.setdefault("/".join(parts[:i]))
    return sorted(paths)


def owners_of_transitions(
    net: FlatNet, owners: tuple[Owner, ...], d: Diagnostics
) -> tuple[int, ...]:
    """For each transition the index of its owner; one of a page that nobody owns is an error, and gets 0."""
    out = []
    for t in net.transitions:
        owner = next(
            (
                o.index
                for o in owners
                if t.instance == o.instance or t.instance.startswith(o.instance + "/")
            ),
            None,
        )
        if owner is None:
            d.error(
                codes.CELL_OWNER,
                f"transition `{t.name}` belongs to no owner",
                t.origin,
                notes=[f"it lies on page instance `{t.instance}`"],
                hint="move it to the page of the supervisor or of a robot, or name its page instance in cell.toml",
            )
        out.append(0 if owner is None else owner)
    return tuple(out)


def touching(
    net: FlatNet, transition_owner: tuple[int, ...]
) -> tuple[list[set[int]], list[set[int]]]:
    """Per place: the owners that put tokens and those that take, test, inhibit or reset."""
    writers: list[set[int]] = [set() for _ in net.places]
    readers: list[set[int]] = [set() for _ in net.places]
    for t, owner in zip(net.transitions, transition_owner, strict=True):
        for arc in t.arcs:
            if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
                writers[arc.place].add(owner)
            if arc.kind is not ArcKind.OUTPUT:
                readers[arc.place].add(owner)
    return writers, readers
