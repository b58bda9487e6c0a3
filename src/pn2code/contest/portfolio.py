"""Several methods side by side, in rounds that get longer: each is given what is still open.

    for result in answers(program, tables, asked, seconds=60.0): ...

A method that cannot answer a question leaves it to the others. Two that answer the same question must agree. The
structural methods (structural.py) run beside the rounds; what they have reduced, the engine is asked about.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from queue import Empty, SimpleQueue

from pn2code.contest.conditions import TRUE
from pn2code.contest.engine import Answer, Said, ask, grace_of
from pn2code.contest.equation import wait_for_solver
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import FormulaError
from pn2code.contest.home import Home
from pn2code.contest.lines import Line, Place, Result, is_drained
from pn2code.contest.paths import path_of
from pn2code.contest.playing import TECHNIQUE as PLAYED
from pn2code.contest.playing import Play, Sought, follow, holds, said_in_words
from pn2code.contest.rounds import Rounds
from pn2code.contest.structural import Question, Structural, question, terms
from pn2code.contest.tables import Tables
from pn2code.contest.temporal import Reach, Temporal, Wanted, Whole
from pn2code.properties.ltl_expansion import TooLargeError
from pn2code.semantics.game.token_game import Game

_ROUNDS_S = (1.0, 3.0, 8.0, 20.0)
_SIDE_ROUNDS = 3
"""In so many rounds formulas of time are asked that only help with others."""
_LEAST_S = 0.2
"""With less time left nothing is begun."""
_MAKING = 0.1
"""Of the time, for making questions for the structural methods: before that nothing else begins."""
_POLL_S = 0.05


def answers(
    program: Path,
    tables: Tables,
    asked: Sequence[Asked],
    *,
    seconds: float,
    mebibytes: int = 4096,
    only: str = "",
    game: Game | None = None,
) -> Iterator[Result]:
    """The answers that can be had, in the order in which they come.

    Of a net without its colours (uncoloured.py) only what is not reachable, and what places hold at most, is believed;
    what is reachable is found by the token game of the coloured net.

    Args:
        program: the engine.
        tables: the net.
        asked: the lines of the examination.
        seconds: for all of them together.
        mebibytes: of memory for all that runs side by side.
        only: a method, alone; "": all.
        game: the coloured net, if the tables are that net without its colours.

    Raises:
        RuntimeError: two methods contradict each other, or the engine did not understand its tables.
    """
    ends = time.monotonic() + seconds
    portfolio = _Portfolio(program, tables, asked, ends, mebibytes, only, game)
    yield from portfolio.at_once()
    try:
        yield from portfolio.rounds()
    finally:
        portfolio.end()


class _Portfolio:
    def __init__(
        self,
        program: Path,
        tables: Tables,
        asked: Sequence[Asked],
        ends: float,
        mebibytes: int,
        only: str,
        game: Game | None,
    ) -> None:
        assert (game is None) == (tables.at_first is None)
        self.is_uncoloured = game is not None
        self.program = program
        self.tables = tables
        self.ends = ends
        self.grace = grace_of(ends - time.monotonic())
        self.only = only
        self.said: Said = SimpleQueue()
        self.lines = [Line(a) for a in asked]
        self.places: list[Place] = []
        for line in self.lines:
            parts: list[tuple[Part, bool | None]] = [(p, None) for p in line.asked.parts]
            for which, (part, hint) in enumerate([*parts, *line.asked.hints]):
                self.places.append(Place(line, part, which, hint))
        self.home: Home | None = None
        self.home_number = -1
        self.drained_number = -2
        self.asker = Rounds(tables, self.places, ends, mebibytes, only)
        self.structural: Structural | None = None
        self.given = 0
        """Places that a round has had; those after them have come since."""
        for line in self.lines:
            if line.asked.formula is not None:
                is_whole = only in ("ctl", "ltl")
                line.temporal = Temporal(
                    tables, line.asked.kind, line.asked.formula, is_whole=is_whole
                )
                self._ask_for(line)
        self.play = None if game is None else Play(game, self._sought, self.said, ends)
        self.sought: dict[int, Sought] = {}
        if only in ("", "structure"):
            self._start_structural()
            self._start_home()
        if self.play is not None and only in ("", "walk"):
            self.play.start()

    def _ask_for(self, line: Line) -> None:
        """What a formula wants to know, as far as it was not asked before."""
        assert line.temporal is not None
        for wanted in line.temporal.wanted:
            if wanted not in line.asked_for:
                line.asked_for.add(wanted)
                self._add(line, line.temporal, wanted)
        for place in self.places:
            if place.line is line and place.question is not None and not place.is_open:
                place.question.is_done = True

    def _add(self, line: Line, temporal: Temporal, wanted: Wanted) -> None:
        if self.is_uncoloured and isinstance(wanted, Whole):
            if path_of(wanted.formula) is not None:
                self.places.append(Place(line, Part("path", ""), 0, wanted=wanted))
            return
        try:
            kind = "reach" if isinstance(wanted, Reach) else temporal.kind
            part = Part(kind, temporal.text(wanted))
        except (FormulaError, TooLargeError) as error:
            if not wanted.is_side:
                line.why_not = str(error) or "its automaton is too large"
            return
        place = Place(line, part, 0, wanted=wanted)
        self.places.append(place)
        if is_drained(place):
            if self.home is not None:
                place.question = self._question(len(self.places) - 1)
                if place.question is not None:
                    self.home.add(place.question)
        elif self.structural is not None:
            place.question = self._question(len(self.places) - 1)
            if place.question is not None:
                self.structural.add(place.question)

    def _sought(self) -> list[Sought]:
        """What is open, for the token game; the other thread may add more meanwhile."""
        for n in range(len(self.sought), len(self.places)):
            place = self.places[n]
            words = place.part.text.split(" ", 1)
            if isinstance(place.wanted, Reach):
                self.sought[n] = Sought(n, holds(self.tables, place.wanted.condition))
            elif place.part.kind == "reach":
                names = list(self.tables.transitions)
                self.sought[n] = Sought(n, said_in_words(words[1], names))
            elif place.part.kind == "bound":
                self.sought[n] = Sought(n, None, terms(words[1]))
            else:
                self.sought[n] = self._followed(n, place)
        return [s for n, s in self.sought.items() if self.places[n].is_open]

    def _followed(self, number: int, place: Place) -> Sought:
        followed = None
        if isinstance(place.wanted, Whole):
            followed = follow(self.tables, place.wanted.formula)
        is_linear = place.line.temporal is not None and place.line.temporal.kind == "ltl"
        return Sought(number, lambda sight: False, followed=followed, is_linear=is_linear)

    def _can_be_asked(self, number: int) -> bool:
        """Whether the net knows of a question: without colours nothing of dead markings, and no bounds."""
        part = self.places[number].part
        return not self.is_uncoloured or (part.kind == "reach" and part.text != "reach dead")

    def _question(self, number: int) -> Question | None:
        place = self.places[number]
        if not self._can_be_asked(number) and place.part.kind != "bound":
            return None
        if isinstance(place.wanted, Whole):
            of_time = place.wanted
            return Question(
                number, place.part.kind, TRUE, formula=of_time.formula, is_side=of_time.is_side
            )
        if place.part.formula is not None:
            return Question(number, place.part.kind, TRUE, formula=place.part.formula)
        return question(number, place.part, self.tables)

    def _start_structural(self) -> None:
        now = time.monotonic()
        until = now + _MAKING * (self.ends - now)
        for number, place in enumerate(self.places):
            if time.monotonic() < until:  # what comes later is left to the engine
                place.question = self._question(number)
        found = [p.question for p in self.places if p.question is not None]
        if found:
            goes_on = any(line.temporal is not None for line in self.lines)
            self.structural = Structural(
                self.tables, found, self.said, self.ends, goes_on=goes_on, waits=not self.only
            )
            self.structural.start()

    def _start_home(self) -> None:
        """Only formulas of CTL, and liveness, gain from it."""
        of_use = any(
            line.asked.at_home or (line.temporal is not None and line.asked.kind == "ctl")
            for line in self.lines
            if not line.is_done and line.result() is None
        )
        if of_use and not self.is_uncoloured:
            numbers = self.home_number, self.drained_number
            self.home = Home(self.tables, *numbers, self.said, self.ends)
            self.home.start()

    def end(self) -> None:
        """Nothing is to be asked any more; when the time is over, nobody waits for a linear program."""
        left = self.ends + self.grace - time.monotonic()
        for thread in (self.home, self.structural, self.play):
            if thread is not None:
                thread.end()
        wait_for_solver(max(0.0, min(self.grace, left)))

    def at_once(self) -> Iterator[Result]:
        """Without places or transitions nothing has to be asked."""
        for line in self.lines:
            result = line.result()
            if result is not None:
                line.is_done = True
                yield result

    def rounds(self) -> Iterator[Result]:
        """Until all is known or the time is over."""
        number = 0
        while not all(line.is_done for line in self.lines):
            left = self.ends - time.monotonic()
            open_ = [n for n, p in enumerate(self.places) if p.is_open]
            open_ = [n for n in open_ if self._can_be_asked(n)]
            if number >= _SIDE_ROUNDS:
                open_ = [n for n in open_ if not (self.asker.is_side(n) and self._is_whole(n))]
            if number > len(_ROUNDS_S):  # only what has come since
                open_ = [n for n in open_ if n >= self.given]
            if not open_ or left < _LEAST_S or self.only == "structure":
                break
            if not self.asker.fits(self.tables):  # equations and reductions have no limit
                break
            self.given = len(self.places)
            length = min(left, _ROUNDS_S[number]) if number < len(_ROUNDS_S) else left
            lanes = self.asker.lanes(open_, number, length)
            for answer in ask(self.program, lanes, self.said, until=self.ends + self.grace):
                assert isinstance(answer, Answer)
                yield from self._noted(answer)
                if all(line.is_done for line in self.lines):
                    return
            number += 1
        for answer in self._structural_alone():
            yield from self._noted(answer)
            if all(line.is_done for line in self.lines):
                return
            is_asked = self.only != "structure" and self.asker.fits(self.tables)
            if len(self.places) > self.given and is_asked:
                yield from self.rounds()
                return

    def _is_whole(self, number: int) -> bool:
        return isinstance(self.places[number].wanted, Whole)

    def _structural_alone(self) -> Iterator[Answer]:
        others = [t for t in (self.structural, self.play, self.home) if t is not None]
        while others and time.monotonic() < self.ends and any(p.is_open for p in self.places):
            is_running = any(t.is_alive() for t in others)
            try:
                found = self.said.get(timeout=_POLL_S)
            except Empty:
                if not is_running:
                    return
                continue
            if isinstance(found, Exception):
                raise RuntimeError(str(found)) from found
            if isinstance(found, Answer):
                yield found

    def _at_home(self, answer: Answer) -> Iterator[Result]:
        """The initial marking is a home marking."""
        for line in self.lines:
            if line.is_done:
                continue
            line.is_home = True
            if line.asked.at_home:
                line.techniques.update(answer.method.split())
            if line.temporal is not None:
                before = line.temporal.formula
                line.temporal.learn_home()
                if line.temporal.formula != before:
                    line.techniques.update(answer.method.split())
                self._ask_for(line)
            yield from self._finished(line)

    def _note_drained(self) -> None:
        """Each reachable marking leads to one in which a formula holds."""
        assert self.home is not None and self.home.drained is not None
        for line in self.lines:
            if line.temporal is not None and not line.is_done:
                line.temporal.learn_drained(self.home.drained)
                self._ask_for(line)

    def _finished(self, line: Line) -> Iterator[Result]:
        """The result of a line, if it has one now."""
        result = None if line.is_done else line.result()
        if result is not None:
            line.is_done = True
            for p in self.places:
                if p.line is line and p.question is not None:
                    p.question.is_done = True
            yield result

    def _noted(self, answer: Answer) -> Iterator[Result]:
        if answer.number == self.home_number:
            yield from self._at_home(answer)
            return
        if answer.number == self.drained_number:
            self._note_drained()
            return
        place = self.places[answer.number]
        line = place.line
        value = answer.value
        if self.is_uncoloured and answer.method != PLAYED and answer.is_final:
            if place.part.kind == "bound":
                known = self._at_most(place, int(value))
                if known is None:
                    return
                value = known
            elif value:
                return
        if not answer.is_final:
            known = None if place.question is None else place.question.learn(least=int(value))
            if known is None:
                return
            value = known
        if place.value is not None:
            if place.value != value:
                raise RuntimeError(f"{line.asked.name}: {answer.method} contradicts another method")
            return
        place.value = value
        if place.question is not None:
            place.question.is_done = True
        if place.wanted is not None:
            self._learn(line, place.wanted, bool(value), answer.method)
        elif place.hint is None:
            line.known[place.which] = value
        elif place.hint == value:
            line.hinted = True
        else:
            line.occurring.add(place.which)
            if not line.is_home:
                return
        if place.wanted is None:
            line.techniques.update(answer.method.split())
        yield from self._finished(line)

    def _at_most(self, place: Place, value: int) -> int | None:
        """Without colours places hold at most that; what they hold, if that is known now."""
        assert place.question is not None
        place.question.is_done = False
        return place.question.learn(most=value)

    def _learn(self, line: Line, wanted: Wanted, value: bool, method: str) -> None:
        """Put an answer into a formula."""
        assert line.temporal is not None
        before = line.temporal.formula
        is_turned = isinstance(wanted, Whole) and line.temporal.kind == "ltl"
        line.temporal.learn(wanted, value != is_turned)
        if line.temporal.formula != before:
            line.techniques.update(method.split())
        self._ask_for(line)
