"""What a type or colour set is made of in a script: scalars, records of fields, lists as columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from pn2code.base.frozen import frozen
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import BOOL, INT, INTINF, REAL, STRING, TCon, TRecord, Type
from pn2code.robot_scripts import lists
from pn2code.tdl import types as tdl

POSE_LABELS = tuple(tdl.POSE_FIELDS)


@frozen
class ScalarShape:
    """One script value."""

    type: tdl.Type
    single: bool = False


@frozen
class Fields:
    """A record or product (labels 1, 2, ...) that is not a pose, in declared order; unit has no fields."""

    fields: tuple[tuple[str, Shape], ...]


@frozen
class RowsShape:
    """A list of records or products: a list for each scalar of these, its columns."""

    columns: Fields


Shape = ScalarShape | Fields | RowsShape


def is_pose(labels: tuple[str, ...], types: tuple[Type, ...]) -> bool:
    """Whether a record is a pose: six reals named x y z rx ry rz, in upper or lower case."""
    return (
        {x.lower() for x in labels} == set(POSE_LABELS)
        and len(labels) == 6
        and all(x == REAL for x in types)
    )


def shape_of_type(ml: Type, program: core.Program) -> Shape | None:
    """The shape of an ML type; None where scripts have nothing for it."""
    match ml:
        case TCon():
            simple = {
                INT: tdl.Type.INT,
                INTINF: tdl.Type.INT,  # times of an integer clock, of which messages carry 31 bits
                REAL: tdl.Type.REAL,
                BOOL: tdl.Type.BOOL,
                STRING: tdl.Type.STRING,
            }
            if ml in simple:
                return ScalarShape(simple[ml])
            element = lists.element_of(ml)
            if element is not None:
                return _list_of(shape_of_type(element, program))
            return ScalarShape(tdl.Type.STRING) if is_enumeration(ml, program) else None
        case TRecord(fields):
            labels, types = tuple(x for x, _ in fields), tuple(x for _, x in fields)
            if is_pose(labels, types):
                return ScalarShape(tdl.Type.POSE)
            inner = [(label, shape_of_type(x, program)) for label, x in fields]
            return fields_of(inner)
        case _:
            return None


def _list_of(element: Shape | None) -> Shape | None:
    """The shape of a list: of numbers, truth values, texts or poses, or of records of these."""
    if isinstance(element, Fields):
        columns = _columns(element)
        return None if columns is None or not scalar_shapes(columns) else RowsShape(columns)
    if not isinstance(element, ScalarShape) or element.type not in tdl.LIST_OF:
        return None
    return ScalarShape(tdl.LIST_OF[element.type], element.single)


def _columns(item: Fields) -> Fields | None:
    """A list for each scalar of an item; None where items have lists, or poses that traces write otherwise."""
    out: list[tuple[str, Shape]] = []
    for label, part in item.fields:
        found = _columns(part) if isinstance(part, Fields) else _list_of(part)
        if found is None or isinstance(found, RowsShape):
            return None
        out.append((label, found))
    return Fields(tuple(out))


def fields_of(inner: list[tuple[str, Shape | None]]) -> Fields | None:
    """Fields with their shapes; None where one of them has none."""
    known = tuple((label, x) for label, x in inner if x is not None)
    return Fields(known) if len(known) == len(inner) else None


def is_enumeration(ml: Type, program: core.Program) -> bool:
    """Whether a type is a data type whose constructors have no arguments (and is not bool)."""
    if not isinstance(ml, TCon) or ml.args or ml == BOOL:
        return False
    data = program.datatypes.get(ml.name)
    return data is not None and all(argument is None for _, argument in data.constructors)


def shape_of_colset(
    colset: Colset, program: core.Program, storage: Mapping[str, str], *, in_order: bool = False
) -> Shape | None:
    """The shape of a colour set, in its declared order, with what is stored in single precision.

    `in_order`: a pose must also have its fields in the order x y z rx ry rz (for files).
    """
    single = False
    c = colset
    while True:
        single = single or storage.get(c.name) == "float32"
        if c.kind not in (Kind.ALIAS, Kind.SUBSET):
            break
        base = c.components[0]
        assert base is not None
        c = base
    if c.kind is Kind.REAL:
        return ScalarShape(tdl.Type.REAL, single)
    if c.kind in (Kind.RECORD, Kind.PRODUCT):
        labels = c.labels or tuple(str(i) for i in range(1, len(c.components) + 1))
        inner = [
            (label, None if x is None else shape_of_colset(x, program, storage, in_order=in_order))
            for label, x in zip(labels, c.components, strict=True)
        ]
        shapes = {x for _, x in inner}
        types = tuple(x.type for x in c.components if x is not None)
        ordered = tuple(x.lower() for x in labels) == POSE_LABELS or not in_order
        if is_pose(labels, types) and len(shapes) == 1 and ordered:
            (only,) = shapes
            assert isinstance(only, ScalarShape)
            return ScalarShape(tdl.Type.POSE, only.single)
        return fields_of(inner)
    if c.kind is Kind.LIST and c.components[0] is not None:
        if any(map(_is_strange_pose, _records_in(c.components[0]))):
            return None  # traces write the items as the script has them
        return _list_of(shape_of_colset(c.components[0], program, storage, in_order=True))
    if c.kind in (Kind.UNIT, Kind.BOOL, Kind.INT, Kind.TIME, Kind.STRING, Kind.ENUM):
        return shape_of_type(c.type, program)
    return None


def _records_in(c: Colset) -> Iterator[Colset]:
    """The records that a colour set is made of, itself included."""
    whole = c.whole
    if whole.labels:
        yield whole
    for part in whole.components:
        if part is not None:
            yield from _records_in(part)


def _is_strange_pose(c: Colset) -> bool:
    """Whether records are poses, but with their fields in another order or in upper case."""
    types = tuple(x.type for x in c.components if x is not None)
    return is_pose(tuple(c.labels), types) and tuple(c.labels) != POSE_LABELS


def scalar_shapes(shape: Shape, label: str = "") -> list[tuple[str, ScalarShape]]:
    """The scalars of a shape with their labels joined by `_`."""
    if isinstance(shape, ScalarShape):
        return [(label, shape)]
    if isinstance(shape, RowsShape):
        return scalar_shapes(shape.columns, label)
    return [
        x
        for name, inner in shape.fields
        for x in scalar_shapes(inner, f"{label}_{name}" if label else name)
    ]
