"""The components of a colour set's values, in declared order."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.types import label_key
from pn2code.semantics.values.data import Value

if TYPE_CHECKING:
    pass


def component(c: Colset) -> Colset:
    """The base of a list, subset or alias."""
    base = c.components[0]
    assert base is not None
    return base


def parts_of(c: Colset, value: Any) -> list[tuple[str, Colset, Value]]:
    """Label, colour set and value of each component of a product or record, in declared order."""
    if c.kind is Kind.PRODUCT:
        named = enumerate(c.components, 1)
        return [(str(i), p, x) for (i, p), x in zip(named, value, strict=True) if p is not None]
    named_parts = zip(c.labels, c.components, _places(c.labels), strict=True)
    return [(label, part, value[at]) for label, part, at in named_parts if part is not None]


@cache
def _places(labels: tuple[str, ...]) -> tuple[int, ...]:
    """Where the value of a record has each field."""
    stored = sorted(labels, key=label_key)
    return tuple(stored.index(label) for label in labels)


def assemble(c: Colset, values: Sequence[Value]) -> tuple[Value, ...]:
    """The value of a product or record from its components in declared order."""
    if c.kind is Kind.PRODUCT:
        return tuple(values)
    by_label = dict(zip(c.labels, values, strict=True))
    return tuple(by_label[label] for label in sorted(by_label, key=label_key))
