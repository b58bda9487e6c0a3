"""Expressions of a transition, and those whose values nobody wants."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from pn2code.ml.core import terms as core
from pn2code.net.flat import FlatTransition
from pn2code.net.uses import walk


def expressions_of(t: FlatTransition) -> Iterator[tuple[str, core.Exp]]:
    """All expressions of a transition, with the part that each belongs to."""
    for guard in t.guards:
        yield "guard", guard
    for arc in t.arcs:
        if arc.inscription is not None:
            yield "arc inscription", arc.inscription.value
    if t.delay is not None:
        yield "delay", t.delay
    if t.code is not None:
        yield "code segment", t.code.action


def unused_in(e: core.Exp) -> Iterator[core.Exp]:
    """The expressions inside whose values nobody wants."""
    for x in walk(e):
        if isinstance(x, core.Sequence):
            yield from x.items[:-1]
        elif isinstance(x, core.While):
            yield x.body
        elif isinstance(x, core.Apply) and isinstance(x.function, core.Builtin):
            if x.function.name in ("ignore", "General.ignore"):
                yield x.argument
        elif isinstance(x, core.Let):
            used = {y.symbol.uid for y in walk(x) if isinstance(y, core.Var)}
            for declaration in x.declarations:
                if isinstance(declaration, core.ValBind):
                    match declaration.pattern:
                        case core.PWild():
                            yield declaration.value
                        case core.PVar(symbol) if symbol.uid not in used:
                            yield declaration.value
                        case _:
                            pass


def values_of(e: core.Exp) -> Iterable[core.Exp]:
    """The expressions one of which gives the value of `e`."""
    match e:
        case core.If(_, then, otherwise):
            return [*values_of(then), *values_of(otherwise)]
        case core.Case(_, rules):
            return [x for rule in rules for x in values_of(rule.body)]
        case core.Let(body=body):
            return values_of(body)
        case core.Sequence(items):
            return values_of(items[-1])
        case core.RecordExp(fields):
            return [x for _, value in fields for x in values_of(value)]
        case _:
            return [e]


def gives_back(body: core.Exp) -> bool:
    """Whether a function does nothing: it gives back what it gets."""
    match body:
        case core.Lambda((core.Rule(core.PVar(symbol), core.Var(given)),)):
            return symbol == given
        case _:
            return False
