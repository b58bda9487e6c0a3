"""Values of scripts and the meaning of expressions.

A value is an `int`, `float`, `bool`, `str` or `ScriptPose`, or a tuple of these (a list); a quantity is a `float` in
the base unit of its dimension (mm, deg, s, mm/s). The program has been checked, so types are right; what can still go
wrong (a whole number divided by zero, or too large, the first item of an empty list) raises `ScriptError`. Reals are
those of IEEE 754, as in nets: what is no finite number may be computed with, but not said or carried out.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import astuple
from functools import reduce
from typing import Protocol, assert_never, cast

from pn2code.base.frozen import frozen
from pn2code.robot.approach import pose_before
from pn2code.tdl import tree as t
from pn2code.tdl.types import ELEMENT, MAX_INT, MIN_INT, TYPES_BY_NAME, UNITS, Type


@frozen
class ScriptPose:
    """A pose as scripts and files have it: mm and degrees, fixed-axis XYZ angles."""

    x: float
    y: float
    z: float
    rx: float
    ry: float
    rz: float


Element = int | float | bool | str | ScriptPose
ScriptValue = Element | tuple[Element, ...]


class ScriptError(Exception):
    """The script cannot go on; the message follows the rules of diagnostics."""


class Environment(Protocol):
    """What names mean."""

    def value(self, name: str) -> ScriptValue:
        """The value of a variable or constant; ScriptError if it has none yet."""

    def filled(self, name: str) -> bool:
        """Whether a file holds a message."""


def evaluate(e: t.Expression, env: Environment) -> ScriptValue:
    """The value of an expression."""
    match e:
        case t.Value(value):
            return value
        case t.Quantity(number, unit):
            return number * UNITS[unit].factor
        case t.Name(name):
            return env.value(name)
        case t.Field(record, label):
            return cast(float, getattr(evaluate(record, env), label))
        case t.Unary("not", operand):
            return not evaluate(operand, env)
        case t.Unary(_, operand):
            return _checked(-cast(float, evaluate(operand, env)))
        case t.Binary("and", left, right):
            return bool(evaluate(left, env)) and bool(evaluate(right, env))
        case t.Binary("or", left, right):
            return bool(evaluate(left, env)) or bool(evaluate(right, env))
        case t.Binary(operator, left, right):
            return _binary(operator, evaluate(left, env), evaluate(right, env))
        case t.CallExpression("filled", (t.Name(name),)):
            return env.filled(name)
        case t.CallExpression(function, arguments):
            return _call(function, [evaluate(a, env) for a in arguments])
        case t.Conditional(condition, then, otherwise):
            return evaluate(then if evaluate(condition, env) else otherwise, env)
        case _:
            assert_never(e)


def _checked(value: ScriptValue) -> ScriptValue:
    if isinstance(value, bool | str | ScriptPose | tuple):
        return value
    if isinstance(value, int) and not MIN_INT <= value <= MAX_INT:
        raise ScriptError(f"the integer {value} is out of range (31 bits)")
    return value


def _quotient(x: float, y: float) -> float:
    if y != 0:
        return x / y
    if x == 0 or math.isnan(x):
        return math.nan
    return math.copysign(math.inf, x) * math.copysign(1.0, y)


def _least(a: float, b: float) -> float:
    """As in nets: the second where both are equal (0.0 and -0.0), the other one where one is NaN."""
    return a if a < b or math.isnan(b) else b


def _greatest(a: float, b: float) -> float:
    return a if a > b or math.isnan(b) else b


def _is_equal(a: ScriptValue, b: ScriptValue) -> bool:
    """Reals as IEEE 754 has them; poses and lists as tokens, whose parts are equal where both are NaN."""
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(_is_same, a, b))
    if isinstance(a, ScriptPose) and isinstance(b, ScriptPose):
        pairs = zip(astuple(a), astuple(b), strict=True)
        return all(x == y or (math.isnan(x) and math.isnan(y)) for x, y in pairs)
    return a == b


def _is_same(a: ScriptValue, b: ScriptValue) -> bool:
    """Elements of a list."""
    if isinstance(a, float) and isinstance(b, float) and math.isnan(a) and math.isnan(b):
        return True
    return _is_equal(a, b)


def _binary(operator: str, a: ScriptValue, b: ScriptValue) -> ScriptValue:
    if operator in ("=", "<>"):
        return _is_equal(a, b) is (operator == "=")
    if operator == "&":
        return cast(str, a) + cast(str, b)
    if operator in ("<", "<=", ">", ">="):
        return _ordered(operator, a, b)
    x, y = cast(float, a), cast(float, b)
    if operator in ("div", "mod") and y == 0:
        raise ScriptError("division by zero")
    match operator:
        case "+":
            return _checked(x + y)
        case "-":
            return _checked(x - y)
        case "*":
            return _checked(x * y)
        case "/":
            return _quotient(float(x), float(y))
        case "div":
            return _checked(x // y)
        case "mod":
            return _checked(x % y)
    raise ValueError(operator)


def _ordered(operator: str, a: ScriptValue, b: ScriptValue) -> bool:
    x, y = cast(float, a), cast(float, b)  # or two strings: Python compares both alike
    match operator:
        case "<":
            return x < y
        case "<=":
            return x <= y
        case ">":
            return x > y
        case _:
            return x >= y


def single(value: ScriptValue) -> ScriptValue:
    """Rounded to single precision, component by component; ScriptError if it is too large for that."""
    if isinstance(value, tuple):
        return tuple(cast(Element, single(v)) for v in value)
    if isinstance(value, ScriptPose):
        return ScriptPose(*(cast(float, single(v)) for v in astuple(value)))
    if isinstance(value, float):
        try:
            return cast(float, struct.unpack("<f", struct.pack("<f", value))[0])
        except OverflowError:
            raise ScriptError(f"{value!r} is too large for single precision") from None
    return value


def _half_even(value: float) -> int:
    return round(value)


def _ceiling(value: float) -> int:
    """As the net computes it: SML/NJ's sum rounds, so that 3.0000000000000004 is 3."""
    return -1 - math.floor(-1.0 - value)


_TO_INT: dict[str, Callable[[float], int]] = {
    "floor": math.floor,
    "ceil": _ceiling,
    "round": _half_even,
    "trunc": math.trunc,
}


def _call(function: str, arguments: list[ScriptValue]) -> ScriptValue:
    if function == "pose":
        return ScriptPose(*(float(cast(float, a)) for a in arguments))
    if (of := TYPES_BY_NAME.get(function)) in ELEMENT:
        items = cast(list[Element], arguments)
        # An int may stand where a real is expected.
        return tuple(float(cast(float, x)) if of is Type.REALS else x for x in items)
    first = arguments[0]
    if isinstance(first, tuple):
        return _of_list(function, first, arguments[1:])
    if isinstance(first, ScriptPose) and function == "before":
        return ScriptPose(*pose_before(astuple(first), cast(float, arguments[1])))
    if function == "computed":
        return True
    if function == "text":
        return show(first)
    if function == "single":
        return single(first)
    numbers = [cast(float, a) for a in arguments]
    x = numbers[0]
    match function:
        case "abs":
            return _checked(abs(x))
        case "min":
            return reduce(_least, numbers)
        case "max":
            return reduce(_greatest, numbers)
        case "real":
            return float(x)
        case "sqrt":
            return math.nan if x < 0 else math.sqrt(x)
        case "sin" | "cos" | "tan" | "floor" | "ceil" | "round" | "trunc" if not math.isfinite(x):
            raise ScriptError(f"`{function}` of {x:g}, which is not a finite number")
        case "sin":
            return math.sin(math.radians(x))
        case "cos":
            return math.cos(math.radians(x))
        case "tan":
            return math.tan(math.radians(x))
        case _:
            return _checked(_TO_INT[function](x))


def _of_list(function: str, items: tuple[Element, ...], more: list[ScriptValue]) -> ScriptValue:
    match function:
        case "count_of":
            return _checked(len(items))
        case "first_of" | "rest_of" if not items:
            raise ScriptError(f"`{function}` of an empty list")
        case "first_of":
            return items[0]
        case "rest_of":
            return items[1:]
        case "item_of":
            i = cast(int, more[0])
            if not 0 <= i < len(items):
                raise ScriptError(f"`item_of` of a list of {len(items)}, which has no item {i}")
            return items[i]
        case "with_first":
            return (cast(Element, more[0]), *items)
        case "joined":
            return items + cast(tuple[Element, ...], more[0])
        case "reversed":
            return items[::-1]
        case "single":
            return single(items)
        case "computed":
            return True
        case "text":
            return show(items)
    raise ValueError(function)


def show(value: ScriptValue) -> str:
    """A value as messages print it."""
    match value:
        case bool():
            return "true" if value else "false"
        case float():
            return f"{value:.10g}"
        case ScriptPose():
            return f"pose({', '.join(f'{v:.10g}' for v in astuple(value))})"
        case tuple():
            return f"[{', '.join(map(show, value))}]"
        case _:
            return str(value)
