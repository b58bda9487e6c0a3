"""The types of joint positions in a net: records of six reals a1 .. a6 or j1 .. j6 (or A1, J1, ...), in degrees."""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.ml.core.types import REAL, TRecord, Type

AXES = 6
"""Of an arm."""
_LABELS = tuple(frozenset(f"{letter}{n}" for n in range(1, AXES + 1)) for letter in "ajAJ")


def is_axes(t: Type) -> bool:
    """Whether the values of a type are joint positions."""
    return (
        isinstance(t, TRecord)
        and len(t.fields) == AXES
        and are_axes(label for label, _ in t.fields)
        and all(x == REAL for _, x in t.fields)
    )


def are_axes(labels: Iterable[str]) -> bool:
    """Whether the labels of a record are those of a joint position."""
    return set(labels) in _LABELS
