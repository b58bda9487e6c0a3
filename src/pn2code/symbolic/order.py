"""Orders of places as levels of decision diagrams, from what the transitions connect.

    orders(places, pre, post)   # the most promising one first

A diagram is small where places that depend on each other are close. Which order is good is known when it was tried:
several are made, and those first in which transitions reach over few levels (weighted event span: Siminiceanu, Ciardo
2006). FORCE (Aloul, Markov, Sakallah 2003) moves places to the middle of their transitions again and again. The order
in which somebody, or a tool that knew of processes, wrote the places down is among the first, whatever it costs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from pn2code.base.late import Late

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from scipy import sparse
    from scipy.sparse import csgraph

    Order = NDArray[np.int64]
else:
    np = Late("numpy")
    sparse = Late("scipy.sparse")
    csgraph = Late("scipy.sparse.csgraph")

_PASSES = 200
_PATIENCE = 10
"""FORCE ends after so many passes without a better order."""
_WORK = 20_000_000
"""Nor does it look at more arcs."""
_WIDE = 200
"""A transition with more places says little about which of them belong together."""
_NARROW = 8
"""The same where wide transitions count for little."""

Arcs = Sequence[Mapping[int, int]]


def orders(
    places: int, pre: Arcs, post: Arcs, written: Sequence[int] | None = None
) -> list[list[int]]:
    """Orders of the places, from the top of the diagram downwards; different ones, the most promising one first.

    In some of them wide transitions count for little: one that looks at a place of each process would draw these
    places away from the others of their processes.

    Args:
        places: how many there are.
        pre: what transitions take.
        post: what they put.
        written: the places in the order of the file; None: as they are.
    """
    if places == 0:
        return [[]]
    first = np.arange(places, dtype=np.int64) if written is None else np.array(written, np.int64)
    connected = touched(pre, post)
    even = _sorted(Spans(places, connected), first)
    narrow = _sorted(Spans(places, connected, is_narrow=True), first)
    found = [narrow[0], even[0], first, first[::-1].copy(), *narrow[1:2], *even[1:]]
    return [order.tolist() for order in {order.tobytes(): order for order in found}.values()]


def touched(pre: Arcs, post: Arcs) -> list[list[int]]:
    """The places of each transition that has two or more."""
    found = [sorted({*a, *b}) for a, b in zip(pre, post, strict=True)]
    return [t for t in found if len(t) > 1]


def _sorted(net: Spans, first: Order) -> list[Order]:
    """The different orders that are made, by their cost."""
    found: dict[bytes, Order] = {}
    for order in _made(net, first):
        better = order if net.cost(order) <= net.cost(order[::-1]) else order[::-1].copy()
        found.setdefault(better.tobytes(), better)
    return sorted(found.values(), key=net.cost)


def _made(net: Spans, first: Order) -> Iterator[Order]:
    near = net.neighbours()
    starts = [
        first,
        csgraph.reverse_cuthill_mckee(near, symmetric_mode=True).astype(np.int64),
        _breadth_first(near),
    ]
    for start in starts:
        yield start
        yield net.forced(start)


def _breadth_first(near: sparse.csr_array) -> Order:
    """Places in the order in which they are reached, one connected part after the other."""
    _, part = csgraph.connected_components(near, directed=False)
    _, roots = np.unique(part, return_index=True)
    parts = [
        csgraph.breadth_first_order(near, r, directed=False, return_predecessors=False)
        for r in roots
    ]
    return np.concatenate(parts).astype(np.int64)


class Spans:
    """The places of all transitions, one after the other.

    Args:
        places: how many there are.
        touched: transition -> its places, two or more.
        is_narrow: whether transitions count less, the more places they have.
    """

    def __init__(
        self, places: int, touched: Sequence[Sequence[int]], *, is_narrow: bool = False
    ) -> None:
        self.places = places
        self.sizes = np.array([len(t) for t in touched], dtype=np.int64)
        self.first = np.concatenate(([0], np.cumsum(self.sizes)))[:-1].astype(np.int64)
        self.place = np.array([p for t in touched for p in t], dtype=np.int64)
        self.weight = 1.0 / (self.sizes - 1.0) ** 2 if is_narrow else np.ones(len(self.sizes))
        self.widest = _NARROW if is_narrow else _WIDE
        self.uses = np.bincount(self.place, np.repeat(self.weight, self.sizes), places)

    def neighbours(self) -> sparse.csr_array:
        """Which places have a transition in common."""
        of = np.repeat(np.arange(len(self.sizes)), self.sizes)  # arc -> its transition
        first = self.place[self.first[of]]
        behind = np.arange(len(of)) - self.first[of]  # arc -> its number there
        is_near = np.full(len(of), True)
        if self.widest == _NARROW:
            is_near = self.sizes[of] <= _NARROW
        next_ = np.flatnonzero((behind >= 1) & is_near)
        also = np.flatnonzero((behind >= 2) & (self.sizes[of] <= self.widest))
        a = np.concatenate((self.place[next_ - 1], first[also]))
        b = np.concatenate((self.place[next_], self.place[also]))
        ones = np.ones(2 * len(a), dtype=np.int32)
        shape = (self.places, self.places)
        return sparse.csr_array(
            (ones, (np.concatenate((a, b)), np.concatenate((b, a)))), shape=shape
        )

    def cost(self, order: Order) -> float:
        """The levels that transitions reach over, those further up counted more."""
        if not len(self.sizes):
            return 0.0
        level = self._levels(order)[self.place]
        top = np.maximum.reduceat(level, self.first)
        low = np.minimum.reduceat(level, self.first)
        return float(np.sum(self.weight * (top - low) * (top / self.places)))

    def forced(self, order: Order) -> Order:
        """An order in which transitions reach over fewer levels."""
        best, lowest, idle = order, self.cost(order), 0
        if not len(self.sizes):
            return best
        for _ in range(min(_PASSES, _WORK // len(self.place))):
            level = self._levels(order)
            centre = np.add.reduceat(level[self.place], self.first) / self.sizes
            pull = np.bincount(self.place, np.repeat(centre * self.weight, self.sizes), self.places)
            uses = np.where(self.uses > 0, self.uses, 1.0)
            wanted = np.where(self.uses > 0, pull / uses, level)
            order = np.lexsort((level, wanted))[::-1].astype(np.int64)
            cost = self.cost(order)
            idle = 0 if cost < lowest else idle + 1
            if cost < lowest:
                best, lowest = order, cost
            if idle == _PATIENCE:
                break
        return best

    def _levels(self, order: Order) -> NDArray[np.int64]:
        level = np.empty(self.places, dtype=np.int64)
        level[order] = np.arange(self.places, 0, -1)
        return level
