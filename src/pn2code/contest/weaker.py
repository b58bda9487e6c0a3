"""Formulas about one marking of a coloured net, asked of the net without its colours (uncoloured.py)."""

from __future__ import annotations

from pn2code.contest.formulas import Fireable, Formula, Op, Truth
from pn2code.contest.rewriting import TRUE, joined, negation


def weaker(f: Formula, *, wanted: bool = True) -> Formula:
    """A formula about one marking that holds without colours wherever f holds (is `wanted`), or does not, with them.

    That a transition is enabled is the same there, or more: that it is not may be anywhere.
    """
    match f:
        case Fireable() if not wanted:
            return TRUE
        case Op("not", (part,)):
            return weaker(part, wanted=not wanted)
        case Op("and" | "or" as operator, parts):
            dual = operator if wanted else {"and": "or", "or": "and"}[operator]
            return joined(dual, [weaker(p, wanted=wanted) for p in parts])
        case Truth(value):
            return Truth(value == wanted)
    return f if wanted else negation(f)
