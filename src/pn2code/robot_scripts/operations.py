"""What scripts do to values: comparison, arithmetic, the functions of CPN ML on lists.

builtin("Int.+", value, span)      # the application of a built-in function
equal(a, b, span)                  # `a = b`, as a script says it
cons(item, of, span)               # `item :: of`
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import Type
from pn2code.robot_scripts import lists
from pn2code.robot_scripts.shapes import Fields, RowsShape, ScalarShape, shape_of_type
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import (
    FALSE,
    TRUE,
    Rec,
    Rows,
    Scalar,
    Value,
    as_real,
    common,
    conjunction,
)
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl

_REALS = tdl.QUANTITIES | {tdl.Type.REAL}


def equal(a: Value, b: Value, span: Span) -> t.Expression:
    """`a = b`, as tokens are: two that are no numbers (NaN) are one."""
    if isinstance(a, Scalar) and isinstance(b, Scalar):
        a, b = common(a, b)
        if a.exp == b.exp:
            return TRUE
        if isinstance(a.exp, t.Value) and isinstance(b.exp, t.Value):
            return TRUE if a.exp.value == b.exp.value else FALSE
        if a.type in tdl.LISTS:
            if () in (lists.items_of(a.exp), lists.items_of(b.exp)):
                return lists.is_empty(b.exp if lists.items_of(a.exp) == () else a.exp)
            return t.Binary("=", a.exp, b.exp)
        if isinstance(a.exp, t.Value):
            a, b = b, a  # `k = 1` reads better than `1 = k`
        if a.type is tdl.Type.BOOL and isinstance(b.exp, t.Value):
            return a.exp if b.exp.value else t.Unary("not", a.exp)
        same = t.Binary("=", a.exp, b.exp)
        if a.type not in _REALS or isinstance(b.exp, t.Value | t.Quantity):
            return same
        own = t.Binary("=", a.exp, a.exp), t.Binary("=", b.exp, b.exp)
        return t.Binary("or", same, t.Unary("not", t.Binary("or", *own)))
    if isinstance(a, Rec) and isinstance(b, Rec):
        return conjunction([equal(v, b.get(label), span) for label, v in a.fields])
    if isinstance(a, Rows) and isinstance(b, Rows):
        if () in (lists.items_of(a.first), lists.items_of(b.first)):
            return lists.is_empty(b.first if lists.items_of(a.first) == () else a.first)
        return equal(a.columns, b.columns, span)
    raise UnsupportedError("functions cannot be compared", span)


_INT, _REAL, _BOOL = tdl.Type.INT, tdl.Type.REAL, tdl.Type.BOOL
_SIMPLE: dict[str, tuple[t.Operator, tdl.Type]] = {
    "Int.+": ("+", _INT), "Int.-": ("-", _INT), "Int.*": ("*", _INT), "Int.div": ("div", _INT),
    "Int.mod": ("mod", _INT), "String.^": ("&", tdl.Type.STRING),
    **{
        f"{s}.{op}": (op, _BOOL)
        for s in ("Int", "IntInf", "String") for op in ("<", "<=", ">", ">=")
    },
}  # fmt: skip
_FUNCTIONS: dict[str, tuple[str, tdl.Type]] = {
    "Int.abs": ("abs", _INT), "Int.min": ("min", _INT), "Int.max": ("max", _INT),
    "Real.fromInt": ("real", _REAL), "Real.floor": ("floor", _INT), "Real.ceil": ("ceil", _INT),
    "Real.round": ("round", _INT), "Real.trunc": ("trunc", _INT), "Math.sqrt": ("sqrt", _REAL),
}  # fmt: skip
_COMPARISONS: dict[str, t.Operator] = {
    "Real.<": "<", "Real.<=": "<=", "Real.>": ">", "Real.>=": ">=", "Real.==": "=", "Real.!=": "<>",
}  # fmt: skip


_SAME = frozenset({"IntInf.fromInt", "IntInf.toInt", "Int.toLarge", "Int.fromLarge"})
"""Functions that change the type of a number: what scripts have of `IntInf.int` fits into an integer."""


def builtin(name: str, argument: Value, span: Span) -> Value:
    """The application of a built-in function of CPN ML."""
    operands = [v for _, v in argument.fields] if isinstance(argument, Rec) else [argument]
    if name in ("=", "<>"):
        same = equal(operands[0], operands[1], span)
        if name == "=":
            return Scalar(same, _BOOL)
        if isinstance(same, t.Binary) and same.operator == "=":
            return Scalar(t.Binary("<>", same.left, same.right), _BOOL)
        return Scalar(logical_not(same), _BOOL)
    if name in lists.FUNCTIONS and isinstance(operands[0], Rows):
        return _on_rows(name, operands[0], operands[1:])
    scalars = [x for x in operands if isinstance(x, Scalar)]
    if len(scalars) != len(operands):
        raise UnsupportedError(f"`{name}` cannot be used in a robot script", span)
    if name in lists.FUNCTIONS:
        return _on_list(name, scalars)
    if name in _SIMPLE:
        operator, result = _SIMPLE[name]
        return Scalar(t.Binary(operator, scalars[0].exp, scalars[1].exp), result)
    if name in _FUNCTIONS:
        function, result = _FUNCTIONS[name]
        plain = tuple(as_real(s).exp for s in scalars)
        return Scalar(t.CallExpression(function, plain), result)
    if name in _SAME:
        return scalars[0]
    if name == "Bool.not":
        return Scalar(logical_not(scalars[0].exp), _BOOL)
    if name in ("Int.~", "Real.~"):
        return Scalar(_minus(scalars[0].exp), scalars[0].type)
    return _real(name, scalars, span)


def _on_list(name: str, s: list[Scalar]) -> Scalar:
    of = s[0]
    match name:
        case "List.length":
            return Scalar(lists.count(of.exp), _INT)
        case "List.null":
            return Scalar(lists.is_empty(of.exp), _BOOL)
        case "List.hd":
            return Scalar(lists.first(of.exp), tdl.ELEMENT[of.type])
        case "List.tl":
            return Scalar(lists.rest(of.exp), of.type)
        case "List.nth":
            return Scalar(t.CallExpression("item_of", (of.exp, s[1].exp)), tdl.ELEMENT[of.type])
        case "List.rev":
            return Scalar(t.CallExpression("reversed", (of.exp,)), of.type)
        case _:
            return Scalar(t.CallExpression("joined", (of.exp, s[1].exp)), of.type)


def _on_rows(name: str, of: Rows, more: Sequence[Value]) -> Value:
    """A function on a list of records: what it does to each column."""
    match name:
        case "List.length":
            return Scalar(lists.count(of.first), _INT)
        case "List.null":
            return Scalar(lists.is_empty(of.first), _BOOL)
        case "List.hd":
            return item_of(of)
        case "List.@":
            (other,) = more
            assert isinstance(other, Rows)
            return Rows(_pairs(of.columns, other.columns, _joined))
        case _:
            own = [x for x in more if isinstance(x, Scalar)]
            changed = of.each(lambda s: _on_list(name, [s, *own]))
            return changed if name == "List.nth" else Rows(changed)


def _joined(front: Value, behind: Value) -> Scalar:
    assert isinstance(front, Scalar)
    assert isinstance(behind, Scalar)
    return _on_list("List.@", [front, behind])


def _pairs(columns: Rec, other: Rec, join: Callable[[Value, Value], Value]) -> Rec:
    """Each column joined with what the other one has by its label.

    Records in order of declaration meet those in order of their type.
    """
    out: list[tuple[str, Value]] = []
    for label, column in columns.fields:
        part = other.get(label)
        if isinstance(column, Rec) and isinstance(part, Rec):
            out.append((label, _pairs(column, part, join)))
        else:
            out.append((label, join(column, part)))
    return Rec(tuple(out))


def item_of(of: Scalar | Rows) -> Value:
    """The first item of a list."""
    if isinstance(of, Rows):
        return of.each(lambda s: Scalar(lists.first(s.exp), tdl.ELEMENT[s.type]))
    return Scalar(lists.first(of.exp), tdl.ELEMENT[of.type])


def others_of(of: Scalar | Rows) -> Scalar | Rows:
    """All items of a list but the first."""
    if isinstance(of, Rows):
        return Rows(of.each(lambda s: Scalar(lists.rest(s.exp), s.type)))
    return Scalar(lists.rest(of.exp), of.type)


def cons(item: Value, of: Value, span: Span) -> Scalar | Rows:
    """`item :: of`.

    Raises:
        UnsupportedError: scripts have no such list.
    """
    if isinstance(of, Rows) and isinstance(item, Rec):
        return Rows(_pairs(of.columns, item, lambda column, part: cons(part, column, span)))
    if not isinstance(item, Scalar) or not isinstance(of, Scalar) or of.type not in tdl.LISTS:
        raise UnsupportedError("a list of such values cannot be used in a robot script", span)
    plain = as_real(item) if of.type is tdl.Type.REALS else item
    return Scalar(lists.with_first(plain.exp, of.exp), of.type)


def empty_list(ml: Type, program: core.Program, span: Span) -> Scalar | Rows:
    """`[]` of a type.

    Raises:
        UnsupportedError: scripts have no such list.
    """
    shape = shape_of_type(ml, program)
    if isinstance(shape, RowsShape):
        return Rows(_empty_columns(shape.columns))
    if not isinstance(shape, ScalarShape) or shape.type not in tdl.LISTS:
        raise UnsupportedError(f"values of type `{ml}` cannot be used in a robot script", span)
    return Scalar(lists.made((), shape.type), shape.type)


def _empty_columns(columns: Fields) -> Rec:
    out: list[tuple[str, Value]] = []
    for label, column in columns.fields:
        if isinstance(column, Fields):
            out.append((label, _empty_columns(column)))
        else:
            assert isinstance(column, ScalarShape)
            out.append((label, Scalar(lists.made((), column.type), column.type)))
    return Rec(tuple(out))


def _real(name: str, s: list[Scalar], span: Span) -> Scalar:
    """Real arithmetic: the units of pose fields are kept where they make sense."""
    if name in _COMPARISONS or name in ("Real.+", "Real.-", "Real.min", "Real.max"):
        a, b = common(s[0], s[1])
        if name in _COMPARISONS:
            return Scalar(t.Binary(_COMPARISONS[name], a.exp, b.exp), _BOOL)
        if name in ("Real.min", "Real.max"):
            return Scalar(t.CallExpression(name.split(".")[1], (a.exp, b.exp)), a.type)
        return Scalar(t.Binary("+" if name == "Real.+" else "-", a.exp, b.exp), a.type)
    if name == "Real.abs":
        return Scalar(t.CallExpression("abs", (s[0].exp,)), s[0].type)
    if name == "Real.*":
        a, b = s
        if a.type is not _REAL and b.type is not _REAL:
            a, b = as_real(a), as_real(b)
        return Scalar(t.Binary("*", a.exp, b.exp), b.type if a.type is _REAL else a.type)
    if name == "Real./":
        a, b = s
        if b.type is not _REAL:
            a, b = as_real(a), as_real(b)
        return Scalar(t.Binary("/", a.exp, b.exp), a.type)
    raise UnsupportedError(f"`{name}` cannot be used in a robot script", span)


def _minus(e: t.Expression) -> t.Expression:
    match e:
        case t.Value(bool()):
            return e
        case t.Value(int() as number) if not tdl.MIN_INT <= -number <= tdl.MAX_INT:
            return t.Unary("-", e)
        case t.Value(int() | float() as number):
            return t.Value(-number)
        case t.Quantity(number, unit):
            return t.Quantity(-number, unit)
        case _:
            return t.Unary("-", e)


def logical_not(e: t.Expression) -> t.Expression:
    """`not e`, with what is known folded."""
    match e:
        case t.Value(bool() as value):
            return t.Value(not value)
        case t.Unary("not", operand):
            return operand
        case _:
            return t.Unary("not", e)
