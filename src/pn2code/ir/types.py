"""The types of `NetIR`: how values are represented in C, the C types to declare, and the tables of colour sets."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from pn2code.base.frozen import frozen


class Rep(Enum):
    """How a value is represented in C; see cnative/include/pn/pn_type.h."""

    UNIT = "unit"
    BOOL = "bool"
    INT = "int"
    BIG = "big"
    REAL = "real"
    STRING = "string"
    CHAR = "char"
    TIME = "time"
    ENUM = "enum"
    STRUCT = "struct"
    LIST = "list"
    UNION = "union"
    REF = "ref"


@frozen
class IrType:
    """A type; `name` is the key of its definition (ENUM, STRUCT, LIST, UNION, REF), "" otherwise.

    A function that is a value is a UNION: its constructors are the functions that it may be, their arguments what
    those captured. An exception is a UNION of all exceptions.
    """

    rep: Rep
    name: str = ""

    def __str__(self) -> str:
        """Short form for dumps."""
        return self.name or self.rep.value


UNIT = IrType(Rep.UNIT)
BOOL = IrType(Rep.BOOL)
INT = IrType(Rep.INT)
BIG = IrType(Rep.BIG)
"""`IntInf.int`: no limit."""
REAL = IrType(Rep.REAL)
STRING = IrType(Rep.STRING)
CHAR = IrType(Rep.CHAR)
TIME = IrType(Rep.TIME)
"""A time stamp in a token (`pn_time_t`), computed as INT or REAL; in ML the former is a BIG."""


@frozen
class EnumDef:
    """An enumeration: its constructors in order."""

    name: str
    constructors: tuple[str, ...]


@frozen
class StructDef:
    """A record or tuple: fields in the order of the first colour set that has this type."""

    name: str
    fields: tuple[tuple[str, IrType], ...]


@frozen
class ListDef:
    """A list: cells of this element."""

    name: str
    element: IrType


@frozen
class UnionDef:
    """A data type with arguments: (constructor, argument type or None, whether the argument is behind a pointer)."""

    name: str
    constructors: tuple[tuple[str, IrType | None, bool], ...]


@frozen
class RefDef:
    """A reference: a pointer to what can be changed."""

    name: str
    target: IrType


Definition = EnumDef | StructDef | ListDef | UnionDef | RefDef


def parts(definition: Definition) -> list[IrType]:
    """The types that a value of the type has parts of."""
    match definition:
        case StructDef(fields=fields):
            return [f for _, f in fields]
        case ListDef(element=element) | RefDef(target=element):
            return [element]
        case UnionDef(constructors=constructors):
            return [a for _, a, _ in constructors if a is not None]
        case EnumDef():
            return []


def holds_reference(definitions: Mapping[str, Definition], t: IrType) -> bool:
    """Whether there may be references in a value of the type."""
    seen: set[str] = set()
    waiting = [t]
    while waiting:
        t = waiting.pop()
        if t.rep is Rep.REF:
            return True
        if t.name and t.name not in seen:
            seen.add(t.name)
            waiting += parts(definitions[t.name])
    return False


@frozen
class Descriptor:
    """A colour set, or a type without one, as the runtime's table.

    Args:
        name: key; that of the colour set, or of the type.
        type: its representation.
        names: ENUM: constructors; UNIT, BOOL with own names; index: the stem.
        fields: STRUCT: (label, key of the component's descriptor) in declared order; UNION: (constructor, key or "").
        element: LIST, REF: key of the element's descriptor.
        low, high: bounds, None: unbounded. LIST and STRING: of the length.
        chars: STRING: range of the characters as codes.
        is_index, is_float32, is_narrow, is_tuple: as in pn_type.h.
        member: key of the function that decides membership of a subset, "" for none.
        comment: what is declared, for the generated code.
    """

    name: str
    type: IrType
    names: tuple[str, ...] = ()
    fields: tuple[tuple[str, str], ...] = ()
    element: str = ""
    low: int | float | None = None
    high: int | float | None = None
    chars: tuple[int, int] | None = None
    is_index: bool = False
    is_float32: bool = False
    is_narrow: bool = False
    is_tuple: bool = False
    member: str = ""
    comment: str = ""


def closure(descriptors: Mapping[str, Descriptor], roots: set[str]) -> set[str]:
    """The descriptors that some refer to, with these."""
    found: set[str] = set()
    pending = list(roots)
    while pending:
        key = pending.pop()
        if key in found or not key:
            continue
        found.add(key)
        d = descriptors[key]
        pending += [part for _, part in d.fields if part]
        if d.element:
            pending.append(d.element)
    return found


def is_restricted(descriptors: Mapping[str, Descriptor], key: str) -> bool:
    """Whether a descriptor excludes values of its type, or rounds them, itself or in a part."""
    d = descriptors[key]
    if d.low is not None or d.high is not None or d.chars or d.member or d.is_float32:
        return True
    parts = [part for _, part in d.fields if part] + ([d.element] if d.element else [])
    return any(part != key and is_restricted(descriptors, part) for part in parts)
