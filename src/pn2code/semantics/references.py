"""What a net's references and arrays hold: remembered and put back, when several runs are followed side by side."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pn2code.semantics.evaluate import Evaluator
from pn2code.semantics.values import Array, Closure, Data, Ref, Value


class References:
    """The references and arrays that can be reached from the declarations, in a fixed order.

    Those that come into being later are not followed.
    """

    def __init__(self, evaluator: Evaluator) -> None:
        self._all = tuple(_reachable(evaluator.globals))

    def contents(self) -> tuple[Value, ...]:
        """What they hold."""
        return tuple(r.contents if isinstance(r, Ref) else tuple(r.items) for r in self._all)

    def restore(self, contents: tuple[Value, ...]) -> None:
        """Let them hold what they held."""
        for found, value in zip(self._all, contents, strict=True):
            if isinstance(found, Ref):
                found.contents = value
            else:
                assert isinstance(value, tuple)
                found.items[:] = value


def _reachable(start: Any) -> Iterator[Ref | Array]:
    seen: set[int] = set()
    todo: list[Any] = [start]
    while todo:
        item = todo.pop()
        if isinstance(item, int | float | str) or id(item) in seen:
            continue
        seen.add(id(item))
        if isinstance(item, Ref):
            yield item
            todo.append(item.contents)
        elif isinstance(item, Array):
            yield item
            todo.extend(item.items)
        elif isinstance(item, dict):
            todo.extend(item.values())
        elif isinstance(item, tuple | list):
            todo.extend(item)
        elif isinstance(item, Data):
            todo.append(item.argument)
        elif isinstance(item, Closure):
            todo.append(item.environment)
