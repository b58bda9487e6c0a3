"""One C function for transitions that do the same with other places: in explorers of large nets.

Two transitions are alike if their programs are the same but for packed places, local names and notes, and if the places
of one have the same colours as those of the other, in counters of the same width. What a C compiler needs for a large
net then depends on how many kinds of transitions it has, and hardly on how many there are.

Transitions with sums are never alike: a sum lies as the counters of its place do.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from operator import attrgetter
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.ir import nodes as ir
from pn2code.ir.effects import Effects
from pn2code.lowering.passes.counting import is_large

_OF_INSTANCES = frozenset(
    {"index", "name", "id", "origin", "owner", "priority", "guard_text", "places"}
)
"""Members of a transition that the tables of hosts have for each: they say nothing of its code."""

_OF_HOSTS = frozenset({"affected", "touched", "read"})
"""The same of its effects."""


@frozen
class Alike:
    """Transitions that share their code.

    Args:
        transitions: indices, in order.
        places: for each the places that its programs name, in one order.
    """

    transitions: tuple[int, ...]
    places: tuple[tuple[int, ...], ...]


def has_places_by_table(net: ir.NetIR) -> bool:
    """Whether C reaches packed places by their tables, as shared code has to: it is less to compile."""
    return is_large(net)


def alike(net: ir.NetIR) -> tuple[Alike, ...]:
    """All transitions, those together that are alike, in order of the first of each."""
    found: dict[object, list[tuple[int, tuple[int, ...]]]] = {}
    for t in net.transitions:
        shape = _Shape(net.places)
        signature = shape.of(t)
        key = t.index if signature is None else signature
        found.setdefault(key, []).append((t.index, tuple(shape.places)))
    return tuple(
        Alike(tuple(i for i, _ in members), tuple(places for _, places in members))
        for members in found.values()
    )


class _Shape:
    """What is left of a transition without the names of its places."""

    def __init__(self, places: Sequence[ir.Place]) -> None:
        self._all = places
        self.places: dict[int, int] = {}
        self._locals: dict[int, int] = {}

    def of(self, t: ir.Transition) -> tuple[object, ...] | None:
        """Equal for transitions that are alike; None: it is like no other."""
        named = (*t.effects.touched, *t.effects.read)
        if t.sums or t.thresholds or t.counts is not None or t.lists_access is not None:
            return None
        if not all(self._all[p].packed for p in named):
            return None
        members = ((f, getattr(t, f)) for f in _fields(t) if f not in _OF_INSTANCES)
        parts = tuple(self._walk(m for f, m in members if not f.endswith("_access")))
        return None if any(self._all[p].packed is None for p in self.places) else parts

    def _walk(self, items: Iterable[object]) -> Iterator[object]:
        waiting: list[Any] = [*items]
        while waiting:
            item = waiting.pop()
            if isinstance(item, tuple):
                yield len(item)
                waiting += item
            elif isinstance(item, ir.Local):
                yield self._locals.setdefault(item.uid, len(self._locals)), item.type
            elif kept := _kept(item.__class__):
                yield type(item)
                waiting += kept(item)
                place = getattr(item, "place", None)
                if place is not None:
                    yield self._place(place)
            else:  # -0.0 is equal to 0.0, and not the same
                yield type(item), repr(item) if isinstance(item, float) else item

    def _place(self, place: int) -> object:
        """The number of a place in this transition, and what of it stands in the code."""
        p = self._all[place]
        return (
            self.places.setdefault(place, len(self.places)),
            p.table,
            p.type,
            p.packed and p.packed.width,
        )


def _fields(item: object) -> tuple[str, ...]:
    return tuple(getattr(item, "__dataclass_fields__", ()))


@cache
def _kept(kind: type) -> Callable[[Any], tuple[object, ...]] | None:
    """What gives the fields of a node that are not left out, in order; None for what is no node."""
    fields: tuple[str, ...] = tuple(getattr(kind, "__dataclass_fields__", ()))
    if not fields:
        return None
    out = {"place", "note", *(_OF_HOSTS if kind is Effects else ())}
    names = [f for f in fields if f not in out and kind is not ir.Note]
    match names:
        case []:
            return lambda _item: ()
        case [name]:
            return lambda item: (getattr(item, name),)
    return attrgetter(*names)
