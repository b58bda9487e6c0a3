"""Whether CPN Tools finds an order in which it can bind the variables of a transition.

Its engine uses an arc once: at one moment it binds the variables of some summands of its inscription, no two of which
share a variable that has no value yet; all the other summands only test from then on. (Found by experiment.) So
1`(a, b) ++ 1`(a, c) is refused with "No complete binding sequence found for this transition", unless `a` or `b` or `c`
has a value from elsewhere; 1`(a, b) ++ 1`(b, a) ++ 1`(a, 1) is not: its second and third summands test.

It tries all values of a variable of a small colour set only where no pattern could bind it. So the guard [c = d] is
refused when neither has a value, and so are [c = f c] and the arc inscription (size c)`c; [c = f d] is not, if no
other pattern has `d`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import islice

from pn2code.ml.core.terms import Symbol

Names = frozenset[Symbol]
MOST = 1_000
"""Orders, and choices of summands of an arc, that are tried; where there are more, one is taken to exist."""


def stuck(
    arcs: Sequence[Sequence[Names]],
    equations: Collection[tuple[Names, Names]],
    known: Names,
    wanted: Names,
) -> Names:
    """Those of `wanted` that have no value in the order that gets furthest; none if all can be bound.

    Args:
        arcs: of each arc its summands that are patterns, each by its variables.
        equations: variables that get a value, once those that it needs have one.
        known: what has a value before.
    """
    best, tried = wanted, 0
    todo = [(known, tuple(tuple(arc) for arc in arcs))]
    while todo:
        tried += 1
        known, waiting = _settled(*todo.pop(), equations)
        best = min(best, wanted - known, key=len)
        if not best or tried > MOST:
            return frozenset()
        for n, arc in enumerate(waiting):
            others = waiting[:n] + waiting[n + 1 :]
            todo += [(known | chosen, others) for chosen in islice(_choices(arc, known), MOST)]
    return best


def _settled(
    known: Names, arcs: tuple[tuple[Names, ...], ...], equations: Collection[tuple[Names, Names]]
) -> tuple[Names, tuple[tuple[Names, ...], ...]]:
    """What has a value when all is bound that loses nothing, and the arcs that are left."""
    while True:
        before = known
        for bound, needs in equations:
            if needs <= known:
                known |= bound
        waiting = []
        for arc in arcs:
            everything = known.union(*arc)
            if everything == known or any(
                known | chosen == everything for chosen in islice(_choices(arc, known), MOST)
            ):
                known = everything
            else:
                waiting.append(arc)
        arcs = tuple(waiting)
        if known == before:
            return known, arcs


def _choices(arc: Sequence[Names], known: Names) -> Iterator[Names]:
    """What summands of an arc can bind together: no two share a variable; the most first."""
    free = list(dict.fromkeys(s - known for s in arc if s - known))
    stack: list[tuple[Names, int]] = [(frozenset(), 0)]
    while stack:
        chosen, at = stack.pop()
        rest = [n for n in range(at, len(free)) if chosen.isdisjoint(free[n])]
        stack += [(chosen | free[n], n + 1) for n in reversed(rest)]
        if not rest and chosen:
            yield chosen
