"""Formulas about one marking that follow from a formula of time, or that it follows from.

    follows(f)                      # a formula about one marking that is true wherever f is
    suffices(f)                     # one that is true only where f is
    outline(f, is_upper=True)       # f with one operator of time at most, one within the other: f implies it

What G p says now is p, and more; F p is true where p is; p U q is true where q is, and only where p or q is; of X p
nothing is known. All that holds for A and E alike, and in linear time for each path from a marking. So, if `follows(f)`
holds in no reachable marking, f is false everywhere; if `suffices(f)` holds in all of them, it is true everywhere.
"""

from __future__ import annotations

from pn2code.contest.formulas import Formula, Op
from pn2code.contest.rewriting import FALSE, TRUE, is_plain, joined, negation


def follows(f: Formula) -> Formula:
    """A formula about one marking that is true wherever f is."""
    return _bound(f, True)


def suffices(f: Formula) -> Formula:
    """A formula about one marking that is true only where f is."""
    return _bound(f, False)


def outline(f: Formula, *, is_upper: bool) -> Formula:
    """The formula with no operator of time within another one: f implies it (`is_upper`), or it implies f."""
    if is_plain(f):
        return f
    assert isinstance(f, Op)
    match f:
        case Op("not", (part,)):
            return negation(outline(part, is_upper=not is_upper))
        case Op("and" | "or" as operator, parts):
            return joined(operator, [outline(p, is_upper=is_upper) for p in parts])
        case Op("A" | "E" as quantifier, (path,)):
            return Op(quantifier, (outline(path, is_upper=is_upper),))
    return Op(f.operator, tuple(_bound(p, is_upper) for p in f.parts))


def is_nested(f: Formula) -> bool:
    """Whether an operator of time stands within another one."""
    return not is_plain(f) and outline(f, is_upper=True) != f


def _bound(f: Formula, is_upper: bool) -> Formula:
    if is_plain(f):
        return f
    assert isinstance(f, Op)
    match f:
        case Op("not", (part,)):
            return negation(_bound(part, not is_upper))
        case Op("and" | "or" as operator, parts):
            return joined(operator, [_bound(p, is_upper) for p in parts])
        case Op("A" | "E", (path,)):
            return _bound(path, is_upper)
        case Op("G", (p,)):
            return _bound(p, True) if is_upper else FALSE
        case Op("F", (p,)):
            return TRUE if is_upper else _bound(p, False)
        case Op("U", (p, q)):
            later = _bound(q, is_upper)
            return joined("or", [_bound(p, True), later]) if is_upper else later
        case Op("X", _):
            return TRUE if is_upper else FALSE
    raise ValueError(f"{f} is not a formula of time")
