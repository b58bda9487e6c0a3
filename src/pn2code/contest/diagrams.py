"""Decision diagrams beside the other methods: a process of its own, which builds all markings and then answers.

    diagrams = Diagrams(tables)
    tasks += diagrams.tasks({0: "reach dead"}, round_=1, seconds=3.0, mebibytes=1024)

Whether a diagram stays small depends on the order of its levels, so that each round takes another one. The engine says
nothing before the set is whole: a diagram that explodes costs its share of time and memory, and nothing else.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from functools import cached_property

from pn2code.contest.engine import Task
from pn2code.contest.tables import Tables
from pn2code.symbolic.order import orders

METHOD = "diagrams"
KINDS = ("reach", "bound", "ctl")
"""The kinds of questions that it can answer."""

_SHARES = (0.1, 0.15, 0.15, 0.6)
"""Of the time, for one order after the other where there are several."""


class Diagrams:
    """A net with orders of its places."""

    def __init__(self, tables: Tables) -> None:
        self.tables = tables

    @cached_property
    def orders(self) -> list[list[int]]:
        """The most promising one first."""
        return orders(len(self.tables.initial), self.tables.pre, self.tables.post)

    def tasks(
        self, questions: Mapping[int, str], which: range, seconds: float, mebibytes: int
    ) -> list[Task]:
        """All questions, side by side with several orders.

        Args:
            questions: by number; none: nothing is to be done.
            which: orders; there may be fewer.
            seconds: for each.
            mebibytes: for each.
        """
        if not questions:
            return []
        asked = [f"{n} {text}" for n, text in questions.items()]
        used = list(dict.fromkeys(i % len(self.orders) for i in which))
        return [
            Task(METHOD, self.tables.text(asked, self.orders[i]), seconds, mebibytes) for i in used
        ]

    def sizes(self, seconds: float, mebibytes: int) -> list[Task]:
        """The numbers of markings and arcs: two rows side by side, each with one order after the other.

        Each order has a short time at first; the most promising two have what is left, when the orders are made.
        """
        ends = time.monotonic() + seconds
        rows = [self.orders[:1], self.orders[1:2]]
        shares: tuple[float, ...] = (1.0,)
        if len(self.orders) > 2:
            shares = _SHARES
            rows = [[*self.orders[i::2][:3], self.orders[i]] for i in range(2)]
        seconds = max(0.0, ends - time.monotonic())
        found = []
        for row in filter(None, rows):
            task = None
            for order, share in reversed(list(zip(row, shares[-len(row) :], strict=True))):
                text = self.tables.text([], order)
                task = Task("sizes", text, share * seconds, mebibytes, then=task)
            assert task is not None
            found.append(task)
        return found
