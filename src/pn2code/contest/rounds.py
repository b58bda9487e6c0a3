"""What the engine is asked in a round: lanes of tasks, side by side, for the questions that are still open."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import field, replace
from functools import partial

from pn2code.base.frozen import record
from pn2code.contest.diagrams import KINDS, METHOD, TRIED, Diagrams
from pn2code.contest.engine import Task
from pn2code.contest.lines import Place, is_drained
from pn2code.contest.structural import REDUCTION
from pn2code.contest.tables import MOST, Tables

METHODS = {
    "structure": ("reach", "bound"),
    "walk": ("reach", "bound"),
    "explore": ("reach", "bound"),
    "reach": ("reach", "bound"),
    "ctl": ("ctl",),
    "ltl": ("ltl",),
    METHOD: KINDS,
}
"""Method -> the kinds of questions that it can answer. All but `structure` are those of the engine."""
_PAIRS = (("walk", "reach"), ("walk", "reach"), ("explore", "reach"), ("walk", "reach"))
"""For reachability and bounds the methods of the two lanes, by round; the last but one is repeated at the end."""
_ORDERS = (0, 1, 0, 2)
"""Orders of the places of diagrams that have most of the time, by round; the others are tried for a short time."""
_ORDERS_ALONE = ((0, 1), (0, 1), (0, 2), (0, 3))
"""The same where diagrams have both lanes."""
_NEAR_FIRST, _ALL_FIRST = 1, 2
"""Seeds of diagrams: formulas of CTL are asked near to the initial marking first, or in all markings first."""
_WEIGHT = 4.0
"""So much more time have questions that are asked for themselves than those that only help."""
_LEAST_SLICE_S = 0.25
"""With less for each of the questions they are asked together."""


@record
class Rounds:
    """Makes the tasks of each round.

    Args:
        tables: the net.
        places: all questions; there may be more from round to round.
        ends: when the time is over.
        mebibytes: of memory for all lanes.
        only: a method, alone; "": all.
    """

    tables: Tables
    places: list[Place]
    ends: float
    mebibytes: int
    only: str
    diagrams: dict[int, Diagrams] = field(default_factory=dict)
    fitting: dict[int, tuple[Tables, bool]] = field(default_factory=dict)

    def lanes(self, open_: list[int], number: int, length: float) -> list[Iterator[Task]]:
        """Two lanes, each with tasks for all kinds of questions; from the second round on one with diagrams."""
        ends = time.monotonic() + length
        kinds = sorted({self.places[n].part.kind for n in open_})
        drawn = [n for n in open_ if self.places[n].part.kind in KINDS]
        if self.only == METHOD:
            orders = _ORDERS_ALONE[min(number, len(_ORDERS_ALONE) - 1)] if drawn else ()
            return [self._lane([(METHOD, drawn)], number, i, ends, 2) for i in orders]
        is_drawn = bool(drawn) and not self.only and number > 0
        found = []
        for which in range(2):
            tasks: list[tuple[str, list[int]]] = []
            for method in self._methods(kinds, number, which):
                mine = [n for n in open_ if self.places[n].part.kind in METHODS[method]]
                mine = [n for n in mine if not is_drained(self.places[n])]
                if self.only or method in ("ctl", "ltl"):
                    mine = mine[(which + number) % 2 :: 2]  # the lanes have different orders
                if mine:
                    tasks.append((method, mine))
            if tasks:
                found.append(self._lane(tasks, number, which, ends, 2 + is_drawn))
        if is_drawn:
            order = _ORDERS[min(number - 1, len(_ORDERS) - 1)]
            found.append(self._lane([(METHOD, drawn)], number, order, ends, 3))
        return found

    def _methods(self, kinds: list[str], number: int, which: int) -> list[str]:
        if self.only:
            return [self.only]
        pair = _PAIRS[number] if number < len(_PAIRS) else _PAIRS[-2]
        return list(dict.fromkeys(pair[which] if k in ("reach", "bound") else k for k in kinds))

    def _lane(
        self,
        tasks: list[tuple[str, list[int]]],
        number: int,
        which: int,
        ends: float,
        lanes: int,
    ) -> Iterator[Task]:
        """The tasks of a lane, made when it comes to them.

        Args:
            tasks: methods with the numbers of their questions.
            number: of the round.
            which: lane of the round, for other random numbers; of diagrams the order.
            ends: when it is over.
            lanes: that share the memory.
        """
        weights = [1.0 if all(map(self.is_side, numbers)) else _WEIGHT for _, numbers in tasks]
        for i, (method, numbers) in enumerate(tasks):
            now = time.monotonic()
            until = now + (ends - now) * weights[i] / sum(weights[i:])
            kinds = {self.places[n].part.kind for n in numbers}
            groups = self._groups([n for n in numbers if self.places[n].is_open])
            if number == 0 or (until - now) < _LEAST_SLICE_S * len(groups):
                groups = [numbers]
            for k, group in enumerate(groups):
                left = (until - time.monotonic()) / (len(groups) - k)
                still = [n for n in group if self.places[n].is_open]
                if still and left >= _LEAST_SLICE_S / 5:
                    # A diagram of the net as it is is one for all formulas.
                    is_whole = number == 0 or (
                        method == METHOD and number % 2 == 1 and kinds <= {"ctl", "ltl"}
                    )
                    task, net, texts = self._task(still, is_first=is_whole)
                    until_end = self.ends - time.monotonic()
                    if until_end < _LEAST_SLICE_S / 5:
                        return
                    task = replace(
                        task,
                        seconds=min(left, until_end),
                        mebibytes=self.mebibytes // lanes,
                        seed=2 * number + which + 1,
                    )
                    if method == METHOD:
                        is_near = (which if self.only == METHOD else number + 1) % 2 == 0
                        task = replace(task, seed=_NEAR_FIRST if is_near else _ALL_FIRST)
                        yield from self._drawn(task, net, texts, which)
                    else:
                        yield replace(task, method=method, text=net.text([*texts.values()]))

    def is_side(self, number: int) -> bool:
        """Whether a question is only asked since its answer would help with another one."""
        wanted = self.places[number].wanted
        return wanted is not None and wanted.is_side

    def _groups(self, numbers: list[int]) -> list[list[int]]:
        """The questions that have the same net."""
        found: dict[int, list[int]] = {}
        for n in numbers:
            asked = self.places[n].question
            smaller = None if asked is None else asked.smaller
            found.setdefault(0 if smaller is None else id(smaller.tables), []).append(n)
        return list(found.values())

    def _drawn(self, task: Task, net: Tables, texts: dict[int, str], which: int) -> Iterator[Task]:
        """Diagrams with one order of the places after the other, until those of one are whole.

        Args:
            task: its limits.
            net: what it is about.
            texts: of its questions, by number.
            which: the order that has most of the time.
        """
        diagrams = self.diagrams.setdefault(id(net), Diagrams(net))
        ends = time.monotonic() + task.seconds
        is_alone = self.only == METHOD  # there are two lanes then
        offered = range(which % 2, TRIED, 2) if is_alone else range(TRIED)
        for order, patience in diagrams.tries(which, offered, task.seconds):
            left = ends - time.monotonic()
            still = [text for n, text in texts.items() if self.places[n].is_open]
            if left < _LEAST_SLICE_S / 5 or not still:
                return
            text = net.text(still, diagrams.orders[order])
            yield replace(
                task,
                method=METHOD,
                text=text,
                seconds=left,
                patience=patience,
                on_whole=partial(diagrams.note_whole, order),
            )

    def _task(self, numbers: list[int], *, is_first: bool) -> tuple[Task, Tables, dict[int, str]]:
        """What some questions share: how to take an answer, the net, and what is said of it.

        In the beginning it is the net as it is.
        """
        smaller = {}
        for n in numbers if not is_first else ():
            asked = self.places[n].question
            if asked is not None and asked.smaller is not None:
                smaller[n] = (asked.kind, asked.smaller)
        nets = {id(s.tables): s.tables for _, s in smaller.values()}
        asked_of = {n: f"{n} {s.text(kind)}" for n, (kind, s) in smaller.items()}
        is_told = all(map(self.fits, nets.values())) and not any(map(_too_large, asked_of.values()))
        if len(smaller) < len(numbers) or len(nets) != 1 or not is_told:
            tables, added, technique = self.tables, dict[int, int](), ""
            texts = {n: f"{n} {self.places[n].part.text}" for n in numbers}
        else:
            (tables,) = nets.values()
            added = {n: s.added for n, (_, s) in smaller.items()}
            technique = REDUCTION
            texts = asked_of
        return Task("", "", 0.0, 0, added=added, technique=technique), tables, texts

    def fits(self, tables: Tables) -> bool:
        """Whether the engine can read a net; the answer is kept with the net, so that no other one gets its id."""
        if id(tables) not in self.fitting:
            self.fitting[id(tables)] = tables, tables.fits()
        return self.fitting[id(tables)][1]


def _too_large(question: str) -> bool:
    """Whether a question about a reduced net has a factor that the engine does not read."""
    return any(int(number) > MOST for number in re.findall(r"\d{10,}", question))
