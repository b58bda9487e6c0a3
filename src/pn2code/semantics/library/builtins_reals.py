"""Built-in functions on reals."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from pn2code.semantics.library.builtins_integers import sign
from pn2code.semantics.library.builtins_real_texts import is_negative, scan_real
from pn2code.semantics.library.builtins_scan import from_string
from pn2code.semantics.library.functions import Function, checked, fail
from pn2code.semantics.values.data import Data, order, real_text

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator


def divide(a: float, b: float) -> float:
    """IEEE division: by zero it is infinite, or not a number."""
    if b != 0:
        return a / b
    if a == 0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def _rounded(how: Callable[[float], int]) -> Function:
    return lambda e, x: checked(e, how(whole_real(x)))


def ceiling(x: float) -> int:
    """The integer that SML/NJ's `ceil` gives: its sum rounds, so that 3.0000000000000004 is 3 and 1E~20 is 0."""
    return -1 - math.floor(-1.0 - x)


def _rounded_real(how: Callable[[float], int]) -> Function:
    def function(e: Evaluator, x: float) -> float:
        # What is rounded to zero has no sign there; a zero keeps its own.
        return float(how(x)) if math.isfinite(x) and x != 0.0 else x

    return function


def _compare_reals(e: Evaluator, p: tuple[float, float]) -> Data:
    if math.isnan(p[0]) or math.isnan(p[1]):
        raise fail("Unordered")
    return order(p[0], p[1])


def _sign_of_real(e: Evaluator, x: float) -> int:
    if math.isnan(x):
        raise fail("Domain")
    return sign(x)


def _smaller(p: tuple[float, float]) -> float:
    return p[0] if p[0] < p[1] or math.isnan(p[1]) else p[1]


def _larger(p: tuple[float, float]) -> float:
    return p[0] if p[0] > p[1] or math.isnan(p[1]) else p[1]


def _remainder(a: float, b: float) -> float:
    if math.isinf(a) or b == 0:
        return math.nan
    # Where nothing remains, the zero has the sign of the divisor.
    return math.fmod(a, b) or math.copysign(0.0, b)


MODES: dict[str, Callable[[float], int]] = {
    "TO_NEAREST": round,
    "TO_NEGINF": math.floor,
    "TO_POSINF": math.ceil,
    "TO_ZERO": math.trunc,
}


def whole_real(x: float) -> float:
    """The same number, of which an integer can be made.

    Raises:
        MlException: Domain for what is no number, Overflow for what is infinite.
    """
    if math.isnan(x):
        raise fail("Domain")
    if math.isinf(x):
        raise fail("Overflow")
    return x


def _mantissa(x: float) -> tuple[int, float]:
    """`Real.toManExp`, a record in the order exp, man."""
    man, exp = math.frexp(x)
    return exp, man


def _from_mantissa(p: tuple[int, float]) -> float:
    try:
        return math.ldexp(p[1], p[0])
    except OverflowError:
        return math.copysign(math.inf, p[1])


def _parts(x: float) -> tuple[float, float]:
    """`Real.split`, a record in the order frac, whole."""
    if math.isinf(x):
        return math.nan, x  # the engine takes the one from the other
    if math.isnan(x):
        return x, x
    whole = x if x == 0.0 else math.trunc(x) + 0.0
    return x - whole, whole


def _check_float(x: float) -> float:
    if math.isinf(x):
        raise fail("Overflow")
    if math.isnan(x):
        raise fail("Div")
    return x


def _real_of(i: int) -> float:
    try:
        return float(i)
    except OverflowError:
        return math.inf if i > 0 else -math.inf


REALS: dict[str, Function] = {
    "+": lambda e, p: p[0] + p[1],
    "-": lambda e, p: p[0] - p[1],
    "*": lambda e, p: p[0] * p[1],
    "/": lambda e, p: divide(p[0], p[1]),
    "~": lambda e, a: -a,
    "abs": lambda e, a: abs(a),
    "==": lambda e, p: p[0] == p[1],
    "!=": lambda e, p: p[0] != p[1],
    "min": lambda e, p: _smaller(p),
    "max": lambda e, p: _larger(p),
    "sign": _sign_of_real,
    "compare": _compare_reals,
    "rem": lambda e, p: _remainder(p[0], p[1]),
    "fromInt": lambda e, a: float(a),
    "fromLargeInt": lambda e, a: _real_of(a),
    "floor": _rounded(math.floor),
    "ceil": _rounded(ceiling),
    "round": _rounded(round),
    "trunc": _rounded(math.trunc),
    "realFloor": _rounded_real(math.floor),
    "realCeil": _rounded_real(math.ceil),
    "realRound": _rounded_real(round),
    "realTrunc": lambda e, x: math.trunc(x) + 0.0 if math.isfinite(x) else x,
    "isNan": lambda e, a: math.isnan(a),
    "isFinite": lambda e, a: math.isfinite(a),
    "toString": lambda e, a: real_text(a),
    "fromString": from_string(scan_real),
    "*+": lambda e, p: p[0] * p[1] + p[2],
    "*-": lambda e, p: p[0] * p[1] - p[2],
    "?=": lambda e, p: p[0] == p[1] or math.isnan(p[0]) or math.isnan(p[1]),
    "unordered": lambda e, p: math.isnan(p[0]) or math.isnan(p[1]),
    "signBit": lambda e, a: is_negative(a),
    "sameSign": lambda e, p: is_negative(p[0]) == is_negative(p[1]),
    "copySign": lambda e, p: math.copysign(p[0], -1.0 if is_negative(p[1]) else 1.0),
    "isNormal": lambda e, a: math.isfinite(a) and abs(a) >= sys.float_info.min,
    "toManExp": lambda e, a: _mantissa(a),
    "fromManExp": lambda e, p: _from_mantissa(p),
    "split": lambda e, a: _parts(a),
    "realMod": lambda e, a: _parts(a)[0],
    "nextAfter": lambda e, p: math.nextafter(p[0], p[1]),
    "checkFloat": lambda e, a: _check_float(a),
    "toLarge": lambda e, a: a,
}
