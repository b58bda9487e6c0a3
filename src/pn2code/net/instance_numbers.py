"""`inst ()`: the number of the page instance that an inscription belongs to, as CPN Tools counts the instances.

The elaborator leaves `Page.inst` in typed inscriptions, which all instances of their page share. When the net is
flattened each instance gets its own inscriptions with its number in them, so that nothing behind knows of `Page.inst`.

In initial markings the engine of CPN Tools has another number, that of the instance that it looked at before (of n
instances mostly n + 1, and the same for all of them); `warn` says so.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

from pn2code.diagnostics import Diagnostics
from pn2code.ml.core.terms import (
    INSTANCE_NUMBER,
    Apply,
    Builtin,
    Lambda,
    Lit,
    PWild,
    RecBind,
    RecordExp,
    Rule,
    Symbol,
    ValBind,
)
from pn2code.ml.core.types import INT, UNIT
from pn2code.net.codes import INITIAL_INSTANCE
from pn2code.net.typed import TypedPage, TypedPlace, TypedTransition
from pn2code.net.uses import pattern_variables

T = TypeVar("T")

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


def mentioned(node: object) -> bool:
    """Whether there is `inst` in an expression, or in something made of expressions."""
    todo = [node]
    while todo:
        one = todo.pop()
        if isinstance(one, tuple):
            todo.extend(one)
        elif isinstance(one, Builtin):
            if one.name == INSTANCE_NUMBER:
                return True
        else:
            todo.extend(getattr(one, name) for name in _parts(type(one)))
    return False


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


class _Numbering:
    def __init__(self, number: int, fresh: Callable[[Symbol], Symbol]) -> None:
        self._number, self._fresh = number, fresh
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
            case Builtin(name=name):
                if name != INSTANCE_NUMBER:
                    return node
                rule = Rule(PWild(UNIT, node.span), Lit(self._number, INT, node.span), node.span)
                return Lambda((rule,), node.type, node.span)
            case Rule(pattern=pattern) | ValBind(pattern=pattern):
                self._rename(pattern_variables(pattern))
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

    def _rename(self, symbols: Iterable[Symbol]) -> None:
        for symbol in symbols:
            if symbol not in self._own:
                self._own[symbol] = self._fresh(symbol)


def mentioning(pages: Iterable[TypedPage]) -> frozenset[str]:
    """Ids of the places and transitions with `inst` in their inscriptions."""
    found: set[str] = set()
    for page in pages:
        nodes: Sequence[TypedPlace | TypedTransition] = (*page.places, *page.transitions)
        found.update(node.id for node in nodes if mentioned(node))
    return frozenset(found)


def warn(pages: Iterable[TypedPage], d: Diagnostics) -> None:
    """Warn of initial markings with `inst`."""
    for page in pages:
        for place in page.places:
            if mentioned(place.initial):
                d.warning(
                    INITIAL_INSTANCE,
                    f"the initial marking of `{place.name}` uses `inst ()`, which may have another value in CPN "
                    "Tools there",
                    place.origin,
                    hint="let a transition put these tokens, or give each instance its number as a token of a "
                    "socket",
                )
