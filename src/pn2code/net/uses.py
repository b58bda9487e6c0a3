"""Which net variables an expression uses, and where first.

CPN Tools goes by the names in an arc inscription or a guard. It knows that `let val` hides a variable in the body; but
what `fn`, `case`, `handle` or an earlier `val` of the same `let` hides counts as the variable, and so does the last
part of `List.hd`. Such a variable has to be bound, too: `seen` finds it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from pn2code.diagnostics import Span
from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Case,
    Con,
    Dec,
    Exp,
    Handle,
    If,
    Lambda,
    Let,
    ListExp,
    PAs,
    Pat,
    PCon,
    PRecord,
    PVar,
    Raise,
    RecBind,
    RecordExp,
    Select,
    Sequence,
    Symbol,
    ValBind,
    Var,
    While,
)

Uses = dict[Symbol, Span]
"""Variables in order of first use, with the place of that use."""


def children(e: Exp) -> Iterator[Exp]:
    """The expressions directly inside, left to right."""
    match e:
        case Apply(function, argument):
            yield function
            yield argument
        case Lambda(rules):
            yield from (r.body for r in rules)
        case RecordExp(fields):
            yield from (x for _, x in fields)
        case Select():
            yield e.record
        case ListExp(items) | Sequence(items):
            yield from items
        case If(condition, then, otherwise):
            yield condition
            yield then
            yield otherwise
        case Case(scrutinee, rules):
            yield scrutinee
            yield from (r.body for r in rules)
        case Let(declarations, body):
            for declaration in declarations:
                if isinstance(declaration, ValBind):
                    yield declaration.value
                elif isinstance(declaration, RecBind):
                    yield from (f for _, f in declaration.bindings)
            yield body
        case While(condition, body):
            yield condition
            yield body
        case Raise(exception):
            yield exception
        case Handle(body, rules):
            yield body
            yield from (r.body for r in rules)
        case _:
            return


def walk(e: Exp) -> Iterator[Exp]:
    """The expression and all inside it, in order of the text; without recursion, since texts may be long."""
    stack = [e]
    while stack:
        x = stack.pop()
        yield x
        stack.extend(reversed(list(children(x))))


class NetVariables:
    """Finds uses of net variables."""

    def __init__(self, variables: Mapping[str, Symbol]) -> None:
        self.uids = {s.uid for s in variables.values()}
        self.names = dict(variables)

    def of(self, *expressions: Exp | None) -> Uses:
        """Net variables of the expressions (None is skipped)."""
        found: Uses = {}
        for e in expressions:
            if e is None:
                continue
            for x in walk(e):
                if isinstance(x, Var) and x.symbol.uid in self.uids:
                    found.setdefault(x.symbol, x.span)
        return found

    def seen(self, *expressions: Exp | None) -> Uses:
        """Net variables that CPN Tools sees in the expressions of an arc or a guard (None is skipped)."""
        found = self.of(*expressions)
        for symbol, span in self.sights(*expressions):
            found.setdefault(symbol, span)
        return found

    def sights(self, *expressions: Exp | None) -> Iterator[tuple[Symbol, Span]]:
        """Where CPN Tools sees variables of the net, in order of the text."""
        stack = [(e, _NOTHING) for e in reversed(expressions) if e is not None]
        while stack:
            e, hidden = stack.pop()
            if isinstance(e, Var | Builtin | Con):
                name = e.span.text.rpartition(".")[2]
                if name in self.names and name not in hidden:
                    yield self.names[name], e.span
            elif isinstance(e, Let):
                own = {s.name for declaration in e.declarations for s in _declared(declaration)}
                *values, body = children(e)
                stack.append((body, hidden | own))
                stack += [(value, hidden) for value in reversed(values)]
            else:
                stack += [(x, hidden) for x in reversed(list(children(e)))]

    def is_net_variable(self, symbol: Symbol) -> bool:
        """Whether the symbol is a net variable (and not a local or global of that name)."""
        return symbol.uid in self.uids


_NOTHING: frozenset[str] = frozenset()


def _declared(declaration: Dec) -> tuple[Symbol, ...]:
    """What a declaration gives names to."""
    match declaration:
        case ValBind(pattern):
            return pattern_variables(pattern)
        case RecBind(bindings):
            return tuple(symbol for symbol, _ in bindings)
        case _:
            return ()


def walk_pattern(pattern: Pat) -> Iterator[Pat]:
    """The pattern and all inside it, left to right."""
    stack = [pattern]
    while stack:
        p = stack.pop()
        yield p
        match p:
            case PAs(_, inner):
                stack.append(inner)
            case PRecord(fields):
                stack.extend(x for _, x in reversed(fields))
            case PCon(_, argument) if argument is not None:
                stack.append(argument)
            case _:
                pass


def pattern_variables(pattern: Pat | None) -> tuple[Symbol, ...]:
    """Variables of a pattern, left to right, repeated ones once."""
    parts = () if pattern is None else walk_pattern(pattern)
    return tuple(dict.fromkeys(p.symbol for p in parts if isinstance(p, PVar | PAs)))


def merge(parts: Iterable[Uses]) -> Uses:
    """All uses, first ones kept."""
    found: Uses = {}
    for part in parts:
        for symbol, span in part.items():
            found.setdefault(symbol, span)
    return found
