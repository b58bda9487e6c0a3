"""Formulas of one operator of time, as a run that begins in the initial marking can decide them.

    path = path_of(formula)         # E (p U q), A (p U q), E X p and their kin; None: another formula
    Followed(path, p, q).on(..)     # True or False, once a run decides it
    next_value(path, q, ..)         # of a formula with next

A run decides E (p U q) if it comes to q through p, and A (p U q) if it comes to neither, or ends before. The others are
these: F q is true U q, and G p the opposite of F not p.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from pn2code.base.frozen import frozen, record
from pn2code.contest.formulas import Formula, Op
from pn2code.contest.rewriting import TRUE, is_plain, negation


@frozen
class Path:
    """A formula of paths: E or A of p U q or X q, or the opposite of that.

    Args:
        quantifier: "E" or "A".
        is_next: whether it is X q.
        before: p.
        reach: q.
        is_opposite: whether the formula is the opposite.
    """

    quantifier: str
    is_next: bool
    before: Formula
    reach: Formula
    is_opposite: bool = False


def path_of(f: Formula) -> Path | None:
    """A formula as a `Path`; None if it has another form."""
    match f:
        case Op("E" | "A" as q, (Op("U", (a, b)),)) if is_plain(a) and is_plain(b):
            return Path(q, False, a, b)
        case Op("E" | "A" as q, (Op("F", (b,)),)) if is_plain(b):
            return Path(q, False, TRUE, b)
        case Op("E" | "A" as q, (Op("G", (a,)),)) if is_plain(a):
            return Path("A" if q == "E" else "E", False, TRUE, negation(a), True)
        case Op("E" | "A" as q, (Op("X", (b,)),)) if is_plain(b):
            return Path(q, True, TRUE, b)
    return None


@record
class Followed:
    """A path formula along a run.

    Args:
        path: the formula; not with next.
        before: whether p holds in a marking.
        reach: whether q does.
        awaited: the run, and the number of the marking in it, with which it goes on; None: none does.
    """

    path: Path
    before: Callable[..., bool]
    reach: Callable[..., bool]
    awaited: tuple[int, int] | None = None

    def on(self, run: int, at: int, seen: object, *, is_last: bool) -> bool | None:
        """The value of the formula, if the run decides it here.

        Args:
            run: its number.
            at: the number of the marking in it, from 0 on; who has not seen all before waits for another run.
            seen: the marking.
            is_last: whether it is dead.
        """
        if at and self.awaited != (run, at):
            return None
        self.awaited = None
        if self.reach(seen):
            return not self.path.is_opposite if self.path.quantifier == "E" else None
        if not self.before(seen) or is_last:
            return self.path.is_opposite if self.path.quantifier == "A" else None
        self.awaited = run, at + 1
        return None


def next_value(
    path: Path, reach: Callable[..., bool], successors: Iterable[object], *, is_all: bool
) -> bool | None:
    """The value of a formula with next.

    Args:
        path: the formula.
        reach: whether q holds in a marking.
        successors: of the initial marking.
        is_all: whether these are all.
    """
    found = set(map(reach, successors))
    decides = path.quantifier == "E"
    if decides in found:
        return decides
    return not decides if is_all else None
