"""Formulas of time made simpler: what is known of one marking is put in, and operators are joined.

    simpler = branching(formula, known)     # CTL
    simpler = linear(formula, known)        # LTL: a formula of all paths, or several joined
    initially(simpler, tables)              # what the initial marking alone decides

The rules of branching time are those of Bønneland, Dyhr, Jensen, Johannsen, Srba (2018, Simplification of CTL formulae
for efficient model checking of Petri nets). All hold where paths are maximal, and one that ends in a dead marking stays
there: EX is false in a dead marking, AX true, and everything else sees it for ever.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from pn2code.contest.evident import evident
from pn2code.contest.formulas import Formula, Op, Truth

TRUE, FALSE = Truth(True), Truth(False)
Known = Callable[[Formula], bool | None]
"""The value of a formula about one marking, if it is the same in all reachable markings."""


def is_plain(f: Formula) -> bool:
    """Whether a formula is about one marking."""
    return not isinstance(f, Op) or (f.operator not in "AEXFGU" and all(map(is_plain, f.parts)))


def has_next(f: Formula) -> bool:
    """Whether the number of steps counts in it."""
    return isinstance(f, Op) and (f.operator == "X" or any(map(has_next, f.parts)))


def leaves(f: Formula) -> Iterable[Formula]:
    """The largest parts about one marking."""
    if is_plain(f):
        if not isinstance(f, Truth):
            yield f
        return
    assert isinstance(f, Op)
    for part in f.parts:
        yield from leaves(part)


def negation(f: Formula) -> Formula:
    """The opposite."""
    match f:
        case Truth(value):
            return Truth(not value)
        case Op("not", (part,)):
            return part
    return Op("not", (f,))


def joined(operator: str, parts: Iterable[Formula]) -> Formula:
    """`and` or `or` of the parts."""
    deciding = Truth(operator == "or")
    found: dict[Formula, None] = {}
    for part in parts:
        inner = part.parts if isinstance(part, Op) and part.operator == operator else (part,)
        found.update(dict.fromkeys(inner))
    if deciding in found or any(negation(f) in found for f in found):
        return deciding
    found.pop(negation(deciding), None)
    if len(found) < 2:
        return next(iter(found), negation(deciding))
    return Op(operator, tuple(found))


def _opposite(operator: str) -> str:
    return {"and": "or", "or": "and", "F": "G", "G": "F", "X": "X", "A": "E", "E": "A"}[operator]


# --- branching time ------------------------------------------------------------------------------


def path(quantifier: str, operator: str, *parts: Formula) -> Formula:
    """`A` or `E` with an operator of time."""
    return Op(quantifier, (Op(operator, parts),))


def branching(f: Formula, known: Known, wanted: bool = True) -> Formula:
    """A formula of CTL (or its negation) made simpler."""
    if isinstance(f, Truth):
        return Truth(f.value == wanted)
    if is_plain(f):
        return _plain(f, known, wanted)
    assert isinstance(f, Op)
    match f:
        case Op("not", (part,)):
            return branching(part, known, not wanted)
        case Op("and" | "or" as operator, parts):
            simpler = [branching(p, known, wanted) for p in parts]
            return joined(operator if wanted else _opposite(operator), simpler)
        case Op("A" | "E" as quantifier, (Op("U", (p, q)),)):
            made = _until(quantifier, branching(p, known), branching(q, known))
            if wanted or _is_path(made, "AE", "U"):
                return made if wanted else negation(made)
            return branching(made, _nothing, False)
        case Op("A" | "E" as quantifier, (Op("X" | "F" | "G" as operator, (p,)),)):
            part = branching(p, known, wanted)
            path_, time_ = (
                (quantifier, operator) if wanted else (_opposite(quantifier), _opposite(operator))
            )
            return {"X": _next, "F": _finally, "G": _globally}[time_](path_, part)
    raise ValueError(f"{f} is not a formula of CTL")


def _plain(f: Formula, known: Known, wanted: bool) -> Formula:
    """A formula about one marking, or its negation; two negations are none."""
    match f:
        case Op("not", (Op("not", (inner,)),)):
            return _plain(inner, known, wanted)
    value = known(f)
    value = evident(f) if value is None else value
    plain = f if value is None else Truth(value)
    return plain if wanted else negation(plain)


def _nothing(f: Formula) -> None:
    return None


def _is_path(f: Formula, quantifiers: str, operator: str) -> bool:
    return (
        isinstance(f, Op)
        and f.operator in quantifiers
        and isinstance(f.parts[0], Op)
        and f.parts[0].operator == operator
    )


def _of_path(f: Formula) -> tuple[Formula, ...]:
    assert isinstance(f, Op) and isinstance(f.parts[0], Op)
    return f.parts[0].parts


def _next(quantifier: str, p: Formula) -> Formula:
    if p == Truth(quantifier == "A"):
        return p
    return path(quantifier, "X", p)


def _finally(quantifier: str, p: Formula) -> Formula:
    """EF p and AF p."""
    if isinstance(p, Truth):
        return p
    if _is_path(p, "E", "F") or (quantifier == "A" and _is_path(p, "A", "F")):
        return p  # EF EF p, AF EF p: EF p; AF AF p: AF p
    if quantifier == "E" and _is_path(p, "A", "F"):
        return _finally("E", _of_path(p)[0])
    if _is_path(p, "A" if quantifier == "A" else "AE", "U"):
        return _finally(quantifier, _of_path(p)[1])
    if quantifier == "E" and isinstance(p, Op) and p.operator == "or" and not is_plain(p):
        return joined("or", [_finally("E", x) for x in _grouped(p)])
    return path(quantifier, "F", p)


def _globally(quantifier: str, p: Formula) -> Formula:
    """EG p and AG p."""
    if isinstance(p, Truth):
        return p
    if _is_path(p, "A", "G") or (quantifier == "E" and _is_path(p, "E", "G")):
        return p
    if quantifier == "A" and _is_path(p, "E", "G"):
        return _globally("A", _of_path(p)[0])
    if quantifier == "A" and isinstance(p, Op) and p.operator == "and" and not is_plain(p):
        return joined("and", [_globally("A", x) for x in _grouped(p)])
    return path(quantifier, "G", p)


def _grouped(f: Op) -> list[Formula]:
    """The parts, all about one marking together."""
    plain = [p for p in f.parts if is_plain(p)]
    rest = [p for p in f.parts if not is_plain(p)]
    return [*([joined(f.operator, plain)] if plain else []), *rest]


def _until(quantifier: str, p: Formula, q: Formula) -> Formula:
    if isinstance(q, Truth) or p in (q, FALSE):
        return q
    if p == TRUE:
        return _finally(quantifier, q)
    if _is_path(q, "E", "F") or (quantifier == "A" and _is_path(q, "A", "F")):
        return q
    if _is_path(q, quantifier, "U") and _of_path(q)[0] == p:
        return q
    return path(quantifier, "U", p, q)


# --- linear time ---------------------------------------------------------------------------------


def linear(f: Formula, known: Known) -> Formula:
    """A formula of LTL made simpler: formulas of all paths, and of the initial marking, joined."""
    if is_plain(f) and not isinstance(f, Truth):
        return _plain(f, known, True)
    match f:
        case Truth():
            return f
        case Op("not", (part,)):
            return negation(linear(part, known))
        case Op("and" | "or" as operator, parts):
            return joined(operator, [linear(p, known) for p in parts])
        case Op("A", (part,)):
            return _all_paths(_linear(part, known, True))
    raise ValueError(f"{f} is not a formula of LTL")


def _all_paths(f: Formula) -> Formula:
    """A formula of all paths; one that is joined with `and` is several."""
    match f:
        case Truth():
            return f
        case Op("and", parts) if not is_plain(f):
            return joined("and", map(_all_paths, parts))
        case Op("G", (Op("and") as both,)) if not is_plain(both):
            return joined("and", [_all_paths(_time("G", p)) for p in _grouped(both)])
    return Op("A", (f,))


def _linear(f: Formula, known: Known, wanted: bool) -> Formula:
    if isinstance(f, Truth):
        return Truth(f.value == wanted)
    if is_plain(f):
        return _plain(f, known, wanted)
    assert isinstance(f, Op)
    match f:
        case Op("not", (part,)):
            return _linear(part, known, not wanted)
        case Op("and" | "or" as operator, parts):
            simpler = [_linear(p, known, wanted) for p in parts]
            return _pulled(joined(operator if wanted else _opposite(operator), simpler))
        case Op("U", (p, q)):
            made = _linear_until(_linear(p, known, True), _linear(q, known, True))
            if wanted:
                return made
            is_until = isinstance(made, Op) and made.operator == "U"
            return negation(made) if is_until else _linear(made, _nothing, False)
        case Op("X" | "F" | "G" as operator, (p,)):
            return _time(operator if wanted else _opposite(operator), _linear(p, known, wanted))
    raise ValueError(f"{f} is not a formula of LTL")


def _lasts(f: Formula) -> bool:
    """Whether it holds at all times of a path or at none: GF p, FG p, and what is made of these."""
    match f:
        case Op("and" | "or" | "not", parts):
            return all(map(_lasts, parts))
        case Op("G", (Op("F", _),)) | Op("F", (Op("G", _),)):
            return True
    return isinstance(f, Truth)


def _time(operator: str, p: Formula) -> Formula:
    """X p, F p or G p. A next is moved outwards: FX p is XF p, and X GF p is GF p."""
    if _lasts(p) or (isinstance(p, Op) and p.operator == operator and operator in "FG"):
        return p
    match p:
        case Op("X", (inner,)) if operator in "FG":
            return _time("X", _time(operator, inner))
        case Op("U", (_, q)) if operator == "F":
            return _time("F", q)
    return Op(operator, (p,))


def _linear_until(p: Formula, q: Formula) -> Formula:
    if _lasts(q) or p in (q, FALSE):
        return q
    if p == TRUE:
        return _time("F", q)
    match p, q:
        case (Op("X", (a,)), Op("X", (b,))):
            return _time("X", _linear_until(a, b))
        case (_, Op("F", _)):
            return q
        case (_, Op("U", (a, _))) if a == p:
            return q
    return Op("U", (p, q))


def _pulled(f: Formula) -> Formula:
    """X p and X q is X (p and q); what lasts may stand within."""
    if not isinstance(f, Op) or f.operator not in ("and", "or"):
        return f
    if not any(isinstance(p, Op) and p.operator == "X" for p in f.parts):
        return f
    inner = []
    for p in f.parts:
        match p:
            case Op("X", (part,)):
                inner.append(part)
            case _ if _lasts(p):
                inner.append(p)
            case _:
                return f
    return _time("X", _pulled(joined(f.operator, inner)))


# --- the initial marking -------------------------------------------------------------------------


def initially(f: Formula, holds: Callable[[Formula], bool]) -> Formula:
    """What is left of a formula when the initial marking is looked at.

    Args:
        f: a formula of CTL or LTL.
        holds: whether a formula about one marking holds there.
    """
    if isinstance(f, Truth):
        return f
    if is_plain(f):
        return Truth(holds(f))
    assert isinstance(f, Op)
    match f:
        case Op("not", (p,)):
            return negation(initially(p, holds))
        case Op("and" | "or" as operator, parts):
            return joined(operator, [initially(p, holds) for p in parts])
        case Op("A" | "E", (inner,)):
            now = initially(inner, holds)
            if now == inner:
                return f
            return _all_paths(now) if f.operator == "A" and _is_of_a_path(now) else now
        case Op("F", (p,)):
            return TRUE if initially(p, holds) == TRUE else f
        case Op("G", (p,)):
            return FALSE if initially(p, holds) == FALSE else f
        case Op("U", (p, q)):
            before, after = initially(p, holds), initially(q, holds)
            if after == TRUE:
                return TRUE
            return FALSE if (before, after) == (FALSE, FALSE) else f
    return f


def _is_of_a_path(f: Formula) -> bool:
    """Whether an operator of time stands in it outside of `A` and `E`."""
    if not isinstance(f, Op) or f.operator in "AE":
        return False
    return f.operator in "XFGU" or any(map(_is_of_a_path, f.parts))
