"""Methods that are lent to parts of their object: where the part would hold the object, which holds the part.

Python frees what holds itself only when it looks for such circles, and looking at all that has been made since the last
time takes much longer than freeing it at once.

    class Whole:
        def __init__(self) -> None:
            self.part = Part(weakly(self.answer))      # otherwise a `Whole` would outlive its last use
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar
from weakref import WeakMethod

P = ParamSpec("P")
T = TypeVar("T")


def weakly(method: Callable[P, T]) -> Callable[P, T]:
    """Calls a method of an object that lives as long as whoever calls this.

    Raises:
        ReferenceError: when it is called and the object has gone.
    """
    found = WeakMethod(method)

    def call(*arguments: P.args, **named: P.kwargs) -> T:
        bound = found()
        if bound is None:
            raise ReferenceError("the object whose method this is has gone")
        return bound(*arguments, **named)

    return call
