"""A measure of progress: weights of places by which no occurrence ever makes a marking smaller.

    measure = Progress.of(net, storage, timed=True)
    measure.text()                     # what the explorer reads (`--sweep`)

    parts on the feeder 0, in the mill 1, on the pallet 2: each step of a part makes the sum greater by 1

Numbers in tokens count as numbers of tokens do (`- value of Left`), where they change by constants (`grown_values`).

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
from pn2code.structure.skeleton import skeleton
from pn2code.structure.symbolic import Symbolic
from pn2code.verify.exploring import grown_values
from pn2code.verify.exploring.grown_values import Amount

_DENOMINATORS = (1, 2, 6, 60, 2_520)
_NOTHING = 1e-7
_MOST_WEIGHT = 1 << 31
"""Greater weights are not used: the explorer adds them up in 64 bits."""


@frozen
class Change:
    """What one of the ways in which a transition occurs does to amounts; those that are not there stay as they are."""

    transition: int
    delta: Mapping[Amount, int]


@frozen
class Progress:
    """Weights of places, and of the numbers that their tokens have.

    Args:
        weights: of the amounts that count.
        rising: transitions each occurrence of which makes the sum greater.
        by_time: whether the model time counts, too.
    """

    weights: Mapping[Amount, int]
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
        found = _changes(net, storage)
        made = [Progress(w, rising_by(w, found), by_time) for w in _candidates(found)]
        best = max(made, key=lambda p: len(p.rising), default=None)  # of equal ones the first
        if best is not None and best.rising:
            return best
        return Progress({}, frozenset(), by_time) if by_time else None

    def names(self, net: FlatNet) -> str:
        """The sum for people: `Milled + 2 * Stowed - value of Left + the time`."""
        texts = [f"{_sign(w)} {_called(net, amount)}" for amount, w in _in_order(self.weights)]
        said = " ".join([*texts, *(["+ the time"] if self.by_time else [])])
        return said.removeprefix("+ ")

    def text(self) -> str:
        """The table that the explorer reads: lines of a place, its weight, and, where it is not the tokens that count,
        the component of their values, `=` for all of it; `time`, where that counts.
        """
        lines = [f"{a.place} {weight}{_component(a)}" for a, weight in _in_order(self.weights)]
        return "".join(f"{line}\n" for line in [*lines, *(["time"] if self.by_time else [])])


def _in_order(weights: Mapping[Amount, int]) -> list[tuple[Amount, int]]:
    return sorted(weights.items(), key=lambda w: (w[0].place, w[0].label or "", w[0].label is None))


def _component(amount: Amount) -> str:
    return "" if amount.label is None else f" {amount.label or '='}"


def _sign(weight: int) -> str:
    return f"{'-' if weight < 0 else '+'}{'' if abs(weight) == 1 else f' {abs(weight)} *'}"


def _called(net: FlatNet, amount: Amount) -> str:
    name = net.places[amount.place].name
    if amount.label is None:
        return name
    return f"{amount.label} of {name}" if amount.label else f"value of {name}"


def _changes(net: FlatNet, storage: Mapping[str, str]) -> tuple[Change, ...]:
    """What transitions change, of amounts of which all changes are known exactly."""
    begin = start_of(net, storage, ())
    skel = skeleton(net, Symbolic(net, begin.evaluator))
    modes = tuple(m for m in skel.modes if m.transition not in skel.never)
    unclear = {*skel.resets, *(p for m in modes for p in m.unknown)}
    values = grown_values.changes(net)
    found = []
    for mode in modes:
        delta = {Amount(p): n for p, n in mode.delta.items() if n and p not in unclear}
        delta |= {
            amount: own[mode.transition] for amount, own in values.items() if mode.transition in own
        }
        found.append(Change(mode.transition, delta))
    return tuple(found)


def rising_by(weights: Mapping[Amount, int], found: Sequence[Change]) -> frozenset[int]:
    """Transitions that make the sum greater in each of their ways; none at all if any of these makes it smaller."""
    sums = [(c.transition, sum(weights.get(a, 0) * n for a, n in c.delta.items())) for c in found]
    if any(change < 0 for _, change in sums):
        return frozenset()
    return frozenset(t for t, _ in sums) - {t for t, change in sums if change == 0}


def _candidates(changes: Sequence[Change]) -> Iterator[Mapping[Amount, int]]:
    """Whole weights that are perhaps right."""
    amounts = sorted(
        {a for c in changes for a in c.delta}, key=lambda a: (a.place, a.label is not None, a.label)
    )
    found = _solved(changes, amounts)
    for denominator in _DENOMINATORS if found else ():
        near = {
            a: Fraction(value).limit_denominator(denominator)
            for a, value in zip(amounts, found, strict=True)
            if abs(value) > _NOTHING
        }
        scale = lcm(*(w.denominator for w in near.values()))
        whole = {a: int(w * scale) for a, w in near.items() if w}
        common = gcd(*whole.values())
        if whole and max(map(abs, whole.values())) <= _MOST_WEIGHT * common:
            yield {a: w // common for a, w in whole.items()}


def _solved(changes: Sequence[Change], amounts: Sequence[Amount]) -> Sequence[float]:
    """Weights with which as many transitions as possible make the sum greater by 1 or more, none smaller.

    Sums cannot be made much greater by some transitions to make up for others: of each only a change up to 1 counts.
    """
    from scipy.optimize import linprog  # takes a third of a second to load
    from scipy.sparse import csr_array

    column = {a: i for i, a in enumerate(amounts)}
    order = {t: len(amounts) + i for i, t in enumerate(sorted({c.transition for c in changes}))}
    entries: list[tuple[int, int, int]] = []
    for row, change in enumerate(changes):  # what counts of it, less the change, is 0 at most
        entries += [(row, column[a], -n) for a, n in change.delta.items()]
        entries.append((row, order[change.transition], 1))
    if not amounts:
        return ()
    at = ([r for r, _, _ in entries], [c for _, c, _ in entries])
    shape = (len(changes), len(amounts) + len(order))
    matrix: Any = csr_array(([n for *_, n in entries], at), shape=shape)
    goal = [0.0] * len(amounts) + [-1.0] * len(order)
    limits = [*((None, None) for _ in amounts), *((0.0, 1.0) for _ in order)]
    found = linprog(goal, A_ub=matrix, b_ub=[0.0] * len(changes), bounds=limits, method="highs")
    return () if found.x is None else [float(x) for x in found.x[: len(amounts)]]
