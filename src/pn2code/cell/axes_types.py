"""The types of joint positions in a net: records of reals a1 .. a6 or j1 .. j6 (or A1, J1, ...), one for each axis.

In degrees, of an axis that slides in mm; arms have four, six or seven axes.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.ml.core.types import REAL, TRecord, Type

COUNTS = (4, 6, 7)
"""How many axes an arm may have."""
_LABELS = tuple(
    frozenset(f"{letter}{n}" for n in range(1, count + 1)) for letter in "ajAJ" for count in COUNTS
)


def is_axes(t: Type) -> bool:
    """Whether the values of a type are joint positions."""
    return (
        isinstance(t, TRecord)
        and are_axes(label for label, _ in t.fields)
        and all(x == REAL for _, x in t.fields)
    )


def are_axes(labels: Iterable[str]) -> bool:
    """Whether the labels of a record are those of a joint position."""
    return set(labels) in _LABELS
