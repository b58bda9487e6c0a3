"""The built-in functions, found by their full names; here those on numbers, references, time and chance.

A function is called with the evaluator and its curried arguments; a tuple is one argument. It gives a value, or a
task (see `evaluate`) when it calls functions of the net.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any

from pn2code.ml.colsets import Colset
from pn2code.semantics import builtins_lists, builtins_multisets, builtins_random, builtins_text
from pn2code.semantics.values import (
    MAX_INT,
    MIN_INT,
    NONE,
    UNIT,
    Data,
    MlException,
    Native,
    Ref,
    Timed,
    Value,
    equal,
    exception,
    int_text,
    order,
    real_text,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluate import Evaluator, Task

Function = Callable[..., Any]


def fail(name: str, argument: Value | None = None) -> MlException:
    """The built-in exception of that name, to be raised."""
    return MlException(exception(name, argument))


# --- integers ----------------------------------------------------------------------------------


def checked(i: int) -> int:
    """The same number as an `int`; raises Overflow beyond 31 bits."""
    if not MIN_INT <= i <= MAX_INT:
        raise fail("Overflow")
    return i


def _nonzero(i: int) -> int:
    if i == 0:
        raise fail("Div")
    return i


def _quot(a: int, b: int) -> int:
    q = abs(a) // abs(_nonzero(b))
    return q if (a < 0) == (b < 0) else -q


def _power(base: int, exponent: int) -> int:
    if exponent >= 0:
        return int(base**exponent)
    if base in (1, -1):
        return int(base ** (-exponent))
    return 1 // _nonzero(base) if base == 0 else 0


def _sign(x: float) -> int:
    return (x > 0) - (x < 0)


def _int_from_string(text: str) -> int | None:
    found = re.match(r"\s*([~+-]?)([0-9]+)", text)
    if found is None:
        return None
    return -int(found[2]) if found[1] in ("~", "-") else int(found[2])


def _option(value: Value | None) -> Data:
    return NONE if value is None else some(value)


def _integers(structure: str, fit: Callable[[int], int]) -> dict[str, tuple[int, Function]]:
    """The operations of `Int` or `IntInf`; `fit` checks a result."""

    def from_string(e: Evaluator, text: str) -> Data:
        found = _int_from_string(text)
        return _option(None if found is None else fit(found))

    operations: dict[str, Function] = {
        "+": lambda e, p: fit(p[0] + p[1]),
        "-": lambda e, p: fit(p[0] - p[1]),
        "*": lambda e, p: fit(p[0] * p[1]),
        "~": lambda e, a: fit(-a),
        "abs": lambda e, a: fit(abs(a)),
        # Python's // and % round down, as SML's div and mod do
        "div": lambda e, p: fit(p[0] // _nonzero(p[1])),
        "mod": lambda e, p: fit(p[0] % _nonzero(p[1])),
        "quot": lambda e, p: fit(_quot(p[0], p[1])),
        "rem": lambda e, p: fit(p[0] - p[1] * _quot(p[0], p[1])),
        "min": lambda e, p: min(p[0], p[1]),
        "max": lambda e, p: max(p[0], p[1]),
        "sign": lambda e, a: _sign(a),
        "sameSign": lambda e, p: _sign(p[0]) == _sign(p[1]),
        "toString": lambda e, a: int_text(a),
        "fromString": from_string,
        "toLarge": lambda e, a: a,
        "fromLarge": lambda e, a: fit(a),
        "toInt": lambda e, a: checked(a),
        "fromInt": lambda e, a: a,
        "pow": lambda e, p: fit(_power(p[0], p[1])),
    }
    return {f"{structure}.{name}": (1, f) for name, f in operations.items()}


def _comparisons(structure: str) -> dict[str, tuple[int, Function]]:
    operations: dict[str, Function] = {
        "<": lambda e, p: p[0] < p[1],
        "<=": lambda e, p: p[0] <= p[1],
        ">": lambda e, p: p[0] > p[1],
        ">=": lambda e, p: p[0] >= p[1],
        "compare": lambda e, p: order(p[0], p[1]),
    }
    return {f"{structure}.{name}": (1, f) for name, f in operations.items()}


# --- reals -------------------------------------------------------------------------------------


def divide(a: float, b: float) -> float:
    """IEEE division: by zero it is infinite, or not a number."""
    if b != 0:
        return a / b
    if a == 0 or math.isnan(a):
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def _rounded(how: Callable[[float], int]) -> Function:
    def function(e: Evaluator, x: float) -> int:
        if math.isnan(x):
            raise fail("Domain")
        if math.isinf(x):
            raise fail("Overflow")
        return checked(how(x))

    return function


def _rounded_real(how: Callable[[float], int]) -> Function:
    def function(e: Evaluator, x: float) -> float:
        return math.copysign(float(how(x)), x) if math.isfinite(x) else x

    return function


def _compare_reals(e: Evaluator, p: tuple[float, float]) -> Data:
    if math.isnan(p[0]) or math.isnan(p[1]):
        raise fail("Domain")
    return order(p[0], p[1])


def _sign_of_real(e: Evaluator, x: float) -> int:
    if math.isnan(x):
        raise fail("Domain")
    return _sign(x)


def _smaller(p: tuple[float, float]) -> float:
    return p[1] if math.isnan(p[0]) or p[1] < p[0] else p[0]


def _larger(p: tuple[float, float]) -> float:
    return p[1] if math.isnan(p[0]) or p[1] > p[0] else p[0]


def _remainder(a: float, b: float) -> float:
    if math.isinf(a) or b == 0:
        return math.nan
    return math.fmod(a, b)


def real_from_string(text: str) -> float | None:
    """After blanks, a number in SML's or C's way; the rest is ignored."""
    found = re.match(r"\s*([~+-]?)([0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE]([~+-]?)([0-9]+))?", text)
    if found is None:
        return None
    exponent = (found[3] or "").replace("~", "-") + (found[4] or "0")
    number = float(f"{found[2]}e{exponent}")
    return -number if found[1] in ("~", "-") else number


def _real_of(i: int) -> float:
    try:
        return float(i)
    except OverflowError:
        return math.copysign(math.inf, i)


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
    "ceil": _rounded(math.ceil),
    "round": _rounded(round),
    "trunc": _rounded(math.trunc),
    "realFloor": _rounded_real(math.floor),
    "realCeil": _rounded_real(math.ceil),
    "realRound": _rounded_real(round),
    "realTrunc": _rounded_real(math.trunc),
    "isNan": lambda e, a: math.isnan(a),
    "isFinite": lambda e, a: math.isfinite(a),
    "toString": lambda e, a: real_text(a),
    "fromString": lambda e, text: _option(real_from_string(text)),
}


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
    """C's `pow`."""
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


# --- references, general, time ------------------------------------------------------------------


def _assign(ref: Ref, value: Value) -> Value:
    ref.contents = value
    return UNIT


def _update(change: Callable[[Any, Any], Value]) -> Function:
    return lambda e, p: _assign(p[0], change(p[0].contents, p[1]))


def _compose(e: Evaluator, functions: tuple[Value, Value], argument: Value) -> Task:
    from pn2code.semantics.evaluate import Tail

    inner = yield e.call(functions[1], argument)
    return Tail(e.call(functions[0], inner))


def _print(e: Evaluator, text: str) -> Value:
    e.output(text)
    return UNIT


def _message(exn: Data) -> str:
    return f"{exn.name}: {exn.argument}" if isinstance(exn.argument, str) else exn.name


def _truth_from_string(text: str) -> Data:
    found = re.match(r"\s*(true|false)", text, re.IGNORECASE)
    return _option(found and found[1].lower() == "true")


GENERAL: dict[str, tuple[int, Function]] = {
    "=": (1, lambda e, p: equal(p[0], p[1])),
    "<>": (1, lambda e, p: not equal(p[0], p[1])),
    "Bool.not": (1, lambda e, a: not a),
    "Bool.toString": (1, lambda e, a: "true" if a else "false"),
    "Bool.fromString": (1, lambda e, text: _truth_from_string(text)),
    "Ref.ref": (1, lambda e, a: Ref(a)),
    "Ref.!": (1, lambda e, ref: ref.contents),
    "Ref.:=": (1, lambda e, p: _assign(p[0], p[1])),
    "Ref.+=": (1, _update(lambda a, b: checked(a + b))),
    "Ref.-=": (1, _update(lambda a, b: checked(a - b))),
    "Ref.*=": (1, _update(lambda a, b: checked(a * b))),
    "Ref.::=": (1, _update(lambda items, item: (item, *items))),
    "Ref.inc": (1, lambda e, ref: _assign(ref, checked(ref.contents + 1))),
    "Ref.dec": (1, lambda e, ref: _assign(ref, checked(ref.contents - 1))),
    "General.o": (2, _compose),
    "General.before": (1, lambda e, p: p[0]),
    "General.ignore": (1, lambda e, a: UNIT),
    "General.exnName": (1, lambda e, exn: exn.name),
    "General.exnMessage": (1, lambda e, exn: _message(exn)),
    "TextIO.print": (1, _print),
}


def _delay(e: Evaluator, p: tuple[tuple[Value, ...], Any]) -> Value:
    return tuple(Timed(value, e.now + p[1]) for value in p[0])


def _delay_token(e: Evaluator, p: tuple[Value, Any]) -> Value:
    return Timed(p[0], e.now + p[1])


def _to_time(e: Evaluator, i: int) -> float:
    return _real_of(i) if e.real_time else i


def _time_from_string(e: Evaluator, text: str) -> Data:
    return _option(real_from_string(text) if e.real_time else _int_from_string(text))


def _make_time(e: Evaluator, text: str) -> Value:
    found = _time_from_string(e, text)
    if found.argument is None:
        raise fail("Option")
    return found.argument


def time_text(time: float) -> str:
    """A model time as CPN Tools prints it."""
    return real_text(time) if isinstance(time, float) else int_text(time)


TIME: dict[str, tuple[int, Function]] = {
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
    "ModelTime.toReal": (1, lambda e, t: _real_of(t)),
    "ModelTime.maketime": (1, _make_time),
    "ModelTime.add": (1, lambda e, p: p[0] + p[1]),
    "ModelTime.sub": (1, lambda e, p: p[0] - p[1]),
    "ModelTime.mult": (1, lambda e, p: p[0] * p[1]),
    "ModelTime.lt": (1, lambda e, p: p[0] < p[1]),
    "ModelTime.leq": (1, lambda e, p: p[0] <= p[1]),
    "ModelTime.cmp": (1, lambda e, p: order(p[0], p[1])),
}

CONSTANTS: dict[str, Value] = {
    "Math.pi": math.pi,
    "Math.e": math.e,
    "Real.posInf": math.inf,
    "Real.negInf": -math.inf,
    "Int.maxInt": some(MAX_INT),
    "Int.minInt": some(MIN_INT),
    "Int.precision": some(31),
}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **_comparisons("Int"),
    **_comparisons("IntInf"),
    **_comparisons("Real"),
    **_comparisons("String"),
    **_comparisons("Char"),
    **_integers("Int", checked),
    **_integers("IntInf", lambda i: i),
    **{f"Real.{name}": (1, f) for name, f in REALS.items()},
    **{f"Math.{name}": (1, f) for name, f in MATHEMATICS.items()},
    **GENERAL,
    **TIME,
    **builtins_text.FUNCTIONS,
    **builtins_lists.FUNCTIONS,
    **builtins_multisets.FUNCTIONS,
    **builtins_random.FUNCTIONS,
}
"""Full name -> number of curried arguments, function."""


@cache
def builtin(name: str) -> Value:
    """The built-in value or function of that full name; KeyError (a bug in pn2code) when there is none."""
    if name in CONSTANTS:
        return CONSTANTS[name]
    arity, function = FUNCTIONS[name]
    return Native(name, arity, function)


# --- functions of a colour set -------------------------------------------------------------------


def colset_builtin(e: Evaluator, name: str, c: Colset) -> Value:
    """A member of a colour set's structure, `Colset.all` at `INT` and so on."""
    member = name.removeprefix("Colset.")
    if member == "base":
        return e.colours.base(c)
    function = _COLSET_FUNCTIONS.get(member)
    if function is None:
        stem, _, rest = member.partition("_")
        function = {"set": _setter, "of": _tester}[stem](rest)
        arity = 2 if stem == "set" else 1
    else:
        arity = 1
    fixed = function
    return Native(f"{c.name}.{member}", arity, lambda e, *arguments: fixed(e, c, *arguments))


_COLSET_FUNCTIONS: dict[str, Function] = {
    "all": lambda e, c, unit: e.colours.all(c),
    "size": lambda e, c, unit: checked(e.colours.size(c)),
    "ord": lambda e, c, a: checked(e.colours.ord(c, a)),
    "col": lambda e, c, i: e.colours.col(c, i),
    "ran": lambda e, c, unit: e.colours.ran(c),
    "lt": lambda e, c, p: e.colours.key(c, p[0]) < e.colours.key(c, p[1]),
    "cmp": lambda e, c, p: order(e.colours.key(c, p[0]), e.colours.key(c, p[1])),
    "legal": lambda e, c, a: e.colours.legal(c, a),
    "illegal_msg": lambda e, c, a: e.colours.illegal_message(c, a),
    "mkstr": lambda e, c, a: e.colours.text(c, a),
    "mkstr_ms": lambda e, c, ms: e.colours.multiset_text(c, ms),
    "mult": lambda e, c, multisets: e.colours.mult(c, multisets),
}


def _setter(label: str) -> Function:
    return lambda e, c, a, component: e.colours.with_component(c, label, a, component)


def _tester(constructor: str) -> Function:
    return lambda e, c, a: a.name == constructor
