"""`inst ()` in typed expressions: where it is asked, and the same with a number for it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from pn2code.diagnostics import Span
from pn2code.ml.core.terms import (
    INSTANCE_NUMBER,
    Apply,
    Builtin,
    DatatypeDec,
    Dec,
    Lambda,
    Lit,
    PAs,
    PVar,
    PWild,
    RecBind,
    RecordExp,
    Rule,
    Symbol,
    ValBind,
)
from pn2code.ml.core.types import EXN, INT, UNIT, TCon, TFun, TRecord, Type

T = TypeVar("T")
OPENED = 1
"""What it is while the net is opened: no page instance has been looked at yet."""
_LEAVES = frozenset({"type", "span", "inst", "colset", "constructor", "origin"})
_PARTS: dict[type, tuple[str, ...]] = {}


def _parts(of: type) -> tuple[str, ...]:
    """The attributes of a class that may hold expressions."""
    found = _PARTS.get(of)
    if found is None:
        has_parts = dataclasses.is_dataclass(of) and of is not Symbol
        names = [f.name for f in dataclasses.fields(of)] if has_parts else []
        found = _PARTS[of] = tuple(name for name in names if name not in _LEAVES)
    return found


def _nodes(node: object) -> Iterator[object]:
    """All parts of an expression, or of something made of expressions."""
    todo = [node]
    while todo:
        one = todo.pop()
        if isinstance(one, tuple):
            todo.extend(one)
        else:
            yield one
            todo.extend(getattr(one, name) for name in _parts(type(one)))


def asked_at(node: object) -> Span | None:
    """Where there is `inst` in an expression, or in something made of expressions."""
    for one in _nodes(node):
        if isinstance(one, Builtin) and one.name == INSTANCE_NUMBER:
            return one.span
    return None


def mentioned(node: object) -> bool:
    """Whether there is `inst` in an expression, or in something made of expressions."""
    return asked_at(node) is not None


def numbered(node: T, number: int, fresh: Callable[[Symbol], Symbol]) -> T:
    """The same on the instance of this number; what does not mention `inst` is the same object.

    Args:
        node: an expression, or something made of expressions.
        number: of the instance.
        fresh: makes another symbol of the same name and type. What an inscription binds itself gets new ones, since a
            function that it declares is another one on each instance.
    """
    if not mentioned(node):
        return node
    made: T = _Numbering(number, fresh).of(node)
    return made


def opened(node: T) -> T:
    """The same while the net is opened."""
    return numbered(node, OPENED, _same)


def opened_outside(node: T) -> T:
    """The same while the net is opened, but for what functions in it ask, whenever they are called."""
    if not mentioned(node):
        return node
    made: T = _Numbering(OPENED, _same, functions=False).of(node)
    return made


def _same(symbol: Symbol) -> Symbol:
    return symbol


def kept_function(dec: Dec, datatypes: Mapping[str, DatatypeDec]) -> str:
    """Of a declaration with `inst`: how a function that asks later on may be kept of it; "" if none is."""
    if isinstance(dec, RecBind):
        return "a function of its own"
    if isinstance(dec, ValBind) and holds_functions(dec.value.type, datatypes):
        return "a value that may hold a function"
    return ""


def holds_functions(t: Type, datatypes: Mapping[str, DatatypeDec]) -> bool:
    """Whether there may be functions in values of a type."""
    seen: set[str] = set()
    todo = [t]
    while todo:
        one = todo.pop()
        if isinstance(one, TFun) or one == EXN:
            return True
        if isinstance(one, TRecord):
            todo.extend(part for _, part in one.fields)
        elif isinstance(one, TCon):
            todo.extend(one.args)
            if one.name in datatypes and one.name not in seen:
                seen.add(one.name)
                todo.extend(a for _, a in datatypes[one.name].constructors if a is not None)
    return False


def stores_functions(decs: Iterable[Dec], datatypes: Mapping[str, DatatypeDec]) -> bool:
    """Whether something declared can be given functions later on, for all that its type says."""
    fixed = ("list", "option", "vector")
    return any(
        one.name not in fixed and holds_functions(one, datatypes)
        for dec in decs
        if isinstance(dec, ValBind)
        for one in _constructors(dec.value.type)
    )


def _constructors(t: Type) -> Iterator[TCon]:
    """The type constructors in a type."""
    todo = [t]
    while todo:
        one = todo.pop()
        if isinstance(one, TRecord):
            todo.extend(part for _, part in one.fields)
        elif isinstance(one, TFun):
            todo.extend((one.argument, one.result))
        elif isinstance(one, TCon):
            yield one
            todo.extend(one.args)


class _Numbering:
    def __init__(
        self, number: int, fresh: Callable[[Symbol], Symbol], *, functions: bool = True
    ) -> None:
        self._number, self._fresh, self._functions = number, fresh, functions
        self._own: dict[Symbol, Symbol] = {}

    def of(self, node: Any) -> Any:
        match node:
            case tuple():
                parts = tuple(self.of(x) for x in node)
                return parts if any(a is not b for a, b in zip(parts, node, strict=True)) else node
            case Symbol():
                return self._own.get(node, node)
            case Apply(function=Builtin(name=name), argument=RecordExp(fields=())) if (
                name == INSTANCE_NUMBER
            ):
                return Lit(self._number, INT, node.span)
            case Builtin() | Lambda() if not self._functions:
                return node
            case Builtin(name=name):
                if name != INSTANCE_NUMBER:
                    return node
                rule = Rule(PWild(UNIT, node.span), Lit(self._number, INT, node.span), node.span)
                return Lambda((rule,), node.type, node.span)
            case Rule(pattern=pattern) | ValBind(pattern=pattern):
                self._rename(n.symbol for n in _nodes(pattern) if isinstance(n, PVar | PAs))
            case RecBind(bindings=bindings):
                self._rename(symbol for symbol, _ in bindings)
            case _:
                pass
        changed = {}
        for name in _parts(type(node)):
            old = getattr(node, name)
            new = self.of(old)
            if new is not old:
                changed[name] = new
        return replace(node, **changed) if changed else node

    def _rename(self, symbols: Iterator[Symbol]) -> None:
        for symbol in symbols:
            if symbol not in self._own:
                self._own[symbol] = self._fresh(symbol)
