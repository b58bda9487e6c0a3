"""The monitors of a game that can be taken back: what each has collected, step by step, for plots.

Statistics are put back with the steps. What functions of monitors do besides (references, files) is not.
"""

from __future__ import annotations

import copy
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.monitors.functions import MonitorProgram
from pn2code.monitors.kinds import kind_text
from pn2code.monitors.statistics import Number, Statistics
from pn2code.monitors.watch import Breakpoint, Watch
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game

MOST_POINTS = 100_000
"""Of a plot."""

_Kept = tuple[tuple[int, Statistics], ...]


class Watching:
    """Monitors at work.

    Args:
        program: the monitors.
        game: what they watch.

    Attributes:
        missed: how many steps they have not seen, because the compiled simulator made them.

    Raises:
        GameError: a function of a monitor raises an exception.
    """

    def __init__(self, program: MonitorProgram, game: Game) -> None:
        self._game = game
        self._d = Diagnostics()
        self._watch = Watch(program, game, self._d)
        self._steps: dict[int, tuple[_Kept, _Kept]] = {}
        self.points: list[list[tuple[int, float, Number]]] = [[] for _ in self._watch.monitors]
        self.missed = 0
        self._watch.start()
        self._note(0)

    def occurred(self, number: int, element: BindingElement) -> Breakpoint | None:
        """After a step, which is the entry of this number; the breakpoint that it has reached.

        Raises:
            GameError: a function of a monitor raises an exception.
        """
        before = {i: copy.copy(s) for i, s in self._statistics()}
        try:
            return self._watch.occurred(element)
        finally:
            own = [i for i, s in self._statistics() if s.count != before[i].count]
            if own:
                after = {i: copy.copy(s) for i, s in self._statistics()}
                kept = tuple((i, before[i]) for i in own), tuple((i, after[i]) for i in own)
                self._steps[number] = kept
                self._note(number + 1, own)

    def time_grew(self) -> Breakpoint | None:
        """After the clock was moved on."""
        return self._watch.time_grew()

    def back(self, number: int) -> None:
        """The entry of this number was taken back."""
        self._put(number, 0)
        for i, points in enumerate(self.points):
            while points and points[-1][0] > number:
                self.points[i].pop()

    def on(self, number: int) -> None:
        """The entry of this number was made again."""
        own = self._put(number, 1)
        if own:
            self._note(number + 1, own)

    def _put(self, number: int, which: int) -> list[int]:
        kept = self._steps.get(number)
        if kept is None:
            return []
        for i, statistics in kept[which]:
            self._watch.monitors[i].statistics = copy.copy(statistics)
        return [i for i, _ in kept[which]]

    def _statistics(self) -> list[tuple[int, Statistics]]:
        pairs = enumerate(m.statistics for m in self._watch.monitors)
        return [(i, s) for i, s in pairs if s is not None]

    def _note(self, at: int, only: list[int] | None = None) -> None:
        """A point of each plot."""
        for i, s in self._statistics():
            if (only is None or i in only) and s.count and len(self.points[i]) < MOST_POINTS:
                self.points[i].append((at, self._game.marking.time, s.values()["last"]))

    def rows(self) -> list[dict[str, Any]]:
        """Each monitor, and what it has collected, for the page."""
        rows = self._watch.results()
        for m, row in zip(self._watch.monitors, rows, strict=True):
            row["kind"] = kind_text(m.kind)
            row["active"] = m.active
        return rows

    def warnings(self) -> list[str]:
        """What monitors could not do."""
        return [i.message for i in self._d.sorted()]
