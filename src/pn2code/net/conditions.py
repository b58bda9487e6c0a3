"""The conditions of a transition: what decides whether a binding is possible, in the order in which it is asked here.

    for c in conditions(t, Raising(net.program), NetVariables(net.program.variables)):
        c.text, c.may_raise, c.may_fail, c.needs, c.binds

After each step of the plan come the guards that have all their variables, then the arcs that want something known which
cannot raise an exception; the other arcs come last (`semantics.game.enabling`).
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Con, Exp, Lit, PVar, Symbol
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatTransition,
    Term,
)
from pn2code.net.magnitudes import RaisesIn
from pn2code.net.total import is_total
from pn2code.net.uses import NetVariables, pattern_variables

TAKING = (ArcKind.INPUT, ArcKind.BOTH)
_WHOLE = frozenset(
    {Kind.UNIT, Kind.BOOL, Kind.ENUM, Kind.INT, Kind.INTINF, Kind.REAL, Kind.STRING, Kind.TIME}
)
_Place = tuple[int, int, int]
"""In the order: after how many steps of the plan, whether it is a step, a guard or an arc, which."""
_STEP, _GUARD, _ARC = range(3)


@frozen
class Condition:
    """What decides whether a binding is possible: a step of the plan, a guard, or what an arc wants.

    Args:
        at: its place in the order here.
        text: what is computed.
        may_raise: whether it may raise an exception.
        may_fail: whether it may be false, or match nothing where there is a token.
        binds: variables that get their values.
        needs: those that must have theirs before.
        term: of a token that an arc takes: the arc and the term.
        guard: of a guard: which.
    """

    at: _Place
    text: Exp
    may_raise: bool
    may_fail: bool
    binds: frozenset[Symbol]
    needs: frozenset[Symbol]
    term: tuple[int, int] | None = None
    guard: int | None = None


def conditions(t: FlatTransition, raising: RaisesIn, uses: NetVariables) -> list[Condition]:
    """All of a transition, in the order in which they are asked here."""
    return sorted(_conditions(t, raising, uses), key=lambda x: x.at)


def _conditions(t: FlatTransition, raising: RaisesIn, uses: NetVariables) -> Iterator[Condition]:
    own = frozenset(t.variables)
    bound: list[frozenset[Symbol]] = [frozenset()]
    steps: set[tuple[int, int]] = set()
    equations: set[int] = set()

    def needed(*texts: Exp | None) -> frozenset[Symbol]:
        return frozenset(uses.of(*texts)) & own

    for i, step in enumerate(t.plan, 1):
        before = bound[-1]
        new: frozenset[Symbol] = frozenset()
        match step:
            case BindTerm(arc, index):
                term = term_of(t, arc, index)
                names = frozenset(pattern_variables(term.pattern))
                new, needs = names - before, needed(*texts_of(term)) - (names - before)
                steps.add((arc, index))
                may = any(map(raising.raise_in, texts_of(term)))
                fails = not isinstance(term.pattern, PVar) or not new or term.delay is not None
                yield Condition((i, _STEP, 0), term.value, may, fails, new, needs, (arc, index))
            case BindEquation(guard, pattern, value):
                equations.add(guard)
                names = frozenset(pattern_variables(pattern))
                new, needs = names - before, needed(value)
                fails = (
                    not isinstance(pattern, PVar) or not new or not _is_whole(pattern.symbol.colset)
                )
                may = raising.raise_in(value)
                yield Condition((i, _STEP, 0), t.guards[guard], may, fails, new, needs, None, guard)
            case BindAll(symbol) | BindRandom(symbol):
                new = frozenset({symbol})
        bound.append(before | new)

    def at(needs: frozenset[Symbol]) -> int:
        return next((i for i, known in enumerate(bound) if needs <= known), len(bound) - 1)

    nothing: frozenset[Symbol] = frozenset()
    for i, text in enumerate(t.guards):
        if i not in equations and not isinstance(text, Con | Lit):
            needs = needed(text)
            place = (at(needs), _GUARD, i)
            yield Condition(place, text, raising.raise_in(text), True, nothing, needs, None, i)
    for i, taken in enumerate(t.arcs):
        if taken.kind not in TAKING or taken.inscription is None:
            continue
        for j, term in enumerate(taken.inscription.terms):
            if (i, j) in steps:
                continue
            needs, texts = needed(*texts_of(term)), texts_of(term)
            when = at(needs) if all(map(is_total, texts)) else len(bound) - 1
            may = any(map(raising.raise_in, texts))
            yield Condition((when, _ARC, i), term.value, may, bool(needs), nothing, needs, (i, j))


def term_of(t: FlatTransition, arc: int, index: int) -> Term:
    """A term of an arc that has an inscription."""
    inscription = t.arcs[arc].inscription
    assert inscription is not None
    return inscription.terms[index]


def texts_of(term: Term) -> list[Exp]:
    """What is computed for a term."""
    return [term.coefficient, term.value, *([] if term.delay is None else [term.delay])]


def _is_whole(colset: Colset | None) -> bool:
    """Whether a variable of a colour set takes every value of its type."""
    c = None if colset is None else colset.resolved
    return c is None or (c.kind in _WHOLE and c.low is None and c.high is None and c.length is None)
