"""The search for a placing: differential evolution over the numbers that are free, and what it has seen.

    found = Search(judge, Wish("condition"), seed=1).run()
    found.best, found.front           # candidates; None, (): no placing reaches everything and touches nothing

Storn and Price, Differential Evolution, Journal of Global Optimization 11 (1997), as SciPy has it. The same seed gives
the same answer.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from scipy.optimize import differential_evolution

from pn2code.base.deadline import NEVER, Deadline, TimeIsOverError
from pn2code.base.frozen import frozen
from pn2code.geometry.placing.free import DIGITS, Free, bounds_of, rounded
from pn2code.geometry.placing.judging import Judge, Values
from pn2code.robot.transforms import Array

Goal = Literal["condition", "limit", "clearance", "time"]
_PEOPLE, _LEAST_PEOPLE = 8, 20
"""Candidates of a generation: so many for each number that is free, at least so many."""
_UNREACHED = 1e6
_UNWANTED = 1e4
_TOLD = np.array([0.1, 1e-3, 1e-4, 0.1])
"""What is less in conditioning, limits (rad), clearances (m) and seconds is no difference."""
_PATIENCE, _WORTHWHILE = 6, 0.02
"""It ends if so many generations have made the best one better by less than this part."""
_LITTLE = 1e-3
"""What all that is not the goal counts."""


@frozen
class Wish:
    """What is wanted of a placing.

    Args:
        goal: what shall be as good as it can be.
        condition: the condition number may not be worse than this.
        limit: rad, the margin of a limit may not be less.
        clearance: m, no less.
    """

    goal: Goal = "condition"
    condition: float = math.inf
    limit: float = 0.0
    clearance: float = 0.0


@frozen
class Candidate:
    """A placing that was looked at.

    Args:
        values: of the numbers that are free, as they would be written.
        reach: the part of the task that is reached, 0 to 1.
        condition, limit (rad), clearance (m), seconds: of all that is done, if it was walked.
        done: the part of the commands that could be planned.
        meets: whether it reaches and does everything, as wished.
    """

    values: tuple[float, ...]
    reach: float
    condition: float
    limit: float = math.inf
    clearance: float = -math.inf
    done: float = 0.0
    seconds: float = math.inf
    is_walked: bool = False
    meets: bool = False

    def good(self, goal: Goal) -> float:
        """What the goal counts; less is better."""
        return {
            "condition": self.condition,
            "limit": -self.limit,
            "clearance": -self.clearance,
            "time": self.seconds,
        }[goal]

    @property
    def badness(self) -> tuple[float, float, float, float]:
        """All that counts; less is better."""
        return (self.condition, -self.limit, -self.clearance, self.seconds)


@frozen(eq=False)
class Found:
    """What a search has found.

    Args:
        here: as it stands.
        ranked: those that meet the wish, the best first.
        nearest: the one that reaches most; unlike `here` it may be worse in all else.
        looked: how many placings were looked at.
    """

    here: Candidate
    ranked: tuple[Candidate, ...]
    nearest: Candidate
    looked: int

    @property
    def front(self) -> tuple[Candidate, ...]:
        """Those than which no other one is better in everything (Pareto), by conditioning."""
        return front_of(self.ranked)


def front_of(candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Of some candidates those that no other one beats in one thing without being worse in another."""
    rows = np.round(np.array([c.badness for c in candidates]).reshape(-1, 4) / _TOLD)
    out: list[Candidate] = []
    kept: set[tuple[float, ...]] = set()
    for i, row in enumerate(rows):
        no_worse = (rows <= row).all(axis=1)
        better = (rows < row).any(axis=1)
        key = tuple(row.tolist())
        if not (no_worse & better).any() and key not in kept:
            kept.add(key)
            out.append(candidates[i])
    return tuple(sorted(out, key=lambda c: c.badness))


class Search:
    """One search.

    Args:
        judge: looks at placings.
        wish: what is wanted.
        generations: at most so many.
        stage: hears in words how far it is.
        deadline: when it ends with what it has found, which `is_unfinished` then says.
    """

    def __init__(
        self,
        judge: Judge,
        wish: Wish,
        *,
        seed: int = 1,
        generations: int = 50,
        stage: Callable[[str], None] = lambda _text: None,
        deadline: Deadline = NEVER,
    ) -> None:
        self.judge, self.wish, self._deadline = judge, wish, deadline
        self.is_unfinished = False
        self._seed, self._generations, self._stage = seed, generations, stage
        self._seen: dict[tuple[float, ...], Candidate] = {}

    def run(self) -> Found:
        """Searches."""
        free = self.judge.free
        here_values = np.array([[f.here for f in free]])
        here = self._here(here_values)
        bounds = bounds_of(free)
        start = np.clip(here_values[0], *bounds.T)
        people = max(_LEAST_PEOPLE, _PEOPLE * len(free))

        def scored(columns: Array) -> Array:
            return np.array([self._score(c) for c in self._candidates(columns.T)])

        best: list[float] = []

        def told(_best: Array, convergence: float = 0.0) -> bool:
            """Whether it is enough."""
            best.append(min(map(self._score, self._seen.values())))
            self._stage(f"searching, generation {len(best)} of {self._generations} ...")
            if len(best) <= _PATIENCE:
                return False
            before = best[-1 - _PATIENCE]
            return before - best[-1] < _WORTHWHILE * abs(before)

        try:
            with self._deadline.enforced():
                differential_evolution(
                    scored,
                    [tuple(b) for b in bounds],
                    init=_first(bounds, start, people, self._seed),
                    maxiter=self._generations,
                    tol=1e-3,
                    rng=self._seed,
                    polish=False,
                    updating="deferred",
                    vectorized=True,
                    callback=told,
                )
        except TimeIsOverError:
            self.is_unfinished = True
        seen = list(self._seen.values()) or [here]
        goal = self.wish.goal
        meeting = sorted(
            (c for c in seen if c.meets), key=lambda c: (c.good(goal), c.badness, c.values)
        )
        nearest = min(seen, key=lambda c: (-c.reach, c.badness, c.values))
        return Found(here, tuple(meeting), nearest, len(seen))

    def none(self) -> Found:
        """Nothing but how it stands, where searching is of no use."""
        here = self._here(np.array([[f.here for f in self.judge.free]]))
        return Found(here, (), here, 1)

    def _here(self, values: Array) -> Candidate:
        """As the arms stand: walked, whether it is as wished or not."""
        here = self._candidates(values)[0]
        low, high = bounds_of(self.judge.free).T
        if not (low <= values[0]).all() or not (values[0] <= high).all():
            # It is not among those that may be chosen.
            self._seen.clear()
            self.judge.forget()
        return here if here.is_walked else self._walked(here)

    def _candidates(self, values: Array) -> list[Candidate]:
        """Of rows of values, as they would be written; each is looked at once."""
        keys = [rounded(self.judge.free, row) for row in values]
        new = list(dict.fromkeys(k for k in keys if k not in self._seen))
        if new:
            found = self.judge.look(np.array(new))
            for i, key in enumerate(new):
                self._seen[key] = self._candidate(key, found, i)
        return [self._seen[k] for k in keys]

    def _candidate(self, key: tuple[float, ...], found: Values, i: int) -> Candidate:
        reach, condition = float(found.reach[i]), float(found.condition[i])
        c = Candidate(key, reach, condition)
        # A walk takes longest, and nothing on it is better than what is known already.
        return self._walked(c) if reach >= 1.0 and self._off(c) <= 0.0 else c

    def _walked(self, c: Candidate) -> Candidate:
        walk = self.judge.walk(c.values, self.wish.clearance)
        out = replace(
            c,
            condition=max(c.condition, walk.condition),
            limit=min(c.limit, walk.limit),
            clearance=walk.clearance,
            done=walk.done,
            seconds=walk.seconds,
            is_walked=True,
        )
        is_wished = self._off(out) <= 0.0 and walk.clearance >= self.wish.clearance
        meets = c.reach >= 1.0 and walk.done >= 1.0 and walk.clearance > 0.0 and is_wished
        return replace(out, meets=meets)

    def _off(self, c: Candidate) -> float:
        """How far conditioning and limits are from what is wished; 0: they are as wished."""
        worse = math.log(max(1.0, c.condition / self.wish.condition))
        return worse + max(0.0, self.wish.limit - c.limit)

    def _score(self, c: Candidate) -> float:
        """Less is better: first all is reached, then all is done, then all is as wished, then the goal."""
        if c.reach < 1.0:
            return _UNREACHED * (2.0 - c.reach)
        off = self._off(c)
        if not c.is_walked:
            return _UNWANTED * (5.0 + off)
        if c.done < 1.0:
            return _UNWANTED * (4.0 - c.done)
        if not c.meets:
            near = min(1.0, max(0.0, self.wish.clearance - c.clearance))
            return _UNWANTED * (1.0 + near + min(1.0, off))
        # What the goal leaves open: often HOME has the worst conditioning, from wherever.
        more = (c.condition / 100.0, -c.limit, -c.clearance, c.seconds / 1000.0)
        return c.good(self.wish.goal) + _LITTLE * sum(more)


def _first(bounds: Array, here: Array, people: int, seed: int) -> Array:
    """The first generation: where the arms stand, some near there, the others anywhere."""
    choice = np.random.default_rng(seed)
    wide = bounds[:, 1] - bounds[:, 0]
    anywhere = bounds[:, 0] + wide * choice.random((people, len(wide)))
    near = here + 0.1 * wide * choice.standard_normal((people // 4, len(wide)))
    anywhere[1 : 1 + len(near)] = np.clip(near, *bounds.T)
    anywhere[0] = here
    return np.asarray(anywhere)


def unlike(ranked: Sequence[Candidate], free: Sequence[Free], least: float) -> list[Candidate]:
    """Candidates in their order, without those that are near an earlier one.

    Args:
        least: how far apart they are in some number, in the units in which it is written (mm, tenths of a degree).
    """
    units = np.array([10.0 ** DIGITS[f.unit] for f in free])
    out: list[Candidate] = []
    for c in ranked:
        own = np.array(c.values)
        if all((np.abs(own - o.values) * units).max() >= least for o in out):
            out.append(c)
    return out
