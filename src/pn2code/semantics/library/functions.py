"""What all built-in functions have in common: how they are called, and how they raise."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.values.data import MlException, Value, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


Function = Callable[..., Any]


def fail(name: str, argument: Value | None = None) -> MlException:
    """The built-in exception of that name, to be raised."""
    return MlException(exception(name, argument))


def checked(e: Evaluator, i: int) -> int:
    """The same number as an `int`; raises Overflow beyond its bits."""
    if not e.min_int <= i <= e.max_int:
        raise fail("Overflow")
    return i
