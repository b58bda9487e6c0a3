"""Values of net variables as a script announces them, and traces write them."""

from __future__ import annotations

from pn2code.diagnostics import Span
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import Closure, Rec, Rows, Scalar, Value, select
from pn2code.robot_scripts.values import Primitive as PrimitiveValue
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl


def datum(value: Value, colset: Colset | None, span: Span) -> t.Datum:
    """A value as traces write it: records with their fields in declared order."""
    c = colset.whole if colset is not None else None
    parts = dict(zip(c.labels, c.components, strict=True)) if c is not None and c.labels else {}
    match value:
        case Scalar(exp, tdl.Type.POSE):
            if not parts or tuple(parts) == tuple(tdl.POSE_FIELDS):
                return exp
            return t.RecordDatum(
                tuple((x, datum(select(value, x, span), None, span)) for x in parts)
            )
        case Scalar(exp):
            return exp
        case Rec(()):
            return t.NullDatum()
        case Rec(fields):
            if parts:
                return t.RecordDatum(tuple((x, datum(value.get(x), parts[x], span)) for x in parts))
            components = (
                c.components if c is not None and c.kind is Kind.PRODUCT else (None,) * len(fields)
            )
            return t.TupleDatum(
                tuple(datum(v, part, span) for (_, v), part in zip(fields, components, strict=True))
            )
        case Rows(columns):
            is_list = c is not None and c.kind is Kind.LIST
            return t.EachDatum(datum(columns, c.components[0] if is_list and c else None, span))
        case Closure() | PrimitiveValue():
            raise UnsupportedError("a function is no value of a net variable", span)
