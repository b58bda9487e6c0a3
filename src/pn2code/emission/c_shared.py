"""One C function for all instances of a page: which instances of a transition do the same, and with which places.

The instances of a transition share its code where their programs are the same but for places, and where those places
are kept in the same way: the same C type (both slots, or both timed arrays of one length) and the same colour set.
Each instance then has a constant table of its places, by which the code reaches them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Transition

Agree = Callable[[int, int], bool]
"""Whether two places are kept in the same way."""


@dataclass(frozen=True, slots=True)
class Shared:
    """A transition of a page, with the instances that share its code.

    Args:
        instances: in order; the code is made from the first.
        varying: the places of the first in whose stead the others have other places.
        at: for each instance the places that it has in the stead of those.
    """

    instances: tuple[Transition, ...]
    varying: tuple[int, ...]
    at: tuple[tuple[int, ...], ...]

    @property
    def model(self) -> Transition:
        """The instance from which the code is made."""
        return self.instances[0]

    @property
    def page(self) -> str:
        """The name of the page."""
        return self.model.origin.page

    @property
    def paths(self) -> tuple[str, ...]:
        """The page instances: "Cell.Supervisor.Approach.Move both"."""
        return tuple(path_of(t) for t in self.instances)


@dataclass(frozen=True, slots=True)
class PlaceTable:
    """The places of a page that its instances have for their own.

    Args:
        page: its name.
        paths: the page instances.
        places: of the first instance.
        names: of the places on the page.
        rows: for each page instance its places.
    """

    page: str
    paths: tuple[str, ...]
    places: tuple[int, ...]
    names: tuple[str, ...]
    rows: tuple[tuple[int, ...], ...]


def path_of(t: Transition) -> str:
    """The page instance of a transition."""
    return t.name.rsplit(".", 1)[0]


def share(transitions: tuple[Transition, ...], agree: Agree) -> tuple[Shared, ...]:
    """The transitions, those together that share their code, in order of the first of each."""
    open_groups: dict[tuple[str, ...], list[list[Transition]]] = {}
    maps: dict[int, dict[int, int]] = {}
    groups: list[list[Transition]] = []
    for t in transitions:
        candidates = open_groups.setdefault((t.origin.file, t.origin.page, t.id), [])
        for group in candidates:
            found = _places_of(group[0], t, agree)
            if found is not None:
                maps[t.index] = found
                group.append(t)
                break
        else:
            maps[t.index] = {}
            candidates.append([t])
            groups.append(candidates[-1])
    return tuple(_shared(group, maps) for group in groups)


def tables(groups: tuple[Shared, ...]) -> tuple[PlaceTable, ...]:
    """One table for each page and set of its instances, in order; none where there is nothing to tell."""
    by_instances: dict[tuple[str, tuple[str, ...]], list[Shared]] = {}
    for g in groups:
        if g.varying:
            by_instances.setdefault((g.page, g.paths), []).append(g)
    return tuple(_table(members) for members in by_instances.values())


def _shared(group: list[Transition], maps: dict[int, dict[int, int]]) -> Shared:
    varying = tuple(
        p
        for p in sorted({p for t in group for p in maps[t.index]})
        if any(maps[t.index].get(p, p) != p for t in group)
    )
    at = tuple(tuple(maps[t.index].get(p, p) for p in varying) for t in group)
    return Shared(tuple(group), varying, at)


def _table(members: list[Shared]) -> PlaceTable:
    """What several transitions call a place of the page is one column: their places are the same in all instances."""
    columns: dict[tuple[int, ...], str] = {}
    for g in members:
        names = dict(g.model.places)
        for i, p in enumerate(g.varying):
            columns.setdefault(tuple(row[i] for row in g.at), names[p])
    ordered = sorted(columns)
    first = members[0]
    return PlaceTable(
        page=first.page,
        paths=first.paths,
        places=tuple(column[0] for column in ordered),
        names=tuple(columns[column] for column in ordered),
        rows=tuple(tuple(column[i] for column in ordered) for i in range(len(first.paths))),
    )


def _places_of(model: Transition, other: Transition, agree: Agree) -> dict[int, int] | None:
    """For each place of one instance that of another; None: they cannot share code."""
    found = _Comparison().of(
        (model.variables, model.guard_text, model.enumerate, model.fire, model.thresholds),
        (other.variables, other.guard_text, other.enumerate, other.fire, other.thresholds),
    )
    if found is None or len(set(found.values())) < len(found):
        return None
    return found if all(agree(a, b) for a, b in found.items()) else None


class _Comparison:
    """Of two programs, side by side."""

    def __init__(self) -> None:
        self._places: dict[int, int] = {}
        self._locals: dict[int, int] = {}

    def of(self, one: object, other: object) -> dict[int, int] | None:
        """The places of the other by those of the one; None: there is a difference besides."""
        waiting: list[tuple[object, object]] = [(one, other)]
        while waiting:
            a, b = waiting.pop()
            if type(a) is not type(b):
                return None
            if isinstance(a, tuple) and isinstance(b, tuple):
                if len(a) != len(b):
                    return None
                waiting += zip(a, b, strict=True)
            elif isinstance(a, ir.Local) and isinstance(b, ir.Local):
                if a.type != b.type or self._locals.setdefault(a.uid, b.uid) != b.uid:
                    return None
            elif fields := getattr(a, "__dataclass_fields__", None):
                if not self._is_same_place(a, b):
                    return None
                waiting += ((getattr(a, f), getattr(b, f)) for f in fields if f != "place")
            elif a != b:
                return None
        return self._places if len(set(self._locals.values())) == len(self._locals) else None

    def _is_same_place(self, a: object, b: object) -> bool:
        """Whether what stands for one's place is always the same in the other."""
        mine: int | None = getattr(a, "place", None)
        its: int | None = getattr(b, "place", None)
        if mine is None or its is None:
            return mine is its
        return self._places.setdefault(mine, its) == its
