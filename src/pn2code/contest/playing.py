"""Random runs of a coloured net by its token game, for what is too large to be unfolded.

    play = Play(net, tables, open_, said, ends)    # beside other methods; `open_` gives what is still asked
    play.start()

A marking that is seen is reachable, so that each answer is final: a condition holds in it, it is dead, or places hold
so many tokens together. Only the numbers of tokens and the transitions that are enabled are looked at.
"""

from __future__ import annotations

import random
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from itertools import islice

from pn2code.base.frozen import frozen
from pn2code.contest.engine import Answer, Said
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth
from pn2code.contest.paths import Followed, next_value, path_of
from pn2code.contest.tables import Tables
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.errors import GameError
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import MlException, MlLimit

TECHNIQUE = "COLOURED_WALK"
_STEPS = 200
"""Of the first run; each one is longer than the one before."""
_LONGEST = 1_000_000
_LONGER = 1.5
_MOST_FIRST = 1000
"""Markings after the initial one that are looked at."""
_CHOICES = 4
"""Bindings of a transition of which one is drawn."""
_RAISED = (GameError, MlException, MlLimit)


@frozen
class Observation:
    """What is seen of a marking.

    Args:
        tokens: by place of the file.
        enabled: ids of transitions.
    """

    tokens: tuple[int, ...]
    enabled: frozenset[str]


@frozen
class Sought:
    """An open question.

    Args:
        number: of the question.
        holds: whether a marking is what is sought; None for a bound.
        sum: of a bound.
        followed: a formula of paths.
        is_linear: it is one of linear time: the opposite of its value is the answer.
    """

    number: int
    holds: Callable[[Observation], bool] | None
    sum: tuple[tuple[int, int], ...] = ()
    followed: Followed | None = None
    is_linear: bool = False


class Play(threading.Thread):
    """The runs, until the time is over.

    Args:
        game: of the net; nobody else uses it, and the thread may do so for some time after its end.
        open_: what is still asked.
        said: where the answers go.
        ends: when to stop, on the monotonic clock.
        seed: of what is drawn.
    """

    def __init__(
        self,
        game: Game,
        open_: Callable[[], Iterable[Sought]],
        said: Said,
        ends: float,
        seed: int = 1,
    ) -> None:
        super().__init__(daemon=True)
        self.game = game
        self.open = open_
        self.said = said
        self.ends = ends
        self.draw = random.Random(seed)
        self.is_over = threading.Event()
        self.most: dict[int, int] = {}
        self.runs = 0
        self.first: list[Observation] = []
        self.has_looked_first = False
        self.is_first_whole = False
        self.seen_first: set[int] = set()

    def run(self) -> None:
        """Run after run."""
        try:
            steps, is_even = float(_STEPS), False
            while self._goes_on():
                self.play(int(steps), is_even=is_even)
                steps, is_even = min(_LONGEST, steps * _LONGER), not is_even
        except Exception as error:  # it belongs to the one who waits
            self.said.put(error)

    def end(self) -> None:
        """Stop at the next step."""
        self.is_over.set()

    def _goes_on(self) -> bool:
        return not self.is_over.is_set() and time.monotonic() < self.ends

    def play(self, steps: int, *, is_even: bool) -> None:
        """One run; if it `is_even`, of the enabled transitions one that has occurred least is taken."""
        marking: Marking = self.game.own_initial_marking
        count: Counter[int] = Counter()
        self.runs += 1
        for at in range(steps):
            if not self._goes_on():
                return
            try:
                enabled = self.game.enabled_transitions(marking)
                self._look(self._observed(marking, enabled), at)
                if not enabled:
                    return
                self.draw.shuffle(enabled)
                t = min(enabled, key=lambda t: count[t.index]) if is_even else enabled[0]
                count[t.index] += 1
                some = islice(
                    self.game.enabling.enabled(t, marking), self.draw.randint(1, _CHOICES)
                )
                element = BindingElement.make(t, self.draw.choice(list(some)))
                marking, _ = self.game.occur(marking, element)
            except _RAISED:  # what raises an exception leads nowhere
                return

    @staticmethod
    def _observed(marking: Marking, enabled: list[FlatTransition]) -> Observation:
        return Observation(tuple(map(len, marking.places)), frozenset(t.id for t in enabled))

    def _look(self, seen: Observation, at: int) -> None:
        for sought in self.open():
            n = sought.number
            if sought.followed is not None:
                value = self._followed(sought, sought.followed, seen, at)
                if value is not None:
                    self.said.put(Answer(n, value != sought.is_linear, True, TECHNIQUE))
            elif sought.holds is None:
                total = sum(k * seen.tokens[p] for p, k in sought.sum)
                if total > self.most.get(n, -1):
                    self.most[n] = total
                    self.said.put(Answer(n, total, False, TECHNIQUE))
            elif sought.holds(seen):
                self.said.put(Answer(n, True, True, TECHNIQUE))

    def _followed(self, sought: Sought, f: Followed, seen: Observation, at: int) -> bool | None:
        if not f.path.is_next:
            return f.on(self.runs, at, seen, is_last=not seen.enabled)
        if at or sought.number in self.seen_first:
            return None
        self.seen_first.add(sought.number)
        if not self.has_looked_first:
            self.has_looked_first = True
            self._look_first()
        # What follows a dead marking: nothing in branching time, in linear time itself.
        first = [seen] if sought.is_linear and not seen.enabled else self.first
        return next_value(f.path, f.reach, first, is_all=self.is_first_whole)

    def _look_first(self) -> None:
        """The markings after the initial one, if they are not too many; all of them, if nothing raises an exception."""
        marking = self.game.own_initial_marking
        is_whole = True
        with suppress(*_RAISED):
            for t in self.game.enabled_transitions(marking):
                for binding in self.game.enabling.enabled(t, marking):
                    if len(self.first) == _MOST_FIRST or not self._goes_on():
                        return
                    try:
                        after, _ = self.game.occur(marking, BindingElement.make(t, binding))
                    except _RAISED:
                        is_whole = False
                        continue
                    self.first.append(self._observed(after, self.game.enabled_transitions(after)))
            self.is_first_whole = is_whole


def follow(tables: Tables, f: Formula) -> Followed | None:
    """A formula of paths, to be followed along runs; None if it has not the form for that."""
    path = path_of(f)
    if path is None:
        return None
    return Followed(path, holds(tables, path.before), holds(tables, path.reach))


def holds(tables: Tables, f: Formula) -> Callable[[Observation], bool]:
    """A formula about one marking as a function of what is seen of it."""
    match f:
        case Truth(value):
            return lambda seen: value
        case Fireable(names):
            wanted = frozenset(names)
            return lambda seen: not wanted.isdisjoint(seen.enabled)
        case AtMost(left, right):
            a, b = _number(tables, left), _number(tables, right)
            return lambda seen: a(seen) <= b(seen)
        case Op("not", (part,)):
            inner = holds(tables, part)
            return lambda seen: not inner(seen)
        case Op("and" | "or" as operator, parts):
            found = [holds(tables, p) for p in parts]
            joined = all if operator == "and" else any
            return lambda seen: joined(h(seen) for h in found)
    raise ValueError(f"{f} is about more than one marking")


def _number(tables: Tables, side: Constant | Tokens) -> Callable[[Observation], int]:
    if isinstance(side, Constant):
        value = side.value
        return lambda seen: value
    places = [p for name in side.places for p in tables.places[name]]
    return lambda seen: sum(seen.tokens[p] for p in places)


def said_in_words(text: str, transitions: list[str]) -> Callable[[Observation], bool]:
    """The same for the questions of the examinations without formulas, in the engine's own words.

    Args:
        text: the question, after its number and kind.
        transitions: ids, by number.
    """
    if text == "dead":
        return lambda seen: not seen.enabled
    value, rest = _read(text.split(), transitions)
    assert not rest
    return value


def _read(
    words: list[str], transitions: list[str]
) -> tuple[Callable[[Observation], bool], list[str]]:
    word, words = words[0], words[1:]
    if word == "not":
        inner, words = _read(words, transitions)
        return (lambda seen: not inner(seen)), words
    n, words = int(words[0]), words[1:]
    if word == "enabled":
        wanted = frozenset(transitions[int(t)] for t in words[:n])
        return (lambda seen: not wanted.isdisjoint(seen.enabled)), words[n:]
    if word == "sum":
        terms = [(int(words[2 * i]), int(words[2 * i + 1])) for i in range(n)]
        limit = int(words[2 * n])
        return (lambda seen: sum(k * seen.tokens[p] for p, k in terms) <= limit), words[2 * n + 1 :]
    found = []
    for _ in range(n):
        part, words = _read(words, transitions)
        found.append(part)
    joined = {"and": all, "or": any}[word]
    return (lambda seen: joined(h(seen) for h in found)), words
