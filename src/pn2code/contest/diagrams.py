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
_MAKING = 0.1
"""Of the time, to make the net smaller before its markings are counted."""


class Diagrams:
    """A net with orders of its places."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables
        self.lock = threading.Lock()
        self.counted: Counted | None = None
        self.is_tried = False

    @cached_property
    def orders(self) -> list[list[int]]:
        """The most promising one first."""
        return orders(len(self.tables.initial), self.tables.pre, self.tables.post)

    def smaller(self, until: float) -> Counted | None:
        """The net for counting, made smaller once; None: it is not to be had."""
        if not self.is_tried:
            self.is_tried = True
            self.counted = smaller(self.tables, until)
            if self.counted is not None:
                t = self.counted.tables
                self.orders = orders(len(t.initial), t.pre, t.post)
        return self.counted

    def sizes(self, seconds: float, mebibytes: int) -> list[Iterator[Task]]:
        """The numbers of markings and arcs: two lanes side by side, each with one order after the other.

        Each order has a short time at first; the most promising two have what is left. The net is made smaller, and
        the orders are made, when the first lane asks for a task, since this takes long for large nets.
        """
        ends = time.monotonic() + seconds
        return [self._lane(which, ends, mebibytes) for which in range(2)]

    def _lane(self, which: int, ends: float, mebibytes: int) -> Iterator[Task]:
        with self.lock:
            now = time.monotonic()
            counted = self.smaller(now + _MAKING * (ends - now))
            orders = self.orders
        shares: tuple[float, ...]
        row, shares = orders[which : which + 1], (1.0,)
        if len(orders) > 2:
            row, shares = [*orders[which::2][:3], orders[which]], _SHARES
        seconds = max(0.0, ends - time.monotonic())
        for order, share in zip(row, shares[len(shares) - len(row) :], strict=True):
            text = self.tables.text([], order) if counted is None else counted.text(order)
            yield Task("sizes", text, share * seconds, mebibytes)
