"""Decision diagrams beside the other methods: a process of its own, which builds all markings and then answers.

    diagrams = Diagrams(tables)
    diagrams.orders[0]                             # the most promising order of its places

Whether a diagram stays small depends on the order of its levels, so that each round of a portfolio takes another one.
The engine says nothing before the set is whole: a diagram that explodes costs its share of time and memory, and
nothing else.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from functools import cached_property

from pn2code.contest.counting import Counted, smaller
from pn2code.contest.engine import Task
from pn2code.contest.tables import Tables
from pn2code.symbolic.order import orders

METHOD = "diagrams"
KINDS = ("reach", "bound", "ctl", "ltl")
"""The kinds of questions that it can answer."""

_SHARES = (0.1, 0.15, 0.15, 0.6)
"""Of the time, for one order after the other where there are several."""
_MAKING = 0.2
"""Of the time, to make the net smaller before its markings are counted."""


class Diagrams:
    """A net with orders of its places."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.lock = threading.Lock()
        self.is_tried = False
        self.counted: Counted | None = None
        """The net made smaller to be counted, once that was tried."""
        self.texts: list[str] | None = None

    @cached_property
    def orders(self) -> list[list[int]]:
        """The most promising one first."""
        return orders(len(self.tables.initial), self.tables.pre, self.tables.post)

    def sizes(self, seconds: float, mebibytes: int) -> list[Iterator[Task]]:
        """The numbers of markings and arcs: two lanes side by side, each with one order after the other.

        Each order has a short time at first; the most promising two have what is left. Where places were put together
        as units, the first lane has these, the second one all places by themselves. The net is made smaller, and the
        orders are made, when the first lane asks for a task, since this takes long for large nets.
        """
        ends = time.monotonic() + seconds
        return [self._lane(which, ends, mebibytes) for which in range(2)]

    def _lane(self, which: int, ends: float, mebibytes: int) -> Iterator[Task]:
        with self.lock:
            row = self._row(which, ends)[:3]
        shares: tuple[float, ...]
        shares = (1.0,)
        if len(row) > 1:
            row, shares = [*row, row[0]], _SHARES
        seconds = max(0.0, ends - time.monotonic())
        for text, share in zip(row, shares[len(shares) - len(row) :], strict=True):
            yield Task("sizes", text, share * seconds, mebibytes)

    def _row(self, which: int, ends: float) -> list[str]:
        """The texts of a lane, the most promising ones first."""
        if not self.is_tried:
            now = time.monotonic()
            self.counted = smaller(self.tables, now + _MAKING * (ends - now))
            self.is_tried = True
        if self.counted is None:
            return [self.tables.text([], order) for order in self.orders[which::2]]
        if self.counted.units:
            return _texts(self.counted if which == 0 else self.counted.without_units())
        if self.texts is None:
            self.texts = _texts(self.counted)
        return self.texts[which::2]


def _texts(counted: Counted) -> list[str]:
    t = counted.drawn
    return [counted.text(order) for order in orders(len(t.initial), t.pre, t.post)]
