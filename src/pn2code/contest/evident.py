"""Formulas about one marking whose form alone says that they are true, or false, in every marking.

    evident(p or not p)                         # True
    evident(enabled(t) and not enabled(t, u))   # False
    evident(tokens(p) <= tokens(p, q))          # True

Each rule holds in all markings, reachable or not: numbers of tokens are not negative, and what is enabled is among what
it is a part of.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from functools import lru_cache

from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth


@lru_cache(maxsize=10_000)
def evident(f: Formula) -> bool | None:
    """The value; None: its form does not say."""
    found = _simple(f, True)
    return found.value if isinstance(found, Truth) else None


def _simple(f: Formula, wanted: bool) -> Formula:
    """The formula, or its opposite, with negations at its leaves only."""
    match f:
        case Truth(value):
            return Truth(value == wanted)
        case Op("not", (part,)):
            return _simple(part, not wanted)
        case Op("and" | "or" as operator, parts):
            return _junction((operator == "and") == wanted, (_simple(p, wanted) for p in parts))
        case AtMost(left, right):
            holds = _comparison(left, right)
            if holds is not None:
                return Truth(holds == wanted)
    return f if wanted else Op("not", (f,))


def _comparison(left: Constant | Tokens, right: Constant | Tokens) -> bool | None:
    """Whether left <= right."""
    match left, right:
        case Constant(a), Constant(b):
            return a <= b
        case Constant(a), Tokens():
            return True if a <= 0 else None
        case Tokens(), Constant(b):
            return False if b < 0 else None
        case Tokens(p), Tokens(q):
            return True if Counter(p) <= Counter(q) else None
    return None


def _junction(is_all: bool, parts: Iterable[Formula]) -> Formula:
    operator = "and" if is_all else "or"
    deciding = Truth(not is_all)
    found: dict[Formula, None] = {}
    for part in parts:
        if part == deciding:
            return deciding
        inner = part.parts if isinstance(part, Op) and part.operator == operator else (part,)
        found.update(dict.fromkeys(p for p in inner if not isinstance(p, Truth)))
    if any(Op("not", (p,)) in found for p in found) or _is_decided(is_all, found):
        return deciding
    return Op(operator, tuple(found)) if found else Truth(is_all)


def _is_decided(is_all: bool, parts: Iterable[Formula]) -> bool:
    """Of transitions, one of them enabled and none of more (`and`), or one of more enabled or none of them (`or`)."""
    enabled, disabled = [], []
    for p in parts:
        match p:
            case Fireable(names):
                enabled.append(frozenset(names))
            case Op("not", (Fireable(names),)):
                disabled.append(frozenset(names))
    return any(a <= b if is_all else b <= a for a in enabled for b in disabled)
