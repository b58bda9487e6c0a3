"""Values of constant expressions: bounds of colour sets, priorities.

A folder over core, not an evaluator: literals, other constants, arithmetic. What is beyond it is "not a constant".
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping

from pn2code.ml.core import terms as core

Constant = int | float | str | bool

_INT: dict[str, Callable[[int, int], int]] = {
    "Int.+": operator.add,
    "Int.-": operator.sub,
    "Int.*": operator.mul,
    "Int.div": operator.floordiv,
    "Int.mod": operator.mod,
    "Int.min": min,
    "Int.max": max,
}
_WIDER, _NARROWER = ("IntInf.fromInt", "Int.toLarge"), ("IntInf.toInt", "Int.fromLarge")
"""What is no `int` of 31 bits is not computed here: it may be an Overflow."""
_COMPARE: dict[str, Callable[[int, int], bool]] = {
    "Int.<": operator.lt,
    "Int.<=": operator.le,
    "Int.>": operator.gt,
    "Int.>=": operator.ge,
    "=": operator.eq,
    "<>": operator.ne,
}
_REAL: dict[str, Callable[[float, float], float]] = {
    "Real.+": operator.add,
    "Real.-": operator.sub,
    "Real.*": operator.mul,
}


def fold(e: core.Exp, known: Mapping[int, Constant]) -> Constant | None:
    """The value, or None if it is not a constant; `known` has the values of symbols by uid."""
    match e:
        case core.Lit():
            return e.value
        case core.Var():
            return known.get(e.symbol.uid)
        case core.Con() if e.constructor.data_type == "bool":
            return e.constructor.name == "true"
        case core.If():
            condition = fold(e.condition, known)
            if isinstance(condition, bool):
                return fold(e.then if condition else e.otherwise, known)
            return None
        case core.Apply(function=core.Builtin() as function):
            return _apply(function.name, e.argument, known)
        case _:
            return None


def _apply(name: str, argument: core.Exp, known: Mapping[int, Constant]) -> Constant | None:
    if isinstance(argument, core.RecordExp) and len(argument.fields) == 2:
        left, right = (fold(x, known) for _, x in argument.fields)
        return binary(name, left, right)
    return unary(name, fold(argument, known))


def binary(name: str, left: object, right: object) -> Constant | None:
    """The result of an operator of the library; None when it has none, or the operator is none of these."""
    if name == "String.^" and isinstance(left, str) and isinstance(right, str):
        return left + right
    if _is_int(left) and _is_int(right):
        assert isinstance(left, int) and isinstance(right, int)
        if name in _INT:
            return (
                None if name in ("Int.div", "Int.mod") and right == 0 else _INT[name](left, right)
            )
        return _COMPARE[name](left, right) if name in _COMPARE else None
    if isinstance(left, float) and isinstance(right, float):
        if name in _REAL:
            return _REAL[name](left, right)
        return left / right if name == "Real./" and right else None
    return None


def unary(name: str, value: object) -> Constant | None:
    """The same for functions of one argument."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if name in ("Int.~", "IntInf.~", "Real.~") and is_number:
        assert isinstance(value, int | float)
        return -value
    if name == "Int.abs" and _is_int(value):
        assert isinstance(value, int)
        return abs(value)
    if name in (*_WIDER, *_NARROWER) and _is_int(value):
        assert isinstance(value, int)
        return value if name in _WIDER or -(2**30) <= value < 2**30 else None
    if name == "Real.fromInt" and _is_int(value):
        assert isinstance(value, int)
        return float(value)
    if name == "Bool.not" and isinstance(value, bool):
        return not value
    return None


def _is_int(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
