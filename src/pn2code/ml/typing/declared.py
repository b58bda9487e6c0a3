"""What a declaration declares, as far as its syntax says: values, types, modules; the type variables written in it."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from typing import Any

from pn2code.diagnostics import Span
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.environment import BrokenStructure, Scope
from pn2code.ml.typing.patterns import pattern_names

_TYVAR = re.compile(r"(?<![A-Za-z0-9_'])'")
"""Where a type variable may begin."""


def declared_by(dec: s.Dec) -> set[str]:
    """The values that a declaration makes, for the case that it has an error."""
    match dec:
        case s.ValDec():
            return pattern_names([b.pattern for b in dec.bindings])
        case s.FunDec():
            return {b.name for b in dec.bindings if isinstance(b, s.FunBinding)}
        case s.DatatypeDec():
            return {c.name for b in dec.bindings for c in b.constructors}
        case s.ExceptionDec():
            return {b.name for b in dec.bindings}
        case s.LocalDec():
            return {n for x in dec.visible for n in declared_by(x)}
        case s.AbstypeDec():
            return {n for x in dec.declarations for n in declared_by(x)}
        case _:
            return set()


def names_in(part: s.Dec | s.Exp) -> tuple[frozenset[str], frozenset[str]]:
    """The names of expressions in a part of a declaration, and those of its patterns and functions."""
    nodes = list(_nodes(part))
    used = frozenset(one.name for one in nodes if isinstance(one, s.NameExp))
    bound = frozenset(one.name for one in nodes if isinstance(one, s.NamePat | s.FunBinding))
    return used, bound


def type_names_in(dec: s.Dec) -> frozenset[str]:
    """The names of types in a declaration."""
    return frozenset(one.name for one in _nodes(dec) if isinstance(one, s.NameTy))


def _nodes(part: object) -> Iterator[object]:
    """All nodes of a part of the syntax."""
    todo: list[Any] = [part]
    while todo:
        one = todo.pop()
        if isinstance(one, tuple):
            todo.extend(one)
        elif s.is_node(one) and dataclasses.is_dataclass(one):
            yield one
            todo.extend(getattr(one, field.name) for field in dataclasses.fields(one))


def types_declared_by(dec: s.Dec) -> set[str]:
    """The types that a declaration makes."""
    match dec:
        case s.TypeDec():
            return {b.name for b in dec.bindings}
        case s.DatatypeDec():
            return {b.name for b in dec.bindings} | {b.name for b in dec.withtypes}
        case s.DatatypeCopyDec():
            return {dec.name}
        case s.LocalDec():
            return {n for x in dec.visible for n in types_declared_by(x)}
        case s.AbstypeDec():
            inside = {n for x in dec.declarations for n in types_declared_by(x)}
            return types_declared_by(dec.datatypes) | inside
        case _:
            return set()


def break_modules(dec: s.Dec, scope: Scope) -> None:
    """Structures, signatures and functors of a declaration with an error are known as broken."""
    match dec:
        case s.StructureDec():
            scope.structures.update({b.name: BrokenStructure() for b in dec.bindings})
        case s.SignatureDec():
            scope.signatures.update({name: BrokenStructure() for name, _ in dec.bindings})
        case s.FunctorDec():
            scope.functors.update({b.name: BrokenStructure() for b in dec.bindings})
        case s.LocalDec():
            for x in dec.visible:
                break_modules(x, scope)
        case _:
            pass


def written_variables(dec: s.ValDec | s.FunDec) -> list[str]:
    """Type variables written in a declaration, but not in `val` and `fun` inside it."""
    found: dict[str, None] = {}
    source = dec.span.source.text
    if not _TYVAR.search(source, dec.span.start, dec.span.end):
        return []
    stack: list[object] = [*reversed(dec.bindings)]
    while stack:
        node = stack.pop()
        if isinstance(node, s.VarTy):
            found[node.name] = None
        elif isinstance(node, tuple):
            stack.extend(reversed(node))
        elif node is None or isinstance(
            node, s.ValDec | s.FunDec | s.TypeDec | s.DatatypeDec | str | int | float | Span
        ):
            continue  # a type declaration binds its own
        else:
            names = getattr(node, "__slots__", ())
            stack.extend(getattr(node, name) for name in reversed(names))
    return list(found)
