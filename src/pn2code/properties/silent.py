"""Whether a property means the same where programs take steps that are no occurrences of the net.

Such a step changes no place of the net, and lies between two occurrences. So what is said of markings means the same;
what is said of the step that comes *next* (`fires`, `X`) may not. A formula is sorted, in negation normal form:

    SAME   it is true before such a step if and only if it is true after it
    LESS   if it is true before it, it is true after it (`fires(T)`, `dead`: not true before a silent step)
    MORE   if it is true after it, it is true before it (`!fires(T)`)
    OTHER  nothing is known

`p U fires(T)` is none of these: where T is the next step of the net it is true whether p is or not, but before a silent
step p has to be true. With `!fires(S)` for p, which always is before a silent step, it is SAME.

Of formulas of linear time more is known, as a path with silent steps can be held against the one without them
(`_is_kept`). The markings before an occurrence, and after the one before it, are a *block*; the last of them stands for
all in the path without silent steps.
"""

from __future__ import annotations

from enum import Enum

from pn2code.properties import meaning as m


class Sort(Enum):
    """How silent steps change a formula."""

    SAME = "same"
    LESS = "less"
    MORE = "more"
    OTHER = "other"


_NEXT = frozenset({"X", "EX", "AX"})
_UNTIL = frozenset({"U", "AU", "EU", "W", "AW", "EW"})
_ALWAYS = frozenset({"G", "AG", "EG"})
_FINALLY = frozenset({"F", "AF", "EF"})


def means_the_same(asked: m.Asked, answer: str = "") -> bool:
    """Whether the answer for the programs ("": whichever it is) is the answer for their occurrences."""
    match asked:
        case m.Bound():
            return True
        case m.Invariant(condition):
            return sort(condition) in (Sort.SAME, Sort.MORE)
        case m.Branching(formula):
            return sort(formula) is Sort.SAME
        case m.Linear(formula):
            signs = {"yes": (True,), "no": (False,)}.get(answer, (True, False))
            return all(_is_kept(formula, sign, last=False) for sign in signs)
        case m.Response(first, second):
            events = (first, second)
            return all(m.looks_at_steps(e) or sort(e) is Sort.SAME for e in events)


def sort(f: m.Formula, positive: bool = True) -> Sort:
    """Of a formula, or (not `positive`) of its negation."""
    if isinstance(f, m.Atom):
        if f.kind in ("true", "pred"):
            return Sort.SAME
        if f.kind == "initial":
            return (
                Sort.OTHER
            )  # the programs stand elsewhere when the net has come back to its initial marking
        return Sort.LESS if positive else Sort.MORE
    match f.operator:
        case "not":
            return sort(f.parts[0], not positive)
        case "implies":
            a, b = f.parts
            return sort(m.Op("or", (m.Op("not", (a,)), b)), positive)
        case "iff":
            found = {sort(x, sign) for x in f.parts for sign in (True, False)}
            return Sort.SAME if found == {Sort.SAME} else Sort.OTHER
        case "and" | "or":
            return _joined(f, positive)
        case "EX" | "AX" if f.step >= 0 and sort(f.parts[0], positive) is Sort.SAME:
            # `EX<T>`: there is an arc of T here
            return Sort.LESS if (f.operator == "EX") is positive else Sort.MORE
        case operator if operator in _NEXT:
            return Sort.OTHER
        case _:
            return _temporal(f, positive)


def _flat(f: m.Formula, positive: bool, joins: bool) -> list[tuple[m.Formula, bool]]:
    """The parts of a disjunction (or, not `joins`, of a conjunction), with their signs."""
    if isinstance(f, m.Op):
        if f.operator == "not":
            return _flat(f.parts[0], not positive, joins)
        if f.operator == "implies":
            a, b = f.parts
            return _flat(m.Op("or", (m.Op("not", (a,)), b)), positive, joins)
        if f.operator in ("and", "or") and ((f.operator == "or") is positive) is joins:
            return [x for part in f.parts for x in _flat(part, positive, joins)]
    return [(f, positive)]


def _joined(f: m.Op, positive: bool) -> Sort:
    is_or = (f.operator == "or") is positive
    parts = _flat(f, positive, is_or)
    found = {sort(x, sign) for x, sign in parts}
    # `!fires(T) || X f`: where T is next, what comes next is what comes after T.
    if Sort.OTHER in found and is_or and _has_step(parts, False):
        rest = {sort(x, s) for x, s in parts if not _is_next(x, s)}
        after = all(_after(x, s) for x, s in parts if _is_next(x, s))
        return Sort.MORE if after and rest <= {Sort.SAME, Sort.MORE} else Sort.OTHER
    if Sort.OTHER in found and not is_or and _has_step(parts, True):
        rest = {sort(x, s) for x, s in parts if not _is_next(x, s)}
        after = all(_after(x, s) for x, s in parts if _is_next(x, s))
        return Sort.LESS if after and rest <= {Sort.SAME, Sort.LESS} else Sort.OTHER
    found -= {Sort.SAME}
    return found.pop() if len(found) == 1 else Sort.OTHER if found else Sort.SAME


def _has_step(parts: list[tuple[m.Formula, bool]], positive: bool) -> bool:
    return any(
        isinstance(x, m.Atom) and x.kind in ("fires", "fires so") and s is positive
        for x, s in parts
    )


def _is_next(f: m.Formula, positive: bool) -> bool:
    return isinstance(f, m.Op) and f.operator == "X"


def _after(f: m.Formula, positive: bool) -> bool:
    assert isinstance(f, m.Op)
    return sort(f.parts[0], positive) is Sort.SAME


def _temporal(f: m.Op, positive: bool) -> Sort:
    """An operator whose parts are looked at in all, or in some, of the markings that come."""
    operator = f.operator
    lasts, comes = (Sort.SAME, Sort.MORE), (Sort.SAME, Sort.LESS)
    if operator in _ALWAYS or operator in _FINALLY:
        is_always = (operator in _ALWAYS) is positive
        fits = sort(f.parts[0], positive) in (lasts if is_always else comes)
    else:
        a, b = (sort(x, positive) for x in f.parts)
        is_until = (operator in _UNTIL) is positive  # the negation of one is a release
        fits = (a in lasts and b in comes) if is_until else (a in comes and b in lasts)
        fits = fits and (b is Sort.SAME or _holds_before(f.parts[0], positive is is_until))
    return Sort.SAME if fits else Sort.OTHER


def _is_kept(f: m.Formula, positive: bool, *, last: bool) -> bool:
    """Whether a formula (or, not `positive`, its negation) that is true with silent steps is true without them.

    Args:
        f: of linear time.
        positive: not its negation.
        last: where it is true in the last marking of a block; else wherever in the block it is.
    """
    if isinstance(f, m.Atom):
        if f.kind in ("fires", "fires so", "dead"):
            return positive or last
        return f.kind in ("true", "pred")
    match f.operator:
        case "not":
            return _is_kept(f.parts[0], not positive, last=last)
        case "iff":
            each = [(x, sign) for x in f.parts for sign in (True, False)]
            return all(_is_kept(x, sign, last=last) for x, sign in each)
        case "and" | "or" | "implies":
            is_or = (f.operator != "and") is positive
            return _are_kept(_flat(f, positive, is_or), is_or=is_or, last=last)
        case "X":
            return last and _is_kept(f.parts[0], positive, last=False)
        case "F" | "G":
            is_always = (f.operator == "G") is positive
            return _is_kept(f.parts[0], positive, last=is_always)
        case "U" | "W" | "R":
            a, b = ((x, positive) for x in f.parts)
            if (f.operator != "R") is positive:  # a until b
                return _is_kept(*a, last=True) and _is_kept(*b, last=False)
            # b until both are
            both = [x for part in (a, b) for x in _flat(*part, False)]
            return _is_kept(*b, last=True) and _are_kept(both, is_or=False, last=False)
        case _:
            return False


def _are_kept(parts: list[tuple[m.Formula, bool]], *, is_or: bool, last: bool) -> bool:
    """The same of a disjunction or conjunction. What T is next in is the last marking of its block."""
    is_last = last or (not is_or and _has_step(parts, True))
    return all(_is_kept(x, sign, last=is_last) for x, sign in parts)


def _holds_before(f: m.Formula, positive: bool) -> bool:
    """Whether a formula (or, not `positive`, its negation) is true before each silent step."""
    if isinstance(f, m.Atom):
        return f.kind == "true" if positive else f.kind in ("fires", "fires so", "dead")
    if f.operator == "not":
        return _holds_before(f.parts[0], not positive)
    if f.operator in ("and", "or", "implies"):
        is_or = (f.operator != "and") is positive
        each = (_holds_before(x, sign) for x, sign in _flat(f, positive, is_or))
        return any(each) if is_or else all(each)
    return False
