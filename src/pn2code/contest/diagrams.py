"""Decision diagrams beside the other methods: a process of its own, which builds all markings and then answers.

    diagrams = Diagrams(tables)
    diagrams.orders[0]                             # the most promising order of its places
    for order, patience in diagrams.tries(0, range(TRIED), 8.0): ...

Whether a diagram stays small depends on the order of its levels, and one may take a thousandth of the time of another:
several are tried for a short time, and each round of a portfolio has another one for most of its time.
The engine says nothing before the set is whole: a diagram that explodes costs its share of time and memory, and
nothing else.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property

from pn2code.base.frozen import frozen
from pn2code.contest.counted import Counted
from pn2code.contest.counting import smaller
from pn2code.contest.engine import Task
from pn2code.contest.tables import Tables
from pn2code.symbolic.coupling import improved
from pn2code.symbolic.order import orders

METHOD = "diagrams"
KINDS = ("reach", "bound", "ctl", "ltl")
"""The kinds of questions that it can answer."""

TRIED = 4
"""So many orders are tried for a short time."""
_TRY = 0.1
"""Of the time, for each of them."""
_AGAIN = 1.5
"""An order that was given up is tried again with so many times the patience."""
_GLANCE = 0.04
"""Of the time, for each order of a lane that counts; then the first few have more, and the first one what is left."""
_LONGER = (0.12, 0.12, 0.12)
_SEARCHES = 3
"""So often the first order of a lane is made better, and tried, in what is left of the time."""
_IMPROVING = 0.3
_IMPROVING_S = 8.0
"""Of that time, and at most so much of a processor, for making it better."""
_MAKING = 0.2
"""Of the time, to make the net smaller before its markings are counted."""


class Diagrams:
    """A net with orders of its places."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.lock = threading.Lock()
        self.is_over = threading.Event()
        """Set when nobody waits for the sizes any more."""
        self.is_tried = False
        self.counted: Counted | None = None
        """The net made smaller to be counted, once that was tried."""
        self.counted_orders: list[list[int]] | None = None
        self.whole: int | None = None
        """An order with which they were whole in time."""
        self.patience: dict[int, float] = {}
        """Order -> for how long it was tried in vain."""

    @cached_property
    def orders(self) -> list[list[int]]:
        """The most promising one first."""
        t = self.tables
        return orders(len(t.initial), t.pre, t.post, as_written(t))

    def tries(
        self, which: int, offered: Iterable[int], seconds: float
    ) -> Iterator[tuple[int, float | None]]:
        """Orders, and how long to wait for diagrams with them that are not whole; None: for all of the time.

        Args:
            which: the order that has what is left of the time.
            offered: those that are tried before it, beginning with this one.
            seconds: for all of them.
        """
        if not self.orders[0]:
            return
        which %= len(self.orders)
        patience = _TRY * seconds
        for order in dict.fromkeys([which, *(o for o in offered if o < len(self.orders))]):
            if self.whole is None and patience >= _AGAIN * self.patience.get(order, 0.0):
                yield order, patience
                self.patience[order] = patience
        yield (which if self.whole is None else self.whole), None

    def note_whole(self, order: int) -> None:
        """Diagrams with an order are whole."""
        self.whole = order

    def sizes(self, seconds: float, mebibytes: int) -> list[Iterator[Task]]:
        """The numbers of markings and arcs: two lanes side by side, each with one order after the other.

        Each order has a glance at first, since most diagrams are whole soon or never; then the most promising ones have
        more, and what is left is for the first one; in the second lane, and in that with units, it is made better
        (coupling.py) again and again, and tried as it is and upside down. Where places were put together as units, the
        first lane has these, the second one all places by themselves. The net is made smaller, and the orders are made,
        when the first lane asks for a task, since this takes long for large nets.
        """
        ends = time.monotonic() + seconds
        return [self._lane(which, ends, mebibytes) for which in range(2)]

    def _lane(self, which: int, ends: float, mebibytes: int) -> Iterator[Task]:
        with self.lock:
            row = self._row(which, ends)
        if not row.orders:
            return
        first = row.orders[0]
        is_improving = which == 1 or row.has_units
        longer = zip(row.orders, _LONGER[: 1 if is_improving else None], strict=False)
        turns = [*((order, _GLANCE) for order in row.orders), *longer]
        turns = turns if len(row.orders) > 1 else []
        seconds = max(0.0, ends - time.monotonic())
        for order, share in turns:
            yield Task("sizes", row.written(order), share * seconds, mebibytes)
        if not is_improving:
            yield Task("sizes", row.written(first), max(0.0, ends - time.monotonic()), mebibytes)
            return
        for k in range(_SEARCHES):
            began = time.monotonic()
            until = began + max(0.0, ends - began) / (_SEARCHES - k)
            first = self._improved(row.net, first, began + _IMPROVING * (until - began), k)
            for i, order in enumerate((first, first[::-1])):
                left = max(0.0, until - time.monotonic()) / (2 - i)
                yield Task("sizes", row.written(order), left, mebibytes)

    def _improved(self, net: Tables, order: list[int], until: float, seed: int) -> list[int]:
        """An order of the places of a net, made better for some time."""
        return improved(
            len(net.initial),
            net.pre,
            net.post,
            order,
            until=until,
            processor=_IMPROVING_S,
            seed=seed,
            is_over=self.is_over.is_set,
        )

    def _row(self, which: int, ends: float) -> _Row:
        """What a lane builds, and its orders, the most promising ones first."""
        if not self.is_tried:
            now = time.monotonic()
            self.counted = smaller(self.tables, now + _MAKING * (ends - now))
            self.is_tried = True
        counted = self.counted
        if counted is None:
            net = self.tables
            return _Row(lambda order: net.text([], order), self.orders[which::2], net)
        if counted.units:
            counted = counted if which == 0 else counted.without_units()
            found = _orders(counted, as_written(self.tables))
            return _Row(counted.text, found, counted.drawn, has_units=which == 0)
        if self.counted_orders is None:
            self.counted_orders = _orders(counted, as_written(self.tables))
        return _Row(counted.text, self.counted_orders[which::2], counted.drawn)


@frozen
class _Row:
    """What a lane that counts builds.

    Args:
        written: an order -> the text for the engine.
        orders: of the places of the net.
        net: the net of its diagrams.
        has_units: whether places were put together.
    """

    written: Callable[[Sequence[int]], str]
    orders: list[list[int]]
    net: Tables
    has_units: bool = False


def as_written(tables: Tables) -> list[int]:
    """The places in the order of the file; those of coloured places colour by colour.

    So what belongs to one process is together, whether the file has a place for each of its states, or its processes
    are colours.
    """
    at = {i: (k / len(own), i) for own in tables.places.values() for k, i in enumerate(own)}
    if len(tables.places) == len(at):
        return list(range(len(tables.initial)))
    return sorted(range(len(tables.initial)), key=lambda i: at.get(i, (1.0, i)))


def _orders(counted: Counted, written: Sequence[int]) -> list[list[int]]:
    """Of the places that its diagrams have.

    Args:
        counted: the net made smaller.
        written: the places of the net before.
    """
    t = counted.drawn
    rank = {p: i for i, p in enumerate(written)}
    first: dict[int, int] = {}  # level -> the first of its places
    for p, (at, _) in counted.level.items():
        first[at] = min(rank[counted.kept[p]], first.get(at, len(rank)))
    levels = sorted(first, key=first.__getitem__)
    return orders(len(t.initial), t.pre, t.post, levels)
