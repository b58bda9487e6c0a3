"""Shapes of core expressions that decide how they are lowered."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.lowering.expressions.matching import is_irrefutable
from pn2code.lowering.expressions.values import children, free_variables
from pn2code.ml.core import terms as core


def nodes(e: core.Exp) -> Iterator[core.Exp]:
    """All subexpressions, the expression first."""
    yield e
    for child in children(e):
        yield from nodes(child)


def size(e: core.Exp) -> int:
    """The number of nodes."""
    return sum(1 for _ in nodes(e))


def is_simple(e: core.Exp) -> bool:
    """Whether it will most likely become a C expression without statements before it."""
    simple = (
        core.Lit
        | core.Var
        | core.Builtin
        | core.Con
        | core.Apply
        | core.RecordExp
        | core.Select
        | core.ListExp
        | core.If
    )
    return all(isinstance(n, simple) for n in nodes(e))


def handled_name(rule: core.Rule) -> str | None:
    """The exception that a handler's pattern names, "" for any; None if it looks at a value."""
    match rule.pattern:
        case core.PWild():
            return ""
        case core.PVar(symbol=symbol) if not _uses(rule.body, symbol.uid):
            return ""
        case core.PCon(constructor=c, argument=None | core.PWild()):
            return c.name
    return None


def is_recursive_group(group: core.RecBind) -> bool:
    """Whether a function of the group calls one of it."""
    names = {symbol.uid for symbol, _ in group.bindings}
    return any(not names.isdisjoint(free_variables(f)) for _, f in group.bindings)


def _uses(e: core.Exp, uid: int) -> bool:
    return any(isinstance(n, core.Var) and n.symbol.uid == uid for n in nodes(e))


_OF_REFERENCES = frozenset({":=", "+=", "-=", "*=", "::="})


def escapes(let: core.Let, uid: int) -> bool:
    """Whether a local reference is used otherwise than read and assigned in the function that declares it."""
    return any(_escapes(child, uid, False) for child in children(let))


def _escapes(e: core.Exp, uid: int, is_inside: bool) -> bool:
    """`is_inside`: in a function of its own."""
    match e:
        case core.Var(symbol=symbol):
            return symbol.uid == uid
        case core.Apply(
            function=core.Builtin(name="Ref.!" | "Ref.inc" | "Ref.dec"),
            argument=core.Var(symbol=symbol),
        ):
            return is_inside and symbol.uid == uid
        case core.Apply(
            function=core.Builtin(name=name),
            argument=core.RecordExp(fields=((_, core.Var(symbol=symbol)), (_, value))),
        ) if name.removeprefix("Ref.") in _OF_REFERENCES and symbol.uid == uid:
            return is_inside or _escapes(value, uid, is_inside)
        case core.Lambda():
            is_inside = True
    # Functions of a `fun` in a `let` are lambdas, too.
    return any(_escapes(child, uid, is_inside) for child in children(e))


def covers(rules: tuple[core.Rule, ...]) -> bool:
    """Whether the rules are one for each constructor of a data type, with irrefutable arguments, so that the
    last needs no test."""
    tags: set[int] = set()
    for rule in rules:
        p = rule.pattern
        if not isinstance(p, core.PCon) or p.constructor.siblings == 0:
            return False
        if p.argument is not None and not is_irrefutable(p.argument):
            return False
        tags.add(p.constructor.tag)
    first = rules[0].pattern
    assert isinstance(first, core.PCon)
    return len(tags) == first.constructor.siblings == len(rules)
