"""One C function for all instances of a page: which instances of a transition do the same, and with which places.
In explorers of large nets, for all transitions that are alike (`passes.alike`).

The instances of a transition share its code where their programs are the same but for places, and where those places
are kept in the same way: the same C type (both slots, or both timed arrays of one length) and the same colour set.
Each instance then has a constant table of its places, by which the code reaches them.

`with_shared` writes it into the net (`shared`, `place_tables`), and again whenever it has become known how places are
kept.
"""

from __future__ import annotations

from collections.abc import Callable

from pn2code.base.frozen import frozen, replace
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Transition
from pn2code.lowering.passes.alike import alike, has_places_by_table

Agree = Callable[[int, int], bool]
"""Whether two places are kept in the same way."""


def with_shared(net: ir.NetIR) -> ir.NetIR:
    """The net, with what this pass finds; `is_slot` and the capacities are known."""
    if has_places_by_table(net):
        return _with_alike(net)

    def agree(a: int, b: int) -> bool:
        # Explorers have a function for each instance, so that the compiler can put it where it is called.
        return not net.has_successors and _agree(net.places[a], net.places[b])

    groups = _share(net.transitions, agree)
    by_instances: dict[tuple[str, tuple[str, ...]], list[_Group]] = {}
    for g in groups:
        if g.varying:
            by_instances.setdefault((g.model.origin.page, g.paths), []).append(g)
    columns = {key: _columns(members) for key, members in by_instances.items()}
    numbers = {key: number for number, key in enumerate(columns)}
    shared = []
    for g in groups:
        key = (g.model.origin.page, g.paths)
        own = [*columns[key]] if g.varying else []
        shared.append(
            ir.Shared(
                tuple(t.index for t in g.instances),
                numbers[key] if g.varying else None,
                g.varying,
                tuple(own.index(tuple(row[i] for row in g.at)) for i in range(len(g.varying))),
            )
        )
    tables = (
        ir.PlaceTable(
            page,
            paths,
            names=tuple(found.values()),
            rows=tuple(tuple(column[i] for column in found) for i in range(len(paths))),
        )
        for (page, paths), found in columns.items()
    )
    return replace(net, shared=tuple(shared), place_tables=tuple(tables))


def _with_alike(net: ir.NetIR) -> ir.NetIR:
    """The same for transitions of any page: each group has a table for itself."""
    shared: list[ir.Shared] = []
    tables: list[ir.PlaceTable] = []
    for group in alike(net):
        if len(group.transitions) == 1:
            shared.append(ir.Shared(group.transitions))
            continue
        columns = range(len(group.places[0]))
        varying = [i for i in columns if len({row[i] for row in group.places}) > 1]
        number = len(tables) if varying else None
        own = tuple(group.places[0][i] for i in varying)
        shared.append(ir.Shared(group.transitions, number, own, tuple(range(len(own)))))
        if varying:
            model = net.transitions[group.transitions[0]]
            names = dict(model.places)
            tables.append(
                ir.PlaceTable(
                    model.origin.page,
                    tuple(net.transitions[i].name for i in group.transitions),
                    names=tuple(names.get(p, net.places[p].name) for p in own),
                    rows=tuple(tuple(row[i] for i in varying) for row in group.places),
                    is_of_transitions=True,
                )
            )
    return replace(net, shared=tuple(shared), place_tables=tuple(tables))


def _agree(a: ir.Place, b: ir.Place) -> bool:
    """Whether two places are kept in the same way, and hold the same colours; a packed one only as itself."""
    if a.index == b.index:
        return True
    if a.packed or b.packed or (a.table, a.is_slot) != (b.table, b.is_slot):
        return False
    return a.is_slot or (a.timed, a.capacity) == (b.timed, b.capacity)


@frozen
class _Group:
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
    def paths(self) -> tuple[str, ...]:
        """The page instances."""
        return tuple(t.path for t in self.instances)


def _share(transitions: tuple[Transition, ...], agree: Agree) -> tuple[_Group, ...]:
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
    return tuple(_group(group, maps) for group in groups)


def _group(group: list[Transition], maps: dict[int, dict[int, int]]) -> _Group:
    varying = tuple(
        p
        for p in sorted({p for t in group for p in maps[t.index]})
        if any(maps[t.index].get(p, p) != p for t in group)
    )
    at = tuple(tuple(maps[t.index].get(p, p) for p in varying) for t in group)
    return _Group(tuple(group), varying, at)


def _columns(members: list[_Group]) -> dict[tuple[int, ...], str]:
    """The columns of a table (for each instance a place), in order, with the name on the page.

    What several transitions call a place of the page is one column: their places are the same in all instances.
    """
    columns: dict[tuple[int, ...], str] = {}
    for g in members:
        names = dict(g.model.places)
        for i, p in enumerate(g.varying):
            columns.setdefault(tuple(row[i] for row in g.at), names[p])
    return dict(sorted(columns.items()))


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
