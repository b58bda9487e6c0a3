"""What CPN Tools takes otherwise than it is taken here: values outside a colour set, and `Bind`.

A guard equation may give a variable a value outside its colour set.

    s : colset SMALL = int with 0..3;     [s = n + 5]

CPN Tools looks whether a variable that gets its value from a token has one of its colour set, and does not where it
gets it from an equation (found by experiment, and in its public sources): it finds a binding, and stops if the value
comes into a place whose colour set has it not. Here there is no such binding.

    outside(pattern, value, variables, guards)   # an expression that raises `RAISED` there, else does nothing

`Bind`, raised by a pattern that does not match, means that there is no binding: here everywhere, in CPN Tools only
where a token has been taken or an equation has bound before. Elsewhere it is an exception as others are (found in the
same way: `[f s > 0]` with `fun f x = let val [y] = g x in y end` and all values of `s`).

    bind_raised(e)   # e, but `RAISED` for `Bind`
"""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Case,
    Con,
    Exp,
    Handle,
    If,
    Pat,
    PCon,
    PRecord,
    PVar,
    PWild,
    Raise,
    Rule,
    Symbol,
    Var,
)
from pn2code.ml.core.types import BOOL, EXN, TFun
from pn2code.ml.library.datatypes import FALSE, TRUE
from pn2code.ml.library.exceptions import EXCEPTIONS

RAISED = "Span"
"""The exception; no expression of a net is likely to raise it otherwise."""


def is_restricted(c: Colset | None) -> bool:
    """Whether its type has more values than it."""
    if c is None:
        return False
    match c.kind:
        case Kind.INDEX | Kind.SUBSET:
            return True
        case Kind.ENUM | Kind.UNIT | Kind.BOOL:
            return False
    own = (c.low, c.high, c.length)
    return any(x is not None for x in own) or any(map(is_restricted, c.components))


def holds(pattern: Pat | None, place: Colset, variable: Symbol) -> bool:
    """Whether a place gives a variable values of its colour set only, by this pattern."""
    match pattern:
        case PVar(symbol=symbol):
            return symbol == variable and place.resolved == (variable.colset or place).resolved
        case PRecord(fields=fields):
            c = place.resolved
            labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
            parts = dict(zip(labels, c.components, strict=False))
            return any(
                (part := parts.get(label)) is not None and holds(x, part, variable)
                for label, x in fields
            )
    return False


def outside(pattern: Pat, value: Exp, variables: Sequence[Symbol], guards: Sequence[Exp]) -> Exp:
    """Raises an exception if the value matches, a variable gets a value outside, and the guards hold."""
    span = value.span
    true = Con(TRUE, BOOL, span)
    found: Exp = Raise(Con(EXCEPTIONS[RAISED][0], EXN, span), BOOL, span)
    for guard in reversed(guards):
        found = If(guard, found, true, BOOL, span)
    legal: Exp = true
    for s in reversed(variables):
        legal = If(_is_legal(s, value), legal, Con(FALSE, BOOL, span), BOOL, span)
    body = If(legal, true, found, BOOL, span)
    rules = (Rule(pattern, body, span), Rule(PWild(value.type, span), true, span))
    return Case(value, rules, BOOL, span)


def bind_raised(e: Exp) -> Exp:
    """The same, but another exception for `Bind`."""
    bind = PCon(EXCEPTIONS["Bind"][0], None, EXN, e.span)
    other = Raise(Con(EXCEPTIONS[RAISED][0], EXN, e.span), e.type, e.span)
    return Handle(e, (Rule(bind, other, e.span),), e.type, e.span)


def _is_legal(s: Symbol, where: Exp) -> Exp:
    function = Builtin("Colset.legal", TFun(s.type, BOOL), where.span, (), s.colset)
    return Apply(function, Var(s, s.type, where.span), BOOL, where.span)
