"""Scalars: the numbers and names that a token is made of.

A colour set with a fixed number of scalars is flattened into a tuple of `Scalar`s in declared order, each with what a
reader of its text needs to know: kind, names, range. Channels and input files hold tokens in this form. A channel may
hold lists, too: a list is a `Scalar`, with those of its elements in it.

    # colset POSE = record x : COORD * y : COORD;
    scalars_of(pose)            # (Scalar(REAL, "x", "COORD"), Scalar(REAL, "y", "COORD"))
    # colset BATCH = list INT with 0..3;
    message_scalars(batch)      # (Scalar(LIST, "BATCH", "BATCH", low=0, high=3, elements=(Scalar(INT, ...),)),)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import REAL

TIMES = (-(2**30), 2**30 - 1)
"""The times of an integer clock that a message can carry: those that fit into an integer of a script."""


LEAST_ROOM, MOST_ROOM = 64, 1024
"""Values for which each cell has room in a message, and for which a cell can have room."""


class ScalarKind(Enum):
    """How a scalar is written."""

    UNIT = "unit"
    BOOL = "bool"
    INT = "int"
    REAL = "real"
    STRING = "string"
    ENUM = "enum"
    INDEX = "index"
    LIST = "list"


@frozen
class Scalar:
    """One scalar.

    Args:
        label: path of its component, "#2.x", with labels of records and ML's selectors of products; for messages.
        colset: name of its colour set; for messages.
        names: ENUM: the constructors, () if they are not known. UNIT: its one name.
        low, high: INT, INDEX, REAL: inclusive bounds, None: unbounded. LIST: of its length.
        elements: LIST: what each of its elements is made of.
    """

    kind: ScalarKind
    label: str
    colset: str
    names: tuple[str, ...] = ()
    low: float | int | None = None
    high: float | int | None = None
    elements: tuple[Scalar, ...] = ()


_SIMPLE = {
    Kind.UNIT: ScalarKind.UNIT,
    Kind.BOOL: ScalarKind.BOOL,
    Kind.INT: ScalarKind.INT,
    Kind.INTINF: ScalarKind.INT,
    Kind.REAL: ScalarKind.REAL,
    Kind.STRING: ScalarKind.STRING,
    Kind.ENUM: ScalarKind.ENUM,
    Kind.INDEX: ScalarKind.INDEX,
}


def message_scalars(colset: Colset) -> tuple[Scalar, ...] | None:
    """As `scalars_of`, with a LIST for each list of scalars, or of products and records of them; None where there is
    something else whose size is not fixed (lists of lists, unions).
    """
    return scalars_of(colset, lists=True)


def is_one_value(colset: Colset) -> bool:
    """Whether a token is one scalar; a list is not, even if it has one element."""
    return len(scalars_of(colset) or ()) == 1


def least_values(scalars: Sequence[Scalar]) -> int:
    """How many values a message has at least."""
    return sum(1 + int(s.low or 0) * len(s.elements) for s in scalars)


def most_values(scalars: Sequence[Scalar]) -> int | None:
    """How many it has at most; None: any number."""
    if any(s.kind is ScalarKind.LIST and s.high is None for s in scalars):
        return None
    return sum(1 + int(s.high or 0) * len(s.elements) for s in scalars)


def message_room(colsets: Iterable[Colset]) -> int:
    """For how many values a cell has room in a message, in all channels alike: for the largest token of these colour
    sets. A list without a longest length counts as nothing, and so has the least room that there is.
    """
    found = [most_values(message_scalars(c) or ()) or 0 for c in colsets]
    return min(max([LEAST_ROOM, *found]), MOST_ROOM)


def scalars_of(
    colset: Colset, label: str = "", *, lists: bool = False
) -> tuple[Scalar, ...] | None:
    """The scalars of a colour set in declared order; None where their number is not fixed (lists, unions).

    Args:
        colset: the colour set.
        label: of the component that it is of.
        lists: whether a list is one, too (`message_scalars`).
    """
    c = colset.resolved
    if c.kind is Kind.SUBSET:
        base = c.components[0]
        return None if base is None else scalars_of(base, label, lists=lists)
    if c.kind is Kind.LIST and lists:
        return _list_of(colset, label)
    if c.kind in (Kind.PRODUCT, Kind.RECORD):
        found: list[Scalar] = []
        labels = c.labels or tuple(f"#{i + 1}" for i in range(len(c.components)))
        for component, own in zip(c.components, labels, strict=True):
            inner = None
            if component is not None:
                inner = scalars_of(component, f"{label}.{own}" if label else own, lists=lists)
            if inner is None:
                return None
            found.extend(inner)
        return tuple(found)
    if c.kind is Kind.TIME and c.type != REAL:
        return (Scalar(ScalarKind.INT, label or colset.name, colset.name, (), *TIMES),)
    kind = ScalarKind.REAL if c.kind is Kind.TIME else _SIMPLE.get(c.kind)
    if kind is None:
        return None
    bounded = kind in (ScalarKind.INT, ScalarKind.REAL, ScalarKind.INDEX)
    return (
        Scalar(
            kind=kind,
            label=label or colset.name,
            colset=colset.name,
            names=c.names if kind in (ScalarKind.ENUM, ScalarKind.UNIT) else (),
            low=c.low if bounded and not isinstance(c.low, str) else None,
            high=c.high if bounded and not isinstance(c.high, str) else None,
        ),
    )


def _list_of(colset: Colset, label: str) -> tuple[Scalar, ...] | None:
    c = colset.resolved
    element = c.components[0]
    parts = None if element is None else scalars_of(element, label)
    if not parts:
        return None
    low = c.low if isinstance(c.low, int) else 0
    high = c.high if isinstance(c.high, int) else None
    return (Scalar(ScalarKind.LIST, label or colset.name, colset.name, (), low, high, parts),)


def lines_of(colset: Colset) -> list[tuple[Scalar, ...]]:
    """The lines of an input file: one for each component; one for all where all are scalars; [()] for what has none."""
    scalars = scalars_of(colset) or ()
    whole = colset.whole
    if whole.kind not in (Kind.PRODUCT, Kind.RECORD):
        return [scalars]
    counts = [len(scalars_of(part) or ()) for part in whole.components if part is not None]
    if all(n == 1 for n in counts):
        return [scalars]
    starts = [sum(counts[:i]) for i in range(len(counts))]
    return [scalars[i : i + n] for i, n in zip(starts, counts, strict=True)]
