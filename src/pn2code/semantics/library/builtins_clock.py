"""Built-in functions on time: the model's clock, and SML's `Time` and `Timer`, whose clocks stand still."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_integers import read_integer
from pn2code.semantics.library.builtins_real_texts import read_real
from pn2code.semantics.values.data import (
    NONE,
    UNIT,
    Data,
    MlException,
    Timed,
    Value,
    exception,
    int_text,
    order,
    real_text,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator

Function = Callable[..., Any]


def _delay(e: Evaluator, p: tuple[tuple[Value, ...], Any]) -> Value:
    return tuple(Timed(value, e.now + p[1]) for value in p[0])


def _delay_token(e: Evaluator, p: tuple[Value, Any]) -> Value:
    return Timed(p[0], e.now + p[1])


def real_of(i: int) -> float:
    """The nearest real, infinite when the number is too large."""
    try:
        return float(i)
    except OverflowError:
        return math.copysign(math.inf, i)


def _to_time(e: Evaluator, i: int) -> float:
    return real_of(i) if e.real_time else i


def _time_from_string(e: Evaluator, text: str) -> Data:
    found = read_real(text) if e.real_time else read_integer(text)
    return NONE if found is None else some(found[0])


def _make_time(e: Evaluator, text: str) -> Value:
    found = _time_from_string(e, text)
    if found.argument is None:
        kind = "a real" if e.real_time else "an IntInf"
        raise MlException(exception("CPN'Error", f"maketime: not {kind} : {text}"))
    return found.argument


def time_text(time: float) -> str:
    """A model time as CPN Tools prints it."""
    return real_text(time) if isinstance(time, float) else int_text(time)


# --- SML's time, in nanoseconds --------------------------------------------------------------------

_SECOND = 10**9


def _toward_zero(number: int, unit: int) -> int:
    return number // unit if number >= 0 else -(-number // unit)


def _from_seconds(seconds: float) -> int:
    if not math.isfinite(seconds):
        raise MlException(exception("Domain" if math.isnan(seconds) else "Overflow"))
    return round(seconds * _SECOND)


def seconds_text(time: int, decimals: int) -> str:
    """Seconds, rounded to so many decimals; what lies just between two becomes the even one, as in SML/NJ."""
    if decimals < 0:
        raise MlException(exception("Size"))
    scaled = abs(time) * 10**decimals
    number, rest = divmod(scaled, _SECOND)
    number += 2 * rest > _SECOND or (2 * rest == _SECOND and number % 2 == 1)
    whole, fraction = divmod(number, 10**decimals)
    sign = "~" if time < 0 else ""
    return f"{sign}{whole}" + (f".{fraction:0{decimals}d}" if decimals else "")


def _seconds_from_string(text: str) -> Data:
    found = read_real(text)
    return NONE if found is None or not math.isfinite(found[0]) else some(_from_seconds(found[0]))


_UNITS = {"Seconds": _SECOND, "Milliseconds": 10**6, "Microseconds": 10**3, "Nanoseconds": 1}


def _from_unit(unit: int) -> tuple[int, Function]:
    return 1, lambda e, n: n * unit


def _to_unit(unit: int) -> tuple[int, Function]:
    return 1, lambda e, time: _toward_zero(time, unit)


CONSTANTS: dict[str, Value] = {"Time.zeroTime": 0}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Time.@": (1, lambda e, p: Timed(p[0], p[1])),
    "Time.@+": (1, _delay),
    "Time.@++": (1, _delay),
    "Time.token@+": (1, _delay_token),
    "Time.token@++": (1, _delay_token),
    "Time.+++": (1, lambda e, p: p[0] + p[1]),
    "Time.ms": (1, lambda e, tms: tuple(token.value for token in tms)),
    "Time.time": (1, lambda e, unit: e.now),
    "Time.step": (1, lambda e, unit: e.steps),
    "ModelTime.fromInt": (1, _to_time),
    "ModelTime.fromIntInf": (1, _to_time),
    "ModelTime.fromString": (1, _time_from_string),
    "ModelTime.toString": (1, lambda e, t: time_text(t)),
    "ModelTime.toReal": (1, lambda e, t: real_of(t)),
    "ModelTime.maketime": (1, _make_time),
    "ModelTime.add": (1, lambda e, p: p[0] + p[1]),
    "ModelTime.sub": (1, lambda e, p: p[0] - p[1]),
    "ModelTime.mult": (1, lambda e, p: p[0] * p[1]),
    "ModelTime.lt": (1, lambda e, p: p[0] < p[1]),
    "ModelTime.leq": (1, lambda e, p: p[0] <= p[1]),
    "ModelTime.cmp": (1, lambda e, p: order(p[0], p[1])),
    "Time.now": (1, lambda e, unit: 0),
    "Time.+": (1, lambda e, p: p[0] + p[1]),
    "Time.-": (1, lambda e, p: p[0] - p[1]),
    "Time.fromReal": (1, lambda e, x: _from_seconds(x)),
    "Time.toReal": (1, lambda e, time: time / _SECOND),
    **{f"Time.from{name}": _from_unit(unit) for name, unit in _UNITS.items()},
    **{f"Time.to{name}": _to_unit(unit) for name, unit in _UNITS.items()},
    "Time.toString": (1, lambda e, time: seconds_text(time, 3)),
    "Time.fmt": (2, lambda e, decimals, time: seconds_text(time, decimals)),
    "Time.fromString": (1, lambda e, text: _seconds_from_string(text)),
    **{
        f"Timer.{name}": (1, lambda e, unit: UNIT)
        for name in ("startRealTimer", "totalRealTimer", "startCPUTimer", "totalCPUTimer")
    },
    "Timer.checkRealTimer": (1, lambda e, timer: 0),
    "Timer.checkCPUTimer": (1, lambda e, timer: (0, 0)),
}
"""Full name -> number of curried arguments, function."""
