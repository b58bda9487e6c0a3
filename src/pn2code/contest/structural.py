"""Answers from the structure of the net, without its markings: reductions for each question, then the state equation.

    structural = Structural(tables, questions, said)
    structural.start()                # beside the engine, which takes the reduced nets as soon as they are there
    structural.end()

First all questions together reduce the net, then each one reduces it further. What is left is asked of the state
equation, with more and more time.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.contest import conditions
from pn2code.contest.conditions import FALSE, TRUE, AtMost, Condition, Dead, TooLargeError
from pn2code.contest.engine import Answer, Said
from pn2code.contest.equation import StateEquation
from pn2code.contest.examinations import Part
from pn2code.contest.formulas import Formula
from pn2code.contest.reduction.reduce import Reduced, reduced_for
from pn2code.contest.stepwise import smaller_for
from pn2code.contest.tables import Tables

REDUCTION = "STRUCTURAL_REDUCTION"
EQUATION = "STATE_EQUATION"
_PASSES_S = (0.3, 1.0, 4.0, 15.0, 60.0, 600.0)
"""Time of the state equation for a question, in one pass after the other."""
_FEW = 40
"""So many questions are reduced one by one even if that takes long."""
_IN_VAIN = 4
"""After so many questions in turn for which a large net became hardly smaller the others are not tried."""
_HARDLY = 0.95
_LEAST_S = 0.1
_PAUSE_S = 0.1
_LOOKS = 3
"""Between two looks for questions that have come later, and how many there are if nobody else answers any."""


@record
class Smaller:
    """A question about a reduced net.

    Args:
        tables: the net.
        condition: the question; of a bound its sum.
        added: of a bound: what is added to it.
        equation: of the net, once it was asked.
        guide: how often transitions may occur on the way to the condition; {}: there is no guess.
        tried: of a bound: the number that the equation could not prove.
        words: a formula of time as a question about the net; the condition is of no use then.
    """

    tables: Tables
    condition: Condition
    added: int = 0
    equation: StateEquation | None = None
    guide: dict[int, int] = field(default_factory=dict)
    tried: int | None = None
    words: str = ""

    def text(self, kind: str) -> str:
        """The question in the engine's own words, without its number."""
        if self.words:
            return self.words
        text = f"{kind} {conditions.text(self.condition)}"
        if not self.guide:
            return text
        steps = " ".join(f"{t} {n}" for t, n in self.guide.items())
        return f"guided {len(self.guide)} {steps} {text}"


@record
class Question:
    """A question about reachability, a bound or a formula of time, with what is known.

    Args:
        number: of the question.
        kind: "reach", "bound", "ctl" or "ltl".
        condition: what is to be reached; of a bound its sum.
        formula: of time; the condition is of no use then.
        is_side: it only helps with another one.
        least: a number that the sum reaches.
        most: one that it never exceeds.
        smaller: the question about a reduced net, once there is one.
    """

    number: int
    kind: str
    condition: Condition
    least: int | None = None
    most: int | None = None
    is_done: bool = False
    smaller: Smaller | None = None
    lock: threading.Lock = field(default_factory=threading.Lock)
    formula: Formula | None = None
    is_side: bool = False

    def learn(self, least: int | None = None, most: int | None = None) -> int | None:
        """A bound is at least or at most that; the bound, if it is known now."""
        with self.lock:
            if least is not None and (self.least is None or least > self.least):
                self.least = least
            if most is not None and (self.most is None or most < self.most):
                self.most = most
            if self.least is not None and self.most is not None:
                if self.least > self.most:
                    raise RuntimeError(f"a bound is at most {self.most} and at least {self.least}")
                if self.least == self.most and not self.is_done:
                    return self.least
        return None


def question(number: int, part: Part, tables: Tables) -> Question | None:
    """A part as a question; None if it is of another kind or too large."""
    if part.kind not in ("reach", "bound"):
        return None
    words = part.text.split(" ", 1)[1]
    if len(words) > conditions.MOST_CHARACTERS:
        return None
    try:
        if part.kind == "reach":
            return Question(number, "reach", conditions.parsed(words, tables.pre))
        sum_ = AtMost(terms(words), 0)
    except TooLargeError:
        return None
    least = sum(n * tables.initial[p] for p, n in sum_.factors)
    return Question(number, "bound", sum_, least)


def terms(words: str) -> tuple[tuple[int, int], ...]:
    """The terms of `sum N (place factor).. limit`."""
    numbers = list(map(int, words.split()[2:-1]))
    return tuple(zip(numbers[::2], numbers[1::2], strict=True))


class Structural(threading.Thread):
    """The structural methods, beside others.

    Args:
        tables: the net.
        questions: that are asked.
        said: where the answers go.
        ends: when to stop, on the monotonic clock.
        goes_on: whether questions may come later, when others are answered.
        waits: and that at any time, since other methods answer some.
    """

    def __init__(
        self,
        tables: Tables,
        questions: Sequence[Question],
        said: Said,
        ends: float,
        *,
        goes_on: bool = False,
        waits: bool = False,
    ) -> None:
        super().__init__(daemon=True)
        self.tables = tables
        self.questions = list(questions)
        self.said = said
        self.ends = ends
        self.goes_on = goes_on
        self.waits = waits
        self.is_over = threading.Event()
        self.equations: dict[int, StateEquation] = {}
        self.seen: set[int] = set()
        self.exhausted: set[int] = set()
        self.later = 1 + max((q.number for q in questions), default=-1)

    def run(self) -> None:
        """All steps, until the time is over."""
        try:
            self._reduce_temporal()
            self._reduce_all()
            self._equations()
            self._later()
        except _OverError:
            return
        except Exception as error:  # it belongs to the one who waits
            self.said.put(error)

    def end(self) -> None:
        """Stop at the next step; a linear program may still be solved (`wait_for_solver`)."""
        self.is_over.set()

    def _left(self) -> float:
        left = self.ends - time.monotonic()
        if self.is_over.is_set() or left < _LEAST_S:
            raise _OverError
        return left

    def add(self, q: Question) -> None:
        """One more question."""
        self.questions.append(q)

    def _open(self) -> list[Question]:
        self._left()
        return [q for q in self.questions if not q.is_done and q.formula is None]

    def _say(self, q: Question, value: bool | int, method: str) -> None:
        q.is_done = True
        self.said.put(Answer(q.number, value, True, method))

    # --- reductions ------------------------------------------------------------------------------

    def _reduce_temporal(self) -> None:
        """The net for each formula of time, in a third of the time."""
        new = [q for q in list(self.questions) if q.number not in self.seen]
        self.seen.update(q.number for q in new if q.is_done)
        still = [q for q in new if not q.is_done and q.formula is not None]
        still.sort(key=lambda q: q.is_side)
        ends = time.monotonic() + self._left() / 3
        for i, q in enumerate(still):
            self._left()
            now = time.monotonic()
            self.seen.add(q.number)
            if q.is_done or now > ends or q.formula is None:
                continue
            until = now + (ends - now) / (len(still) - i)
            found = smaller_for(self.tables, q.kind, q.formula, until=until)
            if found is not None:
                q.smaller = Smaller(found[0], TRUE, words=found[1])

    def _reduce_all(self) -> None:
        """The net for all questions, then for each of them."""
        for q in self._open():
            if isinstance(q.condition, Dead):
                self._reduce(q, self.tables, q.condition, self._left() / 3)
        others = [q for q in self._open() if not isinstance(q.condition, Dead)]
        if not others:
            return
        began = time.monotonic()
        shared = reduced_for(
            self.tables, [q.condition for q in others], until=began + self._left() / 4
        )
        took = time.monotonic() - began
        for q in others:
            self._note(q, shared, q.condition)
        still = [q for q in self._open() if not isinstance(q.condition, Dead)]
        if took * len(still) > 1.0:
            self._pass(_PASSES_S[0])
        if len(still) > _FEW and took * len(still) > self._left() / 3:
            return
        in_vain = 0
        for i, q in enumerate(still):
            if took * (len(still) - i) > 1.0 and in_vain == _IN_VAIN:
                return
            if not q.is_done and q.smaller is not None:
                share = max(0.3, self._left() / (2 * (len(still) - i)))
                is_of_use = self._reduce(q, q.smaller.tables, q.smaller.condition, share)
                in_vain = 0 if is_of_use else in_vain + 1

    def _reduce(self, q: Question, tables: Tables, condition: Condition, seconds: float) -> bool:
        """The net for a question; False: that of others is hardly larger, and they keep it together."""
        reduced = reduced_for(tables, [condition], until=time.monotonic() + seconds)
        before = None if q.smaller is None else q.smaller.tables
        if before is tables and _is_hardly_smaller(reduced.tables, before):
            return False
        self._note(q, reduced, condition)
        return True

    def _note(self, q: Question, reduced: Reduced, condition: Condition) -> None:
        """Keep the reduced net, or answer if nothing is left to ask."""
        tables = reduced.tables
        if q.is_done:
            return
        if q.kind == "bound":
            assert isinstance(condition, AtMost)
            before = 0 if q.smaller is None else q.smaller.added
            sum_, more = reduced.sum(condition)
            q.smaller = Smaller(tables, sum_, before + more)
            if not sum_.factors or not tables.pre:
                self._say(q, sum_value(sum_, tables) + q.smaller.added, REDUCTION)
            return
        try:
            now = reduced.condition(condition)
        except TooLargeError:
            return
        q.smaller = Smaller(tables, now)
        value = _decided(now, tables)
        if value is not None:
            self._say(q, value, REDUCTION)

    # --- the state equation ----------------------------------------------------------------------

    def _equations(self) -> None:
        for seconds in _PASSES_S:
            self._pass(seconds)

    def _later(self) -> None:
        """Questions that come when others are answered."""
        looks = 0
        while self.goes_on and (self.waits or looks < _LOOKS):
            looks += 1
            if any(q.number not in self.seen for q in self.questions if q.number >= self.later):
                looks = 0
                self._reduce_temporal()
                self._equations()
            self._left()
            self.is_over.wait(_PAUSE_S)

    def _pass(self, seconds: float) -> None:
        for q in self._open():
            if q.is_done or q.number in self.exhausted:
                continue
            if q.number >= self.later and q.number not in self.seen:
                self.seen.add(q.number)
                self._reduce(q, self.tables, q.condition, self._left() / 8)
            if q.is_done or q.smaller is None:
                continue
            equation = self._equation(q.smaller)
            until = time.monotonic() + min(seconds, self._left())
            if self._is_exhausted(q, q.smaller, equation, until):
                self.exhausted.add(q.number)

    def _equation(self, smaller: Smaller) -> StateEquation:
        """That of a net, which is made once, however many questions it has."""
        if smaller.equation is None:
            key = id(smaller.tables)
            if key not in self.equations:
                self.equations[key] = StateEquation(smaller.tables, self.is_over)
            smaller.equation = self.equations[key]
        return smaller.equation

    def _is_exhausted(
        self, q: Question, smaller: Smaller, equation: StateEquation, until: float
    ) -> bool:
        """Ask the state equation; whether more time would not help."""
        if q.kind == "bound":
            return self._bounded(q, smaller, equation, until)
        if equation.excludes(smaller.condition, until) and not q.is_done:
            self._say(q, False, EQUATION)
        smaller.guide = equation.guide or smaller.guide
        return q.is_done or equation.is_exhausted

    def _bounded(
        self, q: Question, smaller: Smaller, equation: StateEquation, until: float
    ) -> bool:
        sum_ = smaller.condition
        assert isinstance(sum_, AtMost)
        if q.most is None:
            most = equation.bound(dict(sum_.factors), until)
            if most is None:
                return False
            self._learn(q, most + smaller.added)
        least = q.least
        if q.is_done or least is None or least == smaller.tried:
            return q.is_done
        more = conditions.at_most({p: -n for p, n in sum_.factors}, -(least - smaller.added + 1))
        if equation.excludes(more, until):
            self._learn(q, least)
        elif equation.is_exhausted:
            smaller.tried = least
        smaller.guide = equation.guide or smaller.guide
        return q.is_done

    def _learn(self, q: Question, most: int) -> None:
        value = q.learn(most=most)
        if value is not None:
            self._say(q, value, EQUATION)


class _OverError(Exception):
    """The time is over, or all is known."""


def sum_value(sum_: AtMost, tables: Tables) -> int:
    """A sum in the initial marking."""
    return sum(n * tables.initial[p] for p, n in sum_.factors)


def _is_hardly_smaller(now: Tables, before: Tables) -> bool:
    return bool(now.pre) and (
        len(now.initial) > _HARDLY * len(before.initial)
        and len(now.pre) > _HARDLY * len(before.pre)
    )


def _decided(condition: Condition, tables: Tables) -> bool | None:
    """The answer, if the net says it at once."""
    if isinstance(condition, Dead):
        if any(not pre for pre in tables.pre):
            return False
        return True if not any(_is_enabled(pre, tables) for pre in tables.pre) else None
    if condition in (TRUE, FALSE):
        return condition == TRUE
    if conditions.holds(condition, tables.initial):
        return True
    return None if tables.pre else False


def _is_enabled(pre: Mapping[int, int], tables: Tables) -> bool:
    return all(tables.initial[p] >= n for p, n in pre.items())
