"""Whether the value of an expression depends on its variables alone.

A reference that nothing assigns is a constant: each time it is mentioned, it is for its value (`!limit`). So nobody can
have it under another name, and no function can be given it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterator
from typing import Any

from pn2code.ml.core.terms import (
    Apply,
    Builtin,
    Dec,
    Program,
    PVar,
    RecBind,
    Symbol,
    ValBind,
    Var,
)
from pn2code.ml.core.types import TCon, TRecord, Type
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.effects import effects_of_builtin

_MORE = ("TextIO.", "IO.", "OS.", "Time.time", "Array.", "CPN'")
"""Structures whose functions are not taken for pure, whatever they do; the model time is no part of an expression."""


_NO_TERMS = ("type", "span", "symbol", "constructor", "inst")
_PLAIN = frozenset({"int", "IntInf.int", "real", "string", "char", "bool", "list", "option"})
"""Types whose values hold nothing that may change, unless their parts do; those of colour sets do not either."""


def constants(net: FlatNet) -> frozenset[Symbol]:
    """The references of a net that are constants."""
    made = frozenset(_made(net.program))
    return made - frozenset(_passed_on(net, made)) if made else made


def _made(program: Program) -> Iterator[Symbol]:
    """The references that are declared with their value, which holds nothing that may change."""
    colours = {c.type.name for c in program.colsets.values() if isinstance(c.type, TCon)}
    for declaration in program.declarations:
        match declaration:
            case ValBind(PVar(symbol), Apply(Builtin("Ref.ref"), value)):
                if _is_plain(value.type, _PLAIN | colours):
                    yield symbol


def _is_plain(type_: Type, names: Collection[str]) -> bool:
    match type_:
        case TCon(name, args):
            return name in names and all(_is_plain(x, names) for x in args)
        case TRecord(fields):
            return all(_is_plain(x, names) for _, x in fields)
        case _:
            return False


def _passed_on(net: FlatNet, made: Collection[Symbol]) -> Iterator[Symbol]:
    """Those of them that are mentioned for more than their value."""
    todo: list[Any] = [net.program.declarations]
    todo += [p.initial for p in net.places]
    for t in net.transitions:
        todo += [t.guards, t.plan, t.arcs, t.delay, t.code]
    while todo:
        match todo.pop():
            case Apply(Builtin("Ref.!"), Var()):
                pass
            case Var(symbol):
                if symbol in made:
                    yield symbol
            case tuple() as several:
                todo.extend(several)
            case node if dataclasses.is_dataclass(node):
                todo.extend(_inside(node))
            case _:
                pass


def _inside(node: Any) -> Iterator[Any]:
    yield from (getattr(node, f.name) for f in dataclasses.fields(node) if f.name not in _NO_TERMS)


def impure(exp: Any, program: Program, constant: Collection[Symbol] = ()) -> str:
    """The name of something in an expression, or in a function that it uses, whose value may change; "" if none.

    Args:
        exp: the expression, or several in a tuple.
        program: the declarations.
        constant: references that nothing assigns.
    """
    bodies: dict[Symbol, Any] = {}
    for declaration in program.declarations:
        _enter(declaration, bodies)
    seen: set[Symbol] = set()
    todo = [exp]
    while todo:
        node = todo.pop()
        match node:
            case Apply(Builtin("Ref.!"), Var(symbol)) if symbol in constant:
                todo.append(bodies[symbol].argument)
            case Builtin(name):
                if effects_of_builtin(name) or name.startswith(_MORE):
                    return name
            case Var(symbol):
                if symbol in bodies and symbol not in seen:
                    seen.add(symbol)
                    todo.append(bodies[symbol])
            case tuple():
                todo.extend(node)
            case _ if dataclasses.is_dataclass(node):
                todo.extend(_inside(node))
            case _:
                pass
    return ""


def _enter(declaration: Dec, bodies: dict[Symbol, Any]) -> None:
    match declaration:
        case RecBind(bindings):
            bodies.update(bindings)
        case ValBind(pattern, value):
            todo: list[Any] = [pattern]
            while todo:
                p = todo.pop()
                if isinstance(p, tuple):
                    todo.extend(p)
                elif dataclasses.is_dataclass(p):
                    symbol = getattr(p, "symbol", None)
                    if symbol is not None:
                        bodies[symbol] = value
                    todo.extend(getattr(p, n, None) for n in ("fields", "argument", "pattern"))
        case _:
            pass
