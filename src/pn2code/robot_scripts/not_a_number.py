"""Whether a comparison may be about no number (NaN), so that `x < 3.0` and `x >= 3.0` are both false.

w : real      may be one: 0.0 / 0.0
n : int       never
real(n)       never
"""

from __future__ import annotations

from collections.abc import Callable

from pn2code.robot_scripts import lists
from pn2code.robot_scripts.names import Names
from pn2code.tdl import tree as t
from pn2code.tdl.types import ELEMENT, NUMBERS, QUANTITIES, Type

MayBeNan = Callable[[t.Expression], bool]
"""Whether the value of an expression may be NaN."""

_REALS = (NUMBERS | QUANTITIES) - {Type.INT}


def may_be_nan(e: t.Expression, names: Names) -> bool:
    """Whether the value of an expression of a script may be NaN; only where that is certain it is said not to be."""
    match e:
        case t.Value() | t.Quantity():
            return False
        case t.Name(name) if name in names.constants:
            declared = names.constants[name].declaration
            return not isinstance(declared, t.Const) or may_be_nan(declared.value, names)
        case t.Name(name) if name in names.variables:
            return names.variables[name].type.type in _REALS
        case t.Unary("-", operand):
            return may_be_nan(operand, names)
        case t.Unary("not"):
            return False
        case t.Binary("+" | "-" | "*", left, right):
            return not (_is_whole(left, names) and _is_whole(right, names))
        case t.Binary(operator):
            return operator == "/"
        case t.CallExpression(
            "floor" | "ceil" | "round" | "trunc" | "text" | "filled" | "count_of"
        ):
            return False
        case t.CallExpression("first_of" | "item_of", (of, *_)):
            found = _items(of, names)
            return found is None or found in _REALS or found is Type.POSE
        case t.CallExpression("real" | "abs" | "min" | "max" | "single", arguments):
            return any(may_be_nan(a, names) for a in arguments)
        case t.Conditional(_, then, otherwise):
            return may_be_nan(then, names) or may_be_nan(otherwise, names)
        case _:
            return True


def _items(e: t.Expression, names: Names) -> Type | None:
    """What the items of a list are."""
    of = lists.type_of(e, {name: v.type.type for name, v in names.variables.items()})
    return ELEMENT.get(of) if of is not None else None


def _is_whole(e: t.Expression, names: Names) -> bool:
    match e:
        case t.Value(value):
            return isinstance(value, int)
        case t.Quantity():
            return False
        case t.Name(name) if name in names.constants:
            declared = names.constants[name].declaration
            return isinstance(declared, t.Const) and _is_whole(declared.value, names)
        case t.Name(name) if name in names.variables:
            return names.variables[name].type.type is Type.INT
        case t.Unary("-", operand):
            return _is_whole(operand, names)
        case t.Binary("+" | "-" | "*", left, right):
            return _is_whole(left, names) and _is_whole(right, names)
        case t.Binary(operator):
            return operator in ("div", "mod")
        case t.CallExpression("floor" | "ceil" | "round" | "trunc" | "count_of"):
            return True
        case t.CallExpression("first_of" | "item_of", (of, *_)):
            return _items(of, names) is Type.INT
        case t.CallExpression("abs" | "min" | "max", arguments):
            return all(_is_whole(a, names) for a in arguments)
        case t.Conditional(_, then, otherwise):
            return _is_whole(then, names) and _is_whole(otherwise, names)
        case _:
            return False
