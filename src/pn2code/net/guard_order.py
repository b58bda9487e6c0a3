"""Conditions that CPN Tools may look at before others that keep them from being looked at here.

With `[length l >= 2, m = hd l]` its engine computes `hd l` first, whatever `length l` is, and stops with the exception
`Empty` at an empty list. Here the first condition ends the question. In which order the engine asks is decided by a
search for the cheapest order, in which equal ones are taken as its queue happens to hold them (found by experiment):

    [length l > 0, hd l > 0]         asked as written; the other way round if written so
    [n > 1, length l > 0, hd l > n]  `hd l > n` first
    [length l > 0, m = hd l]         the equation first
    [length l > 0, m = hd l, m > 1]  the equation second

The search is a shortest path, from "all conditions and arcs are open" to "all variables are known" (CPN Tools' public
sources). It is made for each group of variables that conditions and arcs connect. Steps cost: a token matched with a
pattern 100, found by its known parts 20, an arc whose variables are known 10, a condition 2, an equation that binds 1,
all values of a small colour set 1,000. Of paths that cost the same, one is taken as the queue holds them, so that
nothing is built on it here.

`unsure`: what raises no exception in the order of the plan, and might in another.
`doubtful`: what may raise one in the order of the plan, and none in another.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Note
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Con, Exp, Lit, PVar, Symbol
from pn2code.net.codes import GUARD_ORDER
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatNet,
    FlatTransition,
    Term,
)
from pn2code.net.raising import Raising
from pn2code.net.total import is_total
from pn2code.net.uses import NetVariables, pattern_variables

_TAKING = (ArcKind.INPUT, ArcKind.BOTH)
_WHOLE = frozenset(
    {Kind.UNIT, Kind.BOOL, Kind.ENUM, Kind.INT, Kind.INTINF, Kind.REAL, Kind.STRING, Kind.TIME}
)
MOST_NAMED = 5
"""Transitions that get a warning of their own."""
_Place = tuple[int, int, int]
"""In the order: after how many steps of the plan, whether it is a step, a guard or an arc, which."""
_STEP, _GUARD, _ARC = range(3)


@frozen
class Unsure:
    """A transition, what may raise an exception in it, and a condition that may keep it from being computed."""

    transition: FlatTransition
    raises: Exp
    first: Exp


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


def unsure(net: FlatNet) -> tuple[Unsure, ...]:
    """One of each transition at most, in the order of the net; none in PNML nets, which CPN Tools does not read."""
    if net.file.lower().endswith(".pnml") or not any(t.guards for t in net.transitions):
        return ()
    raising, uses = Raising(net.program), NetVariables(net.program.variables)
    found = (_unsure(t, raising, uses) for t in net.transitions if t.guards)
    return tuple(x for x in found if x is not None)


def doubtful(net: FlatNet) -> tuple[Unsure, ...]:
    """What may raise an exception here, and in CPN Tools none, as it may ask first what comes later here.

    One of each transition at most, in the order of the net; none in PNML nets.
    """
    if net.file.lower().endswith(".pnml"):
        return ()
    raising, uses = Raising(net.program), NetVariables(net.program.variables)
    found = (_doubtful(t, raising, uses) for t in net.transitions)
    return tuple(x for x in found if x is not None)


def rows(net: FlatNet) -> list[dict[str, str]]:
    """As plain data: `transition`, what `raises`, what is `beside` it, and `where` alone: `CPN Tools` or `here`."""
    return [
        {
            "transition": x.transition.name,
            "raises": _line(x.raises),
            "beside": _line(x.first),
            "where": where,
        }
        for where, found in (("CPN Tools", unsure(net)), ("here", doubtful(net)))
        for x in found
    ]


def not_there(net: FlatNet, transition: int) -> str | None:
    """What is to be said of an exception in a search for bindings of a transition that CPN Tools may not raise."""
    for x in doubtful(net):
        if x.transition.index == transition:
            return (
                f"CPN Tools may look at `{_line(x.first)}` before it computes `{_line(x.raises)}`, and raise "
                "nothing if the former fails; here the latter is computed first"
            )
    return None


def warn(net: FlatNet, d: Diagnostics) -> None:
    """Warn of the first such transitions, of those on a page that is used more than once only once."""
    found = unsure(net)
    first = {x.transition.id: x for x in reversed(found)}
    named = [x for x in found if first[x.transition.id] is x]
    for i, x in enumerate(named[:MOST_NAMED], 1):
        t = x.transition
        more = len(named) - i if i == MOST_NAMED else 0
        d.warning(
            GUARD_ORDER,
            f"CPN Tools may compute `{_line(x.raises)}` of transition `{t.short}` before it looks at "
            f"`{_line(x.first)}`, and stops if it raises an exception then; here the latter is asked first"
            + (f"; and so in {more} more transitions" if more else ""),
            x.raises.span,
            notes=[Note("the transition is here", t.origin)]
            if x.raises.span.origin != t.origin
            else [],
            hint="put both into one condition: `a andalso b`, or `m = (if a then b else c)`",
        )


def _line(e: Exp) -> str:
    return " ".join(e.span.text.split())


def _unsure(t: FlatTransition, raising: Raising, uses: NetVariables) -> Unsure | None:
    found = conditions(t, raising, uses)
    for i, condition in enumerate(found):
        if not condition.may_raise:
            continue
        needs = condition.needs
        hiding: Condition | None = None
        for other in reversed(found[:i]):
            if needs & other.binds:
                needs |= other.needs
            elif other.may_fail:
                hiding = other
        if hiding is not None:
            return Unsure(t, condition.text, hiding.text)
    return None


def _doubtful(t: FlatTransition, raising: Raising, uses: NetVariables) -> Unsure | None:
    found = conditions(t, raising, uses)
    for i, condition in enumerate(found):
        if not condition.may_raise:
            continue
        known = condition.binds
        for other in found[i + 1 :]:
            if other.needs & known:
                known |= other.binds
            elif other.may_fail or other.at[1] != _GUARD:  # a place may be empty
                return Unsure(t, condition.text, other.text)
    return None


def conditions(t: FlatTransition, raising: Raising, uses: NetVariables) -> list[Condition]:
    """All of a transition, in the order in which they are asked here."""
    return sorted(_conditions(t, raising, uses), key=lambda x: x.at)


def _conditions(t: FlatTransition, raising: Raising, uses: NetVariables) -> Iterator[Condition]:
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
                term = _term(t, arc, index)
                names = frozenset(pattern_variables(term.pattern))
                new, needs = names - before, needed(*_texts(term)) - (names - before)
                steps.add((arc, index))
                may = any(map(raising.raise_in, _texts(term)))
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
        if taken.kind not in _TAKING or taken.inscription is None:
            continue
        for j, term in enumerate(taken.inscription.terms):
            if (i, j) in steps:
                continue
            needs, texts = needed(*_texts(term)), _texts(term)
            when = at(needs) if all(map(is_total, texts)) else len(bound) - 1
            may = any(map(raising.raise_in, texts))
            yield Condition((when, _ARC, i), term.value, may, bool(needs), nothing, needs, (i, j))


def _term(t: FlatTransition, arc: int, index: int) -> Term:
    inscription = t.arcs[arc].inscription
    assert inscription is not None
    return inscription.terms[index]


def _texts(term: Term) -> list[Exp]:
    return [term.coefficient, term.value, *([] if term.delay is None else [term.delay])]


def _is_whole(colset: Colset | None) -> bool:
    """Whether a variable of a colour set takes every value of its type."""
    c = None if colset is None else colset.resolved
    return c is None or (c.kind in _WHOLE and c.low is None and c.high is None and c.length is None)
