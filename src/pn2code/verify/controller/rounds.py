"""How often a script can go round: a list gets shorter each time, or a number comes nearer to the end of its range.

    in Way : p :: rest  /  out Way : rest      place Way : ROUTE, list POSE with 0..20   ->  at most 20 times
    in Told : n         /  out Told : n - 1    place Told : COUNT, int with 0..9         ->  at most 9 times

What a token is, is in the colour set of its place: the net raises an exception otherwise, and the script stops.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice, product

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind

MOST_CHOICES = 64
"""Which parts of the tokens are looked at together, at most."""

_Path = tuple[str, ...]


@frozen
class ControlStep:
    """A step from one control place to another one.

    Args:
        here: where its token is taken.
        there: where it is put.
        taken: which token that is.
        put: which token is put; None: that is not looked at.
    """

    here: int
    there: int
    taken: core.Exp
    put: core.Exp | None


@frozen
class _Level:
    """What is counted of the tokens of a place: how long a list is, or a number; and between what it stays."""

    path: _Path
    low: int
    high: int


@frozen
class Turns:
    """How often steps can occur that lead round.

    Args:
        room: how far what is counted can go altogether.
        by: how far each step takes it, in the order of the steps; 0: not at all, and these alone lead nowhere round.
    """

    room: int
    by: tuple[int, ...]


def turns(ways: Sequence[ControlStep], colsets: Mapping[int, Colset]) -> Turns | None:
    """Of steps that lead round among places; None: nothing is counted that ends it.

    Args:
        ways: all steps among the places.
        colsets: of the places.
    """
    places = sorted({p for way in ways for p in (way.here, way.there)})
    choices = product(*(tuple(_levels(colsets[p], ())) for p in places))
    for choice in islice(choices, MOST_CHOICES):
        found = _counted(ways, dict(zip(places, choice, strict=True)))
        if found is not None:
            return found
    return None


def _levels(colset: Colset, path: _Path) -> Iterator[_Level]:
    c = colset.whole
    if c.kind in (Kind.RECORD, Kind.PRODUCT):
        labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
        for label, part in zip(labels, c.components, strict=True):
            if part is not None:
                yield from _levels(part, (*path, label))
    elif c.kind in (Kind.LIST, Kind.INT) and isinstance(c.high, int):
        low = c.low if isinstance(c.low, int) else 0 if c.kind is Kind.LIST else None
        if low is not None:
            yield _Level(path, low, c.high)


def _counted(ways: Sequence[ControlStep], levels: Mapping[int, _Level]) -> Turns | None:
    steps = []
    for way in ways:
        before = _form(_part(way.taken, levels[way.here].path))
        after = None if way.put is None else _form(_part(way.put, levels[way.there].path))
        if before is None or after is None or before[0] != after[0]:
            return None
        steps.append(after[1] - before[1])
    if min(steps) < 0 < max(steps):
        return None
    if _leads_round((w.here, w.there) for w, by in zip(ways, steps, strict=True) if by == 0):
        return None
    room = max(x.high for x in levels.values()) - min(x.low for x in levels.values())
    return Turns(room, tuple(abs(by) for by in steps))


def _leads_round(edges: Iterable[tuple[int, int]]) -> bool:
    left = set(edges)
    while left:
        ends = {here for here, _ in left}
        kept = {(here, there) for here, there in left if there in ends}
        if kept == left:
            return True
        left = kept
    return False


def _part(e: core.Exp, path: _Path) -> core.Exp:
    """The part of a value; where it is not written, what selects it."""
    for label in path:
        written = dict(e.fields) if isinstance(e, core.RecordExp) else {}
        e = written.get(label) or core.Select(label, e, e.type, e.span)
    return e


_Form = tuple[tuple[object, ...] | None, int]
"""A list or number: that of a variable (None: of nothing), and how many items or how much more."""


def _form(e: core.Exp) -> _Form | None:
    match e:
        case core.Var(symbol):
            return (symbol.uid,), 0
        case core.Select(label, record):
            inner = _form(record)
            is_whole = inner is not None and inner[0] is not None and inner[1] == 0
            return ((*inner[0], label), 0) if is_whole and inner and inner[0] else None
        case core.Lit(value) if type(value) is int:
            return None, value
        case core.ListExp(items):
            return None, len(items)
        case core.Con(constructor) if constructor.name == "nil":
            return None, 0
        case core.Apply(core.Con(constructor), core.RecordExp(((_, _), (_, others)))) if (
            constructor.name == "::"
        ):
            return _more(_form(others), 1)
        case core.Apply(core.Builtin("List.tl"), others):
            return _more(_form(others), -1)
        case core.Apply(core.Builtin("Int.+"), core.RecordExp(((_, of), (_, core.Lit(by))))):
            return _more(_form(of), by) if type(by) is int else None
        case core.Apply(core.Builtin("Int.-"), core.RecordExp(((_, of), (_, core.Lit(by))))):
            return _more(_form(of), -by) if type(by) is int else None
        case _:
            return None


def _more(form: _Form | None, by: int) -> _Form | None:
    return None if form is None else (form[0], form[1] + by)
