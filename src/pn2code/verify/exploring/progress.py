"""A measure of progress: weights of places by which no occurrence ever makes a marking smaller.

    measure = Progress.of(net, storage, timed=True)
    measure.text()                     # what the explorer reads (`--sweep`)

    parts on the feeder 0, in the mill 1, on the pallet 2: each step of a part makes the sum greater by 1

Where markings are gone through in the order of such a sum, those with a smaller one than that at hand can be forgotten:
none of them comes back (S. Christensen, L. M. Kristensen, T. Mailund, *A sweep-line method for state space
exploration*, TACAS 2001). A weight may be negative, and places of which a change is not known exactly have none. The
weights come from a linear program: as many transitions as possible make the sum greater, none smaller. It is solved in
floating point; the weights are made whole numbers, and multiplied out exactly. In a net with a discrete clock the
model time is added, which never goes back.

No answer rests on that the measure is right: the explorer computes it in each marking that is new to it, and ends with
an error where one has a smaller measure than the marking at hand.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import gcd, lcm
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatNet
from pn2code.structure.analysis import start_of
from pn2code.structure.skeleton import Mode, skeleton
from pn2code.structure.symbolic import Symbolic

_DENOMINATORS = (1, 2, 6, 60, 2_520)
_NOTHING = 1e-7
_MOST_WEIGHT = 1 << 31
"""Greater weights are not used: the explorer adds them up in 64 bits."""


@frozen
class Progress:
    """Weights of places.

    Args:
        weights: by place, what a token counts; places that are not there count nothing.
        rising: transitions each occurrence of which makes the sum greater.
        by_time: whether the model time counts, too.
    """

    weights: Mapping[int, int]
    rising: frozenset[int]
    by_time: bool

    @staticmethod
    def of(net: FlatNet, storage: Mapping[str, str], *, timed: bool) -> Progress | None:
        """Of a net; None: no transition makes any sum greater.

        Args:
            net: the net.
            storage: as for `Game`.
            timed: whether markings have their times.

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        by_time = timed and net.timed and not net.real_time
        modes, weighed = _modes(net, storage)
        for weights in _candidates(modes, weighed):
            rising = rising_by(weights, modes)
            if rising:
                return Progress(weights, rising, by_time)
        return Progress({}, frozenset(), by_time) if by_time else None

    def names(self, net: FlatNet) -> str:
        """The sum for people: `Milled + 2 * Stowed + the time`."""
        terms = [(weight, net.places[p].name) for p, weight in sorted(self.weights.items())]
        texts = [
            f"{'-' if weight < 0 else '+'} {'' if abs(weight) == 1 else f'{abs(weight)} * '}{name}"
            for weight, name in terms
        ]
        said = " ".join([*texts, *(["+ the time"] if self.by_time else [])])
        return said.removeprefix("+ ")

    def text(self) -> str:
        """The table that the explorer reads: lines of a place and its weight; `time`, where that counts."""
        lines = [f"{place} {weight}" for place, weight in sorted(self.weights.items())]
        return "".join(f"{line}\n" for line in [*lines, *(["time"] if self.by_time else [])])


def _modes(net: FlatNet, storage: Mapping[str, str]) -> tuple[tuple[Mode, ...], tuple[int, ...]]:
    """What transitions change, and the places of which all changes are known exactly."""
    begin = start_of(net, storage, ())
    skel = skeleton(net, Symbolic(net, begin.evaluator))
    modes = tuple(m for m in skel.modes if m.transition not in skel.never)
    unclear = {*skel.resets, *(p for m in modes for p in m.unknown)}
    touched = {p for m in modes for p in m.delta}
    return modes, tuple(p for p in range(len(net.places)) if p in touched - unclear)


def rising_by(weights: Mapping[int, int], modes: Sequence[Mode]) -> frozenset[int]:
    """Transitions that make the sum greater in each of their modes; none at all if any mode makes it smaller."""
    changes = [
        (m.transition, sum(weights.get(p, 0) * n for p, n in m.delta.items())) for m in modes
    ]
    if any(change < 0 for _, change in changes):
        return frozenset()
    return frozenset(t for t, _ in changes) - {t for t, change in changes if change == 0}


def _candidates(modes: Sequence[Mode], weighed: Sequence[int]) -> Iterator[Mapping[int, int]]:
    """Whole weights that are perhaps right."""
    found = _solved(modes, weighed)
    for denominator in _DENOMINATORS if found else ():
        near = {
            p: Fraction(value).limit_denominator(denominator)
            for p, value in zip(weighed, found, strict=True)
            if abs(value) > _NOTHING
        }
        scale = lcm(*(w.denominator for w in near.values()))
        whole = {p: int(w * scale) for p, w in near.items() if w}
        common = gcd(*whole.values())
        if whole and max(map(abs, whole.values())) <= _MOST_WEIGHT * common:
            yield {p: w // common for p, w in whole.items()}


def _solved(modes: Sequence[Mode], weighed: Sequence[int]) -> Sequence[float]:
    """Weights with which as many transitions as possible make the sum greater by 1 or more, none smaller.

    Sums cannot be made much greater by some transitions to make up for others: of each only a change up to 1 counts.
    """
    from scipy.optimize import linprog  # takes a third of a second to load
    from scipy.sparse import csr_array

    column = {p: i for i, p in enumerate(weighed)}
    order = {t: len(weighed) + i for i, t in enumerate(sorted({m.transition for m in modes}))}
    entries: list[tuple[int, int, int]] = []
    for row, mode in enumerate(
        modes
    ):  # what counts of the transition, less the change, is 0 at most
        entries += [(row, column[p], -n) for p, n in mode.delta.items() if p in column and n]
        entries.append((row, order[mode.transition], 1))
    if not entries or not weighed:
        return ()
    at = ([r for r, _, _ in entries], [c for _, c, _ in entries])
    shape = (len(modes), len(weighed) + len(order))
    matrix: Any = csr_array(([n for *_, n in entries], at), shape=shape)
    goal = [0.0] * len(weighed) + [-1.0] * len(order)
    limits = [*((None, None) for _ in weighed), *((0.0, 1.0) for _ in order)]
    found = linprog(goal, A_ub=matrix, b_ub=[0.0] * len(modes), bounds=limits, method="highs")
    return () if found.x is None else [float(x) for x in found.x[: len(weighed)]]
