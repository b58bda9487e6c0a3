"""The monitors of a game that can be taken back: what each has collected, step by step, for plots.

Statistics are put back with the steps. What functions of monitors do besides (references, files) is not.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable
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

_Kept = tuple[tuple[int, Statistics, Statistics], ...]
"""Of a step: the number of each monitor that has collected something, its statistics before and after."""
WEIGHT = 600
"""Bytes of what is kept of a monitor for a step, about."""


class Watching:
    """Monitors at work.

    Args:
        program: the monitors.
        game: what they watch.

    Attributes:
        points: of each monitor's plot: how many entries there were, the model time, the value.

    Raises:
        GameError: a function of a monitor raises an exception.
    """

    def __init__(self, program: MonitorProgram, game: Game) -> None:
        self._game = game
        self._d = Diagnostics()
        self._watch = Watch(program, game, self._d)
        self._steps: dict[int, _Kept] = {}
        """By entry of the history, ascending: those that can be taken back or made again."""
        self._leaps: dict[int, int] = {}
        self._position = 0
        self.points: list[list[tuple[int, float, Number]]] = [[] for _ in self._watch.monitors]
        self._watch.start()
        self._now = {i: copy.copy(s) for i, s in self._statistics()}
        """What each has collected, as it is kept for steps."""
        self._note(0)

    @property
    def weight(self) -> int:
        """Bytes that are kept for a step, at most."""
        return WEIGHT * len(self._now)

    @property
    def missed(self) -> int:
        """How many steps they have not seen, because the compiled simulator made them."""
        return sum(n for number, n in self._leaps.items() if number < self._position)

    def occurred(self, number: int, element: BindingElement) -> Breakpoint | None:
        """After a step, which is the entry of this number; the breakpoint that it has reached.

        Raises:
            GameError: a function of a monitor raises an exception.
        """
        try:
            return self._watch.occurred(element)
        finally:
            own = [(i, s) for i, s in self._statistics() if s.count != self._now[i].count]
            if own:
                kept = tuple((i, self._now[i], copy.copy(s)) for i, s in own)
                self._steps[number] = kept
                self._now.update({i: after for i, _, after in kept})
                self._note(number + 1, [i for i, _ in own])

    def goes_on(self, number: int, missed: int = 0) -> None:
        """There is a new entry, of this number: what it and later ones were on another way is forgotten.

        Args:
            number: of the entry.
            missed: how many steps it is that nobody watches.
        """
        for kept in (self._steps, self._leaps):
            while kept and next(reversed(kept)) >= number:
                kept.popitem()
        if missed:
            self._leaps[number] = missed
        self._position = number + 1

    def forget(self, before: int) -> None:
        """The entries before this number are not taken back any more."""
        while self._steps and (first := next(iter(self._steps))) < before:
            del self._steps[first]

    def time_grew(self) -> Breakpoint | None:
        """After the clock was moved on."""
        return self._watch.time_grew()

    def back(self, number: int) -> None:
        """The entry of this number was taken back."""
        self._position = number
        self._put((i, before) for i, before, _ in self._steps.get(number, ()))
        for points in self.points:
            while points and points[-1][0] > number:
                points.pop()

    def on(self, number: int) -> None:
        """The entry of this number was made again."""
        self._position = number + 1
        own = self._put((i, after) for i, _, after in self._steps.get(number, ()))
        if own:
            self._note(number + 1, own)

    def _put(self, wanted: Iterable[tuple[int, Statistics]]) -> list[int]:
        """Lets these monitors have these statistics; the numbers of the monitors."""
        put = dict(wanted)
        self._now.update(put)
        for i, statistics in put.items():
            self._watch.monitors[i].statistics = copy.copy(statistics)
        return list(put)

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
