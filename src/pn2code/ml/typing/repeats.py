"""Inscriptions that a net has many times are typed once.

The same text at the same types, among the same declarations, has the same meaning everywhere: what differs is where it
stands. Of large nets most inscriptions are repeated (`n`, `()`, `1`p ++ 1`q`), and moving a typed expression to another
place of the file costs a tenth of making it.

Expressions that bind names of their own are not kept: each of those has symbols that no other expression has.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable
from operator import attrgetter
from typing import Any, TypeVar, cast

from pn2code.diagnostics import SourceText, Span
from pn2code.ml.core import terms as core

T = TypeVar("T")

LONGEST = 500
"""Characters of a text that is kept; longer ones are hardly repeated."""

_BINDING = (core.Lambda, core.Case, core.Let, core.Handle)
_NODES = (
    core.Lit, core.Var, core.Builtin, core.Con, core.Apply, core.RecordExp, core.Select, core.ListExp, core.If,
    core.Sequence, core.While, core.Raise,
)  # fmt: skip
_PARTS: dict[type, Callable[[Any], tuple[Any, ...]]] = {
    node: attrgetter(*(f.name for f in dataclasses.fields(node))) for node in _NODES
}


class Repeats:
    """What was made of texts, by key; forgotten when a declaration is made."""

    def __init__(self) -> None:
        self._kept: dict[Hashable, Any] = {}

    def clear(self) -> None:
        """Forget everything: names may mean something else now."""
        self._kept.clear()

    def get(self, key: Hashable, text: SourceText) -> Any:
        """What was kept, moved to where `text` stands; None if nothing was."""
        kept = self._kept.get(key)
        return None if kept is None else _moved(kept, text)

    def keep(self, key: Hashable, text: SourceText, made: T) -> T:
        """Keep an expression, or a tuple with expressions, if it can be moved; gives it back."""
        if len(text.text) <= LONGEST and _is_movable(made, text):
            self._kept[key] = made
        return made


def _is_movable(made: object, text: SourceText) -> bool:
    """Whether all places in it are in `text`, and nothing binds a name."""
    todo = [made]
    while todo:
        x = todo.pop()
        if isinstance(x, Span):
            if x.source is not text:
                return False
        elif isinstance(x, tuple):
            todo += x
        elif isinstance(x, _BINDING):
            return False
        elif x.__class__ in _PARTS:
            todo += _PARTS[x.__class__](x)
    return True


def _moved(x: T, text: SourceText) -> T:
    made: Any
    cls = x.__class__
    if cls is Span:
        span = cast(Span, x)
        made = Span(text, span.start, span.end)
    elif cls is tuple:
        made = tuple([_moved(part, text) for part in cast("tuple[Any, ...]", x)])
    elif cls in _PARTS:
        make: Any = cls
        made = make(*[_moved(part, text) for part in _PARTS[cls](x)])
    else:
        return x
    return cast(T, made)
