"""The symbols in a piece of the core language."""

from __future__ import annotations

from typing import Any

from pn2code.ml.core import terms as core
from pn2code.ml.core.terms import Symbol


def variables(node: core.Exp | core.Pat | core.Dec | core.Rule) -> frozenset[Symbol]:
    """Every symbol used or bound anywhere in a piece of the core language."""
    found: set[Symbol] = set()
    todo: list[Any] = [node]
    while todo:
        item = todo.pop()
        if isinstance(item, Symbol):
            found.add(item)
        elif isinstance(item, tuple):
            todo.extend(item)
        elif type(item).__module__ == core.__name__:
            todo.extend(getattr(item, name) for name in item.__slots__ if name not in _NO_PARTS)
    return frozenset(found)


_NO_PARTS = frozenset({"type", "span", "inst", "colset", "constructor"})
