"""An examination of an input, line by line, as far as the time allows.

    asking = Asking(program, "CTLFireability", folder, deadline, mebibytes=4096, only="", say=print)
    for line in asking.of_tables(tables): ...
    for line in asking.of_net(net, unfolded): ...    # a coloured one

A coloured net that is large when it is unfolded is asked without its colours first (uncoloured.py), for a short time;
and if it cannot be unfolded in its share of the time, for the rest of it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from math import prod
from pathlib import Path
from typing import Any

from pn2code.base.deadline import Deadline, TimeIsOverError
from pn2code.contest.conditions import AtMost, Condition
from pn2code.contest.engine import Space
from pn2code.contest.evidence import evidence, of_condition, rests_on
from pn2code.contest.examinations import Asked, asked
from pn2code.contest.formulas import Formula, FormulaError, Op
from pn2code.contest.lines import Result
from pn2code.contest.portfolio import answers
from pn2code.contest.space import space
from pn2code.contest.structural import terms
from pn2code.contest.tables import Tables
from pn2code.contest.uncoloured import uncoloured
from pn2code.contest.watchdog import Watch
from pn2code.contest.words import SPACE, UNKNOWN, unknown
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.unfold.plain import TooLargeError

FIRST = 0.15
FIRST_S = 6.0
"""Of the time, and at most so long, a large coloured net is asked without its colours at first."""
UNFOLDING = 0.5
"""Of the time that is left then, for unfolding."""
LARGE_PLACES = 4_000
LARGE_BINDINGS = 20_000
"""From so many places, or bindings of the variables of a transition, on a net is large."""


class Asking:
    """What is asked.

    Args:
        program: the engine.
        examination: its name.
        folder: with the files of formulas.
        deadline: of all together.
        mebibytes: of memory.
        only: a method, alone; "": all.
        say: where reasons go why something is not known.
        watch: who is told what is open, and what is printed.
    """

    def __init__(
        self,
        program: Path,
        examination: str,
        folder: Path,
        deadline: Deadline,
        *,
        mebibytes: int,
        only: str,
        say: Callable[[str], None],
        watch: Watch | None = None,
    ) -> None:
        self.program = program
        self.examination = examination
        self.folder = folder
        self.deadline = deadline
        self.mebibytes = mebibytes
        self.only = only
        self.say = say
        self.watch = Watch() if watch is None else watch
        self.unknown: dict[str, str] | None = None
        """Lines that are open, with the reason; None: nothing was asked yet."""
        self.shown: list[tuple[Result, Condition | str, Tables]] = []
        """Answers that nothing is reachable, with what was looked for."""

    def of_tables(self, tables: Tables) -> Iterator[str]:
        """The lines for a place/transition net.

        Raises:
            FormulaError: a file of formulas cannot be read.
        """
        if self.examination == SPACE:
            left = max(0.0, self.deadline.left or 0.0)
            sizes = space(
                self.program, tables, seconds=left, mebibytes=self.mebibytes, only=self.only
            )
            self.watch.note_all_said()
            yield from _space(sizes)
            return
        yield from self._answers(tables, self.deadline, None)
        yield from self._rest()

    def of_net(self, net: FlatNet, unfolded: Callable[[FlatNet], Tables | None]) -> Iterator[str]:
        """The lines for a coloured net.

        Args:
            net: the net.
            unfolded: unfolds it; None: it cannot be, and the reason was given.

        Raises:
            FormulaError: a file of formulas cannot be read.
            GameError: the initial marking cannot be made.
        """
        has_formulas = self.examination != SPACE
        game = without = tables = None
        if has_formulas:
            game, without = self._without_colours(net)
        if game is not None and without is not None and is_large(net, game):
            part = min(FIRST, FIRST_S / max(self.deadline.left or 0.0, FIRST_S))
            yield from self._answers(without, self.deadline.share(part), game)
            if self.unknown is not None and not self.unknown:
                return
        try:
            with self.deadline.share(UNFOLDING if has_formulas else 1.0).enforced():
                tables = unfolded(net)
        except (TimeIsOverError, TooLargeError) as error:
            self.say(f"not unfolded: {str(error) or 'it takes too long'}")
            # In the game from before a step may still be searched for.
            game = None if without is None else self._game(net)
            if game is not None and without is not None:
                yield from self._answers(without, self.deadline, game)
            yield from self._rest()
            return
        if tables is None:
            yield from self._rest()
        else:
            yield from self.of_tables(tables)

    def _game(self, net: FlatNet) -> Game | None:
        with suppress(TimeIsOverError), self.deadline.enforced():
            return Game(net)
        return None

    def _without_colours(self, net: FlatNet) -> tuple[Game | None, Tables | None]:
        with suppress(TimeIsOverError), self.deadline.enforced():
            game = Game(net)
            return game, uncoloured(net, game)
        return None, None

    def _answers(self, tables: Tables, deadline: Deadline, game: Game | None) -> Iterator[str]:
        questions: list[Asked] = []
        try:
            with deadline.enforced():
                questions = asked(tables, self.examination, self.folder)
        except TimeIsOverError:
            return
        if self.unknown is None:
            self.unknown = {q.name: "" for q in questions}
            self.watch.note_open(self.unknown)
        questions = [q for q in questions if q.name in self.unknown]
        if game is None:
            self.unknown.update({q.name: q.why_not for q in questions})
        found = answers(
            self.program,
            tables,
            questions,
            seconds=max(0.0, deadline.left or 0.0),
            mebibytes=self.mebibytes,
            only=self.only,
            game=game,
        )
        by_name = {q.name: q for q in questions}
        for result in found:
            if game is None:
                self.note(by_name[result.name], result, tables)
            del self.unknown[result.name]
            self.watch.note_said(result.name)
            value = str(result.value).upper()
            yield f"FORMULA {result.name} {value} TECHNIQUES {result.techniques}"

    def note(self, asked: Asked, result: Result, tables: Tables) -> None:
        """Keep an answer for `evidence`, if it says that nothing is reachable."""
        sought = _sought(asked, result, tables)
        if sought is not None:
            self.shown.append((result, sought, tables))

    def evidence(self) -> Iterator[dict[str, Any]]:
        """For each answer that nothing is reachable why not, as far as there is time."""
        until = time.monotonic() + max(0.0, self.deadline.left or 0.0)
        for result, sought, tables in self.shown:
            name = _names(tables)
            if isinstance(sought, str):
                found = evidence(sought, tables, name, until)
            else:
                found = of_condition(sought, tables, name, until)
            methods = tuple(result.techniques.split())
            is_late = time.monotonic() > until
            rests = None if found is not None else rests_on(methods, is_late=is_late)
            yield {"name": result.name, "certificate": found, "rests_on": rests}

    def _rest(self) -> Iterator[str]:
        """What is not known."""
        if self.unknown is None:
            self.watch.note_all_said()
            yield UNKNOWN
            return
        for name, why in self.unknown.items():
            if why:
                self.say(f"{name}: {why}")
            self.watch.note_said(name)
            yield unknown(name)


def _sought(asked: Asked, result: Result, tables: Tables) -> Condition | str | None:
    """What is not reachable, by an answer: of a bound one token more; None: it says something else."""
    match asked.formula:
        case Op("E", (Op("F", (f,)),)) if result.value is False:
            return _question(tables, f)
        case Op("A", (Op("G", (f,)),)) if result.value is True:
            return _question(tables, Op("not", (f,)))
    if len(asked.parts) != 1 or asked.decides is not None:
        return None
    (part,) = asked.parts
    if part.kind == "reach" and result.value == asked.is_turned:
        return part.text
    if part.kind == "bound":
        more = tuple((p, -n) for p, n in terms(part.text.split(" ", 1)[1]))
        return AtMost(more, -result.value - 1)
    return None


def _question(tables: Tables, f: Formula) -> str | None:
    """Of a formula about one marking; None: it is about more."""
    try:
        return f"reach {tables.formula(f)}"
    except FormulaError:
        return None


def _names(tables: Tables) -> Callable[[int], str]:
    """Of its places, and of the numbers of steps of its transitions, which come after these."""
    places = dict(_numbered(tables.places))
    transitions = dict(_numbered(tables.transitions))
    count = len(tables.initial)

    def name(number: int) -> str:
        if number < count:
            return places.get(number, f"place {number}")
        return f"steps of {transitions.get(number - count, f'transition {number - count}')}"

    return name


def _numbered(ids: Mapping[str, Sequence[int]]) -> Iterator[tuple[int, str]]:
    """Of several that one id stands for, each has a number behind it."""
    for name, own in ids.items():
        for i, number in enumerate(own):
            yield number, name if len(own) == 1 else f"{name}[{i}]"


def is_large(net: FlatNet, game: Game) -> bool:
    """Whether unfolding a net takes a second or more, as far as the sizes of its colour sets say it."""
    size = game.colours.size
    try:
        places = sum(size(p.colset) for p in net.places)
        bindings = sum(
            prod(size(s.colset) for s in t.variables if s.colset is not None)
            for t in net.transitions
        )
    except (MlException, MlLimit):  # a colour set without bounds says nothing
        return True
    return places > LARGE_PLACES or bindings > LARGE_BINDINGS


def _space(found: Space | None) -> Iterator[str]:
    if found is None:
        yield UNKNOWN
        return
    for what, number in (
        ("STATES", found.states),
        ("TRANSITIONS", found.arcs),
        ("MAX_TOKEN_IN_PLACE", found.tokens_in_place),
        ("MAX_TOKEN_PER_MARKING", found.tokens_in_marking),
    ):
        yield f"STATE_SPACE {what} {number} TECHNIQUES {found.method}"
