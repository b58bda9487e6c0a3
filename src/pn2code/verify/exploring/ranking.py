"""Weights of places that show that transitions of a net occur only so often, whatever the order.

    ranking = Ranking.of(net, storage, bounds)      # bounds: by place, most tokens, where that is proven
    ranking.rising()                                # transitions of which this is not shown
    ranking.longest(steps, counted)                 # most occurrences of `counted` in a run of `steps`; None: unknown

If a weighted number of tokens `y * m` never grows and is never smaller than some number, a transition that makes it
smaller occurs only so often. Weights of places with a bound may be negative, others may not, so there is such a number
(linear ranking functions: A. Podelski, A. Rybalchenko, *A complete method for the synthesis of linear ranking
functions*, 2004; for nets G. Memmi, G. Roucairol, *Linear algebra in net theory*, 1980). What is shown to occur only
so often does not matter for the next weights: after its last occurrence only the others go on. The weights come from
linear programs in floating point, are made rational, and are multiplied out exactly; where that fails, nothing is said.

In a run of some steps `y * m` changes by no more than its greatest value less its least one, which bounds of places
limit. If each step that counts makes it smaller by 1 or more, and no step greater, so many count at most.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from math import floor
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.structure.analysis import start_of
from pn2code.structure.skeleton import Mode, skeleton
from pn2code.structure.symbolic import Symbolic

_DENOMINATORS = (1, 60, 2_520, 1_000_000)
_NOTHING = 1e-9
Weights = Mapping[int, Fraction]
"""By place; what is not there has none."""


@frozen
class Ranking:
    """What is known of a net.

    Args:
        modes: what its transitions change, but for those that never occur.
        weighed: places of which all changes are known exactly; others have no weight.
        upper: by place, most tokens.
    """

    modes: tuple[Mode, ...]
    weighed: tuple[int, ...]
    upper: Mapping[int, int]

    @staticmethod
    def of(
        net: FlatNet,
        storage: Mapping[str, str],
        bounds: Mapping[int, int],
        never: Collection[int] = (),
    ) -> Ranking:
        """Of a net; `never`: transitions that never occur."""
        begin = start_of(net, storage, ())
        skel = skeleton(net, Symbolic(net, begin.evaluator))
        out = {*never, *skel.never}
        modes = tuple(m for m in skel.modes if m.transition not in out)
        unclear = {*skel.resets, *(p for m in modes for p in m.unknown)}
        weighed = tuple(p for p in range(len(net.places)) if p not in unclear)
        return Ranking(modes, weighed, bounds)

    def rising(self) -> frozenset[int]:
        """Transitions of which it is not shown that they occur only so often."""
        left = {m.transition for m in self.modes}
        while left:
            falling = self._falling(left)
            if not falling:
                break
            left -= falling
        return frozenset(left)

    def _falling(self, among: Collection[int]) -> frozenset[int]:
        """Those that make a sum smaller which none of `among` makes greater."""
        modes = [m for m in self.modes if m.transition in among]
        order = {t: i for i, t in enumerate(sorted(among))}
        goal = [0.0] * (2 * len(self.weighed)) + [-1.0] * len(order)
        limits = [*self._limits(), *((0.0, 1.0) for _ in order)]
        rows = ((*self._row(m), (2 * len(self.weighed) + order[m.transition], 1)) for m in modes)
        for weights in self._solved(goal, list(rows), [0.0] * len(modes), limits):
            changes = [(m.transition, _change(weights, m)) for m in modes]
            if all(change <= 0 for _, change in changes):
                return frozenset(among) - {t for t, change in changes if change == 0}
        return frozenset()

    def longest(self, steps: Collection[int], counted: Collection[int]) -> int | None:
        """Most occurrences of `counted` in a run of nothing but `steps`, from any reachable marking."""
        modes = [m for m in self.modes if m.transition in steps]
        goal = [float(self.upper.get(p, 0)) for p in (*self.weighed, *self.weighed)]
        limits = [(0.0, None if p in self.upper else 0.0) for p in (*self.weighed, *self.weighed)]
        most = [-1.0 if m.transition in counted else 0.0 for m in modes]
        for weights in self._solved(goal, [self._row(m) for m in modes], most, limits):
            is_shown = all(
                _change(weights, m) <= (-1 if m.transition in counted else 0) for m in modes
            )
            if is_shown:
                return floor(sum(abs(w) * self.upper[p] for p, w in weights.items()))
        return None

    def _limits(self) -> list[tuple[float, float | None]]:
        """Of the weights: of the positive parts, then of the negative ones."""
        positive: list[tuple[float, float | None]] = [(0.0, None) for _ in self.weighed]
        return positive + [(0.0, None if p in self.upper else 0.0) for p in self.weighed]

    def _row(self, mode: Mode) -> tuple[tuple[int, int], ...]:
        count = len(self.weighed)
        own = [(i, mode.delta.get(p, 0)) for i, p in enumerate(self.weighed) if p in mode.delta]
        return (*own, *((count + i, -n) for i, n in own))

    def _solved(
        self,
        goal: Sequence[float],
        rows: Sequence[Sequence[tuple[int, int]]],
        most: Sequence[float],
        limits: Sequence[tuple[float, float | None]],
    ) -> Iterator[Weights]:
        """Weights that make the goal small, made rational in several ways; `rows * x <= most`."""
        from scipy.optimize import linprog  # takes a third of a second to load
        from scipy.sparse import csr_array

        entries = [(k, i, n) for k, row in enumerate(rows) for i, n in row if n]
        if not entries:
            if all(m >= 0 for m in most):
                yield {}
            return
        at = ([k for k, _, _ in entries], [i for _, i, _ in entries])
        matrix: Any = csr_array(([n for *_, n in entries], at), shape=(len(rows), len(goal)))
        found = linprog(goal, A_ub=matrix, b_ub=most, bounds=limits, method="highs")
        if found.x is None:
            return
        count = len(self.weighed)
        for denominator in _DENOMINATORS:
            weights: dict[int, Fraction] = {}
            for i, p in enumerate(self.weighed):
                value = float(found.x[i] - found.x[count + i])
                if abs(value) > _NOTHING:
                    weights[p] = Fraction(value).limit_denominator(denominator)
            yield {p: w for p, w in weights.items() if w}


def _change(weights: Weights, mode: Mode) -> Fraction:
    return sum((weights[p] * n for p, n in mode.delta.items() if p in weights), Fraction(0))
