"""The functions of `Math`: those of C, with the answers of C where Python raises exceptions."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.semantics.library.functions import Function

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


def _quiet(name: str) -> Function:
    """A function of C's mathematics library with C's answers where Python raises exceptions."""
    function: Callable[[float], float] = getattr(math, name)

    def quiet(e: Evaluator, x: float) -> float:
        try:
            return function(x)
        except ValueError:
            return math.nan  # outside the domain
        except OverflowError:
            return -math.inf if name == "sinh" and x < 0 else math.inf

    return quiet


def _logarithm(function: Callable[[float], float]) -> Function:
    def quiet(e: Evaluator, x: float) -> float:
        if x == 0:
            return -math.inf
        return function(x) if x > 0 else math.nan

    return quiet


def power(a: float, b: float) -> float:
    """C's `pow`, but where SML says that there is no number."""
    if math.isnan(b) or (math.isinf(b) and abs(a) == 1):
        return math.nan
    try:
        return math.pow(a, b)
    except OverflowError:
        return -math.inf if a < 0 and math.fmod(b, 2) in (1.0, -1.0) else math.inf
    except ValueError:
        if a == 0 and b < 0:
            odd = math.fmod(b, 2) in (1.0, -1.0)
            return math.copysign(math.inf, a) if odd else math.inf
        return math.nan


MATHEMATICS: dict[str, Function] = {
    **{
        name: _quiet(name)
        for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "sinh", "cosh", "tanh")
    },
    "ln": _logarithm(math.log),
    "log10": _logarithm(math.log10),
    "atan2": lambda e, p: math.atan2(p[0], p[1]),
    "pow": lambda e, p: power(p[0], p[1]),
}  # fmt: skip
