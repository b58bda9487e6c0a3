"""Decision diagrams beside the other methods: a process of its own, which builds all markings and then answers.

    diagrams = Diagrams(tables)
    tasks += diagrams.tasks({0: "reach dead"}, round_=1, seconds=3.0, mebibytes=1024)

Whether a diagram stays small depends on the order of its levels, so that each round takes another one. The engine says
nothing before the set is whole: a diagram that explodes costs its share of time and memory, and nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

from pn2code.contest.engine import Task
from pn2code.contest.tables import Tables
from pn2code.symbolic.order import orders

METHOD = "diagrams"
KINDS = ("reach", "bound", "ctl")
"""The kinds of questions that it can answer."""


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
        """The numbers of markings and arcs, side by side with the two most promising orders."""
        return [
            Task("sizes", self.tables.text([], order), seconds, mebibytes)
            for order in self.orders[:2]
        ]
