"""Shapes of core expressions that decide how they are lowered."""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.lowering.matching import is_irrefutable
from pn2code.lowering.values import children
from pn2code.ml import core


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


def handled_name(pattern: core.Pat) -> str | None:
    """The exception that a handler's pattern names, "" for any; None if it looks at a value."""
    match pattern:
        case core.PWild() | core.PVar():
            return ""
        case core.PCon(constructor=c, argument=None | core.PWild()):
            return c.name
    return None


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
