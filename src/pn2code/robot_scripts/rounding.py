"""Reals that are too large for single precision: where they are stored so, the transition does not occur.

list(rounded(value, shape, names))       # [single(1.0E60 * real(k))]: what must be computed before

What is in single precision already is not looked at, and a constant only if it is too large.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.shapes import Fields, RowsShape, ScalarShape, Shape
from pn2code.robot_scripts.values import Rec, Rows, Scalar, Value
from pn2code.tdl import tree as t
from pn2code.tdl.evaluate import ScriptError, single
from pn2code.tdl.expressions import MAKES


def rounded(value: Value, shape: Shape, names: Names) -> Iterator[t.Expression]:
    """Expressions that fail where a part of the value is too large for how its place keeps it."""
    match value, shape:
        case Scalar(exp), ScalarShape(_, True) if not _is_rounded(exp, names):
            yield t.CallExpression("single", (exp,))
        case Rec(fields), Fields(shapes):
            for label, inner in shapes:
                part = next((v for name, v in fields if name == label), None)
                if part is not None:
                    yield from rounded(part, inner, names)
        case Rows(columns), RowsShape(kept):
            yield from rounded(columns, kept, names)


def _is_rounded(e: t.Expression, names: Names) -> bool:
    match e:
        case t.Value(value) if isinstance(value, float):
            return _fits(value)
        case t.Quantity(value):
            return _fits(value)
        case t.Name(name) if name in names.variables:
            return names.variables[name].type.single
        case t.Name(name) if name in names.constants:
            declared = names.constants[name].declaration
            return isinstance(declared, t.Const) and _is_rounded(declared.value, names)
        case t.Field(inner):
            return _is_rounded(inner, names)
        case t.Unary("-", inner) | t.CallExpression("abs" | "single", (inner,)):
            return _is_rounded(inner, names)
        case t.CallExpression("first_of" | "rest_of" | "item_of" | "reversed", (of, *_)):
            return _is_rounded(of, names)
        case t.CallExpression("pose" | "min" | "max" | "with_first" | "joined", arguments):
            return all(_is_rounded(a, names) for a in arguments)
        case t.CallExpression(function, arguments) if function in MAKES:
            return all(_is_rounded(a, names) for a in arguments)
        case t.CallExpression("real"):
            return True
        case t.Conditional(_, then, otherwise):
            return _is_rounded(then, names) and _is_rounded(otherwise, names)
        case _:
            return False


def _fits(value: float) -> bool:
    try:
        single(value)
    except ScriptError:
        return False
    return True
