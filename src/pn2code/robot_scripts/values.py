"""Values of the net as a script has them: script expressions, and their arithmetic.

    #x p + 100.0     with p in the script variable `p` of type pose
    ->  Scalar(p.x + 100 mm, LENGTH)

A real number of the net may be a length or an angle of the script (a
field of a pose); where it meets another number the units are brought together.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Span
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import Type
from pn2code.robot_scripts.shapes import (
    POSE_LABELS,
    Fields,
    RowsShape,
    ScalarShape,
    Shape,
    fields_of,
    shape_of_type,
)
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl


def literal(value: int | float | str, ml: Type, program: core.Program, span: Span) -> Scalar:
    """A literal of the net.

    Raises:
        UnsupportedError: scripts have nothing for its type, or it is too large for their integers.
    """
    shape = shape_of_type(ml, program)
    if not isinstance(shape, ScalarShape):
        raise UnsupportedError(f"values of type `{ml}` cannot be used in a robot script", span)
    if shape.type is tdl.Type.INT and not tdl.MIN_INT <= int(value) <= tdl.MAX_INT:
        raise UnsupportedError("integers of robot scripts have 31 bits", span)
    return Scalar(t.Value(value), shape.type)


# --- values ------------------------------------------------------------------------------------


@frozen
class Scalar:
    """A script expression with its script type (LENGTH and ANGLE for reals that come from a pose)."""

    exp: t.Expression
    type: tdl.Type


@frozen
class Rec:
    """A record or tuple that is not a pose; unit has no fields."""

    fields: tuple[tuple[str, Value], ...]

    def get(self, label: str) -> Value:
        """A field."""
        return next(v for name, v in self.fields if name == label)


@frozen
class Rows:
    """A list of records: a record of lists, its columns, all of one length."""

    columns: Rec

    @property
    def first(self) -> t.Expression:
        """A column, for what is the same of all of them."""
        return scalars_in(self.columns)[0].exp

    def each(self, change: Callable[[Scalar], Scalar]) -> Rec:
        """The columns, changed alike."""
        return _each(self.columns, change)


def _each(columns: Rec, change: Callable[[Scalar], Scalar]) -> Rec:
    out: list[tuple[str, Value]] = []
    for label, part in columns.fields:
        assert isinstance(part, Rec | Scalar), "an item has no lists"
        out.append((label, _each(part, change) if isinstance(part, Rec) else change(part)))
    return Rec(tuple(out))


@frozen
class Closure:
    """A function of the net with what its free variables mean."""

    rules: tuple[core.Rule, ...]
    env: Env
    name: str = ""


@frozen
class Primitive:
    """A function that is a robot command."""

    name: str


Value = Scalar | Rec | Rows | Closure | Primitive
Env = dict[int, "Value"]
"""Meaning of symbols by uid."""

UNIT = Rec(())
TRUE, FALSE = t.Value(True), t.Value(False)


def scalars_in(value: Value) -> list[Scalar]:
    """The scalars of a value, in order; a function has none."""
    match value:
        case Scalar():
            return [value]
        case Rec(fields):
            return [scalar for _, v in fields for scalar in scalars_in(v)]
        case Rows(columns):
            return scalars_in(columns)
        case _:
            return []


def make(shape: Shape, names: Iterator[str]) -> Value:
    """A value held by script variables, one name for each scalar in order."""
    if isinstance(shape, ScalarShape):
        return Scalar(t.Name(next(names)), shape.type)
    if isinstance(shape, RowsShape):
        columns = make(shape.columns, names)
        assert isinstance(columns, Rec)
        return Rows(columns)
    record = Rec(tuple((label, make(inner, names)) for label, inner in shape.fields))
    if {label.lower() for label, _ in record.fields} == set(POSE_LABELS) and all(
        isinstance(v, Scalar) and v.type is tdl.Type.REAL for _, v in record.fields
    ):
        return pose(dict(record.fields), t.GENERATED)
    return record


def shape_of_list(value: Scalar | Rows) -> Shape:
    """The shape of a list."""
    if isinstance(value, Scalar):
        return ScalarShape(value.type)
    columns = _shape_of_columns(value.columns)
    return RowsShape(columns)


def shape_of_value(value: Value) -> Shape | None:
    """The shape of a value, of lengths and angles that of plain numbers; None: it is a function."""
    match value:
        case Scalar(_, kind):
            return ScalarShape(tdl.Type.REAL if kind in tdl.QUANTITIES else kind)
        case Rows():
            return shape_of_list(value)
        case Rec(fields):
            return fields_of([(label, shape_of_value(part)) for label, part in fields])
        case _:
            return None


def _shape_of_columns(columns: Rec) -> Fields:
    out: list[tuple[str, Shape]] = []
    for label, part in columns.fields:
        assert isinstance(part, Rec | Scalar), "an item has no lists"
        own = _shape_of_columns(part) if isinstance(part, Rec) else ScalarShape(part.type)
        out.append((label, own))
    return Fields(tuple(out))


def flatten(value: Value, shape: Shape, span: Span) -> list[Scalar]:
    """The scalars of a value as a shape stores them."""
    if isinstance(shape, Fields):
        return [
            x
            for label, inner in shape.fields
            for x in flatten(select(value, label, span), inner, span)
        ]
    if isinstance(shape, RowsShape) and isinstance(value, Rows):
        return flatten(value.columns, shape.columns, span)
    if not isinstance(value, Scalar) or isinstance(shape, RowsShape):
        raise UnsupportedError("this value cannot be stored in a robot script", span)
    return [as_real(value) if shape.type is tdl.Type.REAL else value]


# --- arithmetic of expressions -----------------------------------------------------------------


def conjunction(conditions: list[t.Expression]) -> t.Expression:
    """`a and b and c`, without what is known; `true` for none."""
    out: t.Expression = TRUE
    for c in conditions:
        if c == FALSE or out == FALSE:
            out = FALSE
        elif out == TRUE:
            out = c
        elif c != TRUE:
            out = t.Binary("and", out, c)
    return out


def disjunction(conditions: list[t.Expression]) -> t.Expression:
    """`a or b or c`, without what is known; `false` for none."""
    out: t.Expression = FALSE
    for c in conditions:
        if c == TRUE or out == TRUE:
            out = TRUE
        elif out == FALSE:
            out = c
        elif c != FALSE:
            out = t.Binary("or", out, c)
    return out


def choose(condition: t.Expression, a: Value, b: Value, span: Span) -> Value:
    """`if condition then a else b`, scalar by scalar."""
    if condition == TRUE or a == b:
        return a
    if condition == FALSE:
        return b
    if isinstance(a, Scalar) and isinstance(b, Scalar):
        a, b = common(a, b)
        # The types first: in Python `1 == True`.
        if a.type is tdl.Type.BOOL and b.exp == FALSE:
            return Scalar(conjunction([condition, a.exp]), a.type)
        if a.type is tdl.Type.BOOL and a.exp == TRUE:
            return Scalar(disjunction([condition, b.exp]), a.type)
        return Scalar(t.Conditional(condition, a.exp, b.exp), a.type)
    if isinstance(a, Rec) and isinstance(b, Rec):
        return Rec(
            tuple((label, choose(condition, v, b.get(label), span)) for label, v in a.fields)
        )
    if isinstance(a, Rows) and isinstance(b, Rows):
        chosen = choose(condition, a.columns, b.columns, span)
        assert isinstance(chosen, Rec)
        return Rows(chosen)
    raise UnsupportedError("a function cannot be chosen by a condition", span)


def _unit(type_: tdl.Type) -> t.Quantity:
    return t.Quantity(1.0, tdl.BASE_UNIT[type_])


def as_real(s: Scalar) -> Scalar:
    """A length or angle as a plain number of mm or degrees."""
    if s.type not in tdl.QUANTITIES:
        return s
    match s.exp:
        case t.Quantity(number, _):
            return Scalar(t.Value(number), tdl.Type.REAL)
        case t.Binary("*", left, right) if right == _unit(s.type):
            return Scalar(left, tdl.Type.REAL)
        case _:
            return Scalar(t.Binary("/", s.exp, _unit(s.type)), tdl.Type.REAL)


def as_quantity(s: Scalar, wanted: tdl.Type) -> Scalar:
    """A plain number as a length in mm, an angle in degrees, a time in s."""
    if s.type is wanted:
        return s
    s = as_real(s)
    match s.exp:
        case t.Value(int() | float() as number):
            return Scalar(t.Quantity(float(number), tdl.BASE_UNIT[wanted]), wanted)
        case t.Unary("-", t.Value(int() | float() as number)):
            return Scalar(t.Quantity(-float(number), tdl.BASE_UNIT[wanted]), wanted)
        case t.Binary("/", left, right) if right == _unit(wanted):
            return Scalar(left, wanted)
        case _:
            return Scalar(t.Binary("*", s.exp, _unit(wanted)), wanted)


def common(a: Scalar, b: Scalar) -> tuple[Scalar, Scalar]:
    """Two numbers with the same unit: that of the one that has a unit, none if both differ."""
    if a.type is b.type:
        return a, b
    if a.type in tdl.QUANTITIES and b.type is tdl.Type.REAL:
        return a, as_quantity(b, a.type)
    if b.type in tdl.QUANTITIES and a.type is tdl.Type.REAL:
        return as_quantity(a, b.type), b
    return as_real(a), as_real(b)


def pose(fields: Mapping[str, Value], span: Span) -> Scalar:
    """A pose from its fields (labels in any case); `p` itself where all come from one pose `p`."""
    by_label = {label.lower(): v for label, v in fields.items()}
    parts = []
    for label, type_ in tdl.POSE_FIELDS.items():
        value = by_label[label]
        if not isinstance(value, Scalar):
            raise UnsupportedError("this is not a number", span)
        parts.append(as_quantity(value, type_).exp)
    first = parts[0]
    if isinstance(first, t.Field) and all(
        p == t.Field(first.record, label) for p, label in zip(parts, POSE_LABELS, strict=True)
    ):
        return Scalar(first.record, tdl.Type.POSE)
    return Scalar(t.CallExpression("pose", tuple(parts)), tdl.Type.POSE)


def select(value: Value, label: str, span: Span) -> Value:
    """A field of a record, product or pose."""
    match value:
        case Rec():
            return value.get(label)
        case Scalar(exp, tdl.Type.POSE):
            name = label.lower()
            type_ = tdl.POSE_FIELDS[name]
            if isinstance(exp, t.CallExpression) and exp.function == "pose":
                return Scalar(exp.arguments[POSE_LABELS.index(name)], type_)
            if isinstance(exp, t.Conditional):
                a = select(Scalar(exp.then, tdl.Type.POSE), label, span)
                b = select(Scalar(exp.otherwise, tdl.Type.POSE), label, span)
                return choose(exp.condition, a, b, span)
            return Scalar(t.Field(exp, name), type_)
        case _:
            raise UnsupportedError("this value has no fields", span)
