"""Whether the value of an expression depends on its variables alone."""

from __future__ import annotations

import dataclasses
from typing import Any

from pn2code.ml.core.terms import Builtin, Dec, Program, RecBind, Symbol, ValBind, Var
from pn2code.semantics.evaluation.effects import effects_of_builtin

_MORE = ("TextIO.", "IO.", "OS.", "Time.time", "Array.", "CPN'")
"""Structures whose functions are not taken for pure, whatever they do; the model time is no part of an expression."""


def impure(exp: Any, program: Program) -> str:
    """The name of something in an expression, or in a function that it uses, whose value may change; "" if none."""
    bodies: dict[Symbol, Any] = {}
    for declaration in program.declarations:
        _enter(declaration, bodies)
    seen: set[Symbol] = set()
    todo = [exp]
    while todo:
        node = todo.pop()
        match node:
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
                todo.extend(
                    getattr(node, f.name)
                    for f in dataclasses.fields(node)
                    if f.name not in ("type", "span", "symbol", "constructor", "inst")
                )
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
