"""Several methods side by side, in rounds that get longer: each is given what is still open.

    for result in answers(program, tables, asked, seconds=60.0): ...

A method that cannot answer a question leaves it to the others. Two that answer the same question must agree. The
structural methods (structural.py) run beside the rounds; what they have reduced, the engine is asked about.
"""

from __future__ import annotations

import re
import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue

from pn2code.base.frozen import frozen, record
from pn2code.contest.conditions import TRUE
from pn2code.contest.diagrams import KINDS, METHOD, TRIED, Diagrams
from pn2code.contest.engine import Answer, Said, Space, Task, ask
from pn2code.contest.equation import wait_for_solver
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import FormulaError
from pn2code.contest.home import Home
from pn2code.contest.paths import path_of
from pn2code.contest.playing import TECHNIQUE as PLAYED
from pn2code.contest.playing import Play, Sought, follow, holds, said_in_words
from pn2code.contest.structural import REDUCTION, Question, Structural, question, terms
from pn2code.contest.tables import MOST, Tables
from pn2code.contest.temporal import Reach, Temporal, Wanted, Whole
from pn2code.properties.ltl import TooLargeError
from pn2code.semantics.game.token_game import Game

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
_ROUNDS_S = (1.0, 3.0, 8.0, 20.0)
_ORDERS = (0, 1, 0, 2)
"""Orders of the places of diagrams that have most of the time, by round; the others are tried for a short time."""
_ORDERS_ALONE = ((0, 1), (0, 1), (0, 2), (0, 3))
"""The same where diagrams have both lanes."""
_SIDE_ROUNDS = 3
"""In so many rounds formulas of time are asked that only help with others."""
REWRITING = "REWRITING"
"""What the initial marking and the formula alone decide."""
_LEAST_S = 0.2
"""With less time left nothing is begun."""
_MAKING = 0.1
"""Of the time, for making questions for the structural methods: before that nothing else begins."""
_POLL_S = 0.05
_WEIGHT = 4.0
"""So much more time have questions that are asked for themselves than those that only help."""
_LEAST_SLICE_S = 0.25
"""With less for each of the questions they are asked together."""
_GRACE_S = 0.5
_GRACE = 0.05
"""So much later than its time, but by no more than that part of it, a process may say what it knows."""


@frozen
class Result:
    """The answer to one line of an examination."""

    name: str
    value: bool | int
    techniques: str


@record
class _Line:
    """A line with what is known of its parts."""

    asked: Asked
    known: dict[int, bool | int] = field(default_factory=dict)
    techniques: set[str] = field(default_factory=set)
    hinted: bool = False
    is_done: bool = False
    is_home: bool = False
    occurring: set[int] = field(default_factory=set)
    temporal: Temporal | None = None
    asked_for: set[Wanted] = field(default_factory=set)
    why_not: str = ""

    def result(self) -> Result | None:
        """The answer, once it is known."""
        a = self.asked
        value: bool | int
        if self.temporal is not None:
            known = self.temporal.value
            if known is None:
                return None
            value = known
        elif a.formula is not None:
            return None
        elif self.hinted:
            value = a.value
        elif a.decides is None:
            if not self.known:
                return None
            value = next(iter(self.known.values()))
            value = not value if a.is_turned else value
        elif a.decides in self.known.values():
            value = a.value
        elif len(self.known) == len(a.parts) or self._is_live_at_home():
            value = not a.value
        else:
            return None
        return Result(a.name, value, " ".join(sorted(self.techniques)) or REWRITING)

    def _is_live_at_home(self) -> bool:
        """What can occur at all can occur again and again, and nothing is open of the former."""
        found = self.asked.at_home
        return self.is_home and bool(found) and self.occurring >= set(found)


@record
class _Place:
    """Where a question belongs: the part of a line, a hint with the answer that decides, or what a formula wants."""

    line: _Line
    part: Part
    which: int
    hint: bool | None = None
    question: Question | None = None
    value: bool | int | None = None
    wanted: Wanted | None = None

    @property
    def is_open(self) -> bool:
        """Whether an answer would still be of use."""
        if self.wanted is not None:
            temporal = self.line.temporal
            if temporal is None or self.wanted not in temporal.wanted:
                return False
        return self.value is None and not self.line.is_done


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
        self.grace = _grace(ends - time.monotonic())
        self.mebibytes = mebibytes
        self.only = only
        self.said: Said = SimpleQueue()
        self.lines = [_Line(a) for a in asked]
        self.places: list[_Place] = []
        for line in self.lines:
            parts: list[tuple[Part, bool | None]] = [(p, None) for p in line.asked.parts]
            for which, (part, hint) in enumerate([*parts, *line.asked.hints]):
                self.places.append(_Place(line, part, which, hint))
        self.home: Home | None = None
        self.home_number = -1
        self.drained_number = -2
        self.diagrams: dict[int, Diagrams] = {}
        self.fitting: dict[int, tuple[Tables, bool]] = {}
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

    def _ask_for(self, line: _Line) -> None:
        """What a formula wants to know, as far as it was not asked before."""
        assert line.temporal is not None
        for wanted in line.temporal.wanted:
            if wanted not in line.asked_for:
                line.asked_for.add(wanted)
                self._add(line, line.temporal, wanted)
        for place in self.places:
            if place.line is line and place.question is not None and not place.is_open:
                place.question.is_done = True

    def _add(self, line: _Line, temporal: Temporal, wanted: Wanted) -> None:
        if self.is_uncoloured and isinstance(wanted, Whole):
            if path_of(wanted.formula) is not None:
                self.places.append(_Place(line, Part("path", ""), 0, wanted=wanted))
            return
        try:
            kind = "reach" if isinstance(wanted, Reach) else temporal.kind
            part = Part(kind, temporal.text(wanted))
        except (FormulaError, TooLargeError) as error:
            if not wanted.is_side:
                line.why_not = str(error) or "its automaton is too large"
            return
        place = _Place(line, part, 0, wanted=wanted)
        self.places.append(place)
        if _is_drained(place):
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

    def _followed(self, number: int, place: _Place) -> Sought:
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
                open_ = [n for n in open_ if not (self._is_side(n) and self._is_whole(n))]
            if number > len(_ROUNDS_S):  # only what has come since
                open_ = [n for n in open_ if n >= self.given]
            if not open_ or left < _LEAST_S or self.only == "structure":
                break
            if not self._fits(self.tables):  # equations and reductions have no limit
                break
            self.given = len(self.places)
            length = min(left, _ROUNDS_S[number]) if number < len(_ROUNDS_S) else left
            lanes = self._lanes(open_, number, length)
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
            is_asked = self.only != "structure" and self._fits(self.tables)
            if len(self.places) > self.given and is_asked:
                yield from self.rounds()
                return

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

    def _finished(self, line: _Line) -> Iterator[Result]:
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

    def _at_most(self, place: _Place, value: int) -> int | None:
        """Without colours places hold at most that; what they hold, if that is known now."""
        assert place.question is not None
        place.question.is_done = False
        return place.question.learn(most=value)

    def _learn(self, line: _Line, wanted: Wanted, value: bool, method: str) -> None:
        """Put an answer into a formula."""
        assert line.temporal is not None
        before = line.temporal.formula
        is_turned = isinstance(wanted, Whole) and line.temporal.kind == "ltl"
        line.temporal.learn(wanted, value != is_turned)
        if line.temporal.formula != before:
            line.techniques.update(method.split())
        self._ask_for(line)

    # --- what the engine is asked ----------------------------------------------------------------

    def _lanes(self, open_: list[int], number: int, length: float) -> list[Iterator[Task]]:
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
                mine = [n for n in mine if not _is_drained(self.places[n])]
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
        weights = [1.0 if all(map(self._is_side, numbers)) else _WEIGHT for _, numbers in tasks]
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
                        yield from self._drawn(task, net, texts, which)
                    else:
                        yield replace(task, method=method, text=net.text([*texts.values()]))

    def _is_side(self, number: int) -> bool:
        """Whether a question is only asked since its answer would help with another one."""
        wanted = self.places[number].wanted
        return wanted is not None and wanted.is_side

    def _is_whole(self, number: int) -> bool:
        return isinstance(self.places[number].wanted, Whole)

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
        is_told = all(map(self._fits, nets.values())) and not any(
            map(_too_large, asked_of.values())
        )
        if len(smaller) < len(numbers) or len(nets) != 1 or not is_told:
            tables, added, technique = self.tables, dict[int, int](), ""
            texts = {n: f"{n} {self.places[n].part.text}" for n in numbers}
        else:
            (tables,) = nets.values()
            added = {n: s.added for n, (_, s) in smaller.items()}
            technique = REDUCTION
            texts = asked_of
        return Task("", "", 0.0, 0, added=added, technique=technique), tables, texts

    def _fits(self, tables: Tables) -> bool:
        """Whether the engine can read a net; the answer is kept with the net, so that no other one gets its id."""
        if id(tables) not in self.fitting:
            self.fitting[id(tables)] = tables, tables.fits()
        return self.fitting[id(tables)][1]


def _is_drained(place: _Place) -> bool:
    """Whether a question is about drained markings: only equations and diagrams are asked, as searches see it all."""
    return isinstance(place.wanted, Reach) and place.wanted.is_drained


def _grace(seconds: float) -> float:
    """How long after the end of so much time a process is waited for."""
    return max(0.0, min(_GRACE_S, _GRACE * seconds))


def _too_large(question: str) -> bool:
    """Whether a question about a reduced net has a factor that the engine does not read."""
    return any(int(number) > MOST for number in re.findall(r"\d{10,}", question))


def _until(ends: float, tasks: Iterable[Task]) -> Iterator[Task]:
    """None of them goes on after the end, however long it took to make them."""
    for task in tasks:
        left = ends - time.monotonic()
        if left > 0:
            yield replace(task, seconds=min(task.seconds, left))


def space(
    program: Path, tables: Tables, *, seconds: float, mebibytes: int, only: str = ""
) -> Space | None:
    """The sizes of the state space, if it can be seen to its end: counted, and with diagrams, side by side."""
    if not tables.fits():
        return None
    ends = time.monotonic() + seconds
    lanes: list[Iterable[Task]] = []
    if only in ("", "explore"):
        lanes.append(Task("count", tables.text([]), seconds, mebibytes // 3) for _ in range(1))
    if only in ("", METHOD):
        lanes += Diagrams(tables).sizes(seconds, mebibytes // 3)
    for found in ask(program, [_until(ends, lane) for lane in lanes], until=ends + _grace(seconds)):
        if isinstance(found, Space):
            return found
    return None
