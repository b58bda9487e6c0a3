"""Bounds of colour sets: which numbers and lengths their values have, and what is raised where there are none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.values.data import MlException, MlLimit, exception

if TYPE_CHECKING:
    pass


MOST_VALUES = 2_000_000
"""Most values of a colour set that are listed."""


def numbers_of(c: Colset) -> range:
    """The numbers of an int or index colour set; raises CPN'Error when it has no bounds."""
    if not isinstance(c.low, int) or not isinstance(c.high, int):
        raise no_bounds(c)
    return range(c.low, c.high + 1)


def lengths_of(c: Colset) -> tuple[int, int]:
    """The lengths of a list or string; raises CPN'Error when it has no bounds."""
    if c.kind is Kind.LIST and isinstance(c.low, int) and isinstance(c.high, int):
        return c.low, c.high
    if c.kind is Kind.STRING and c.length is not None and isinstance(c.low, str):
        return c.length
    raise no_bounds(c)


def number_of_sequences(items: int, low: int, high: int) -> int:
    """How many sequences there are with `low` to `high - 1` of so many items."""
    return sum(items**n for n in range(low, high))


def is_numbered(c: Colset) -> bool:
    """Whether each number below the size is that of a value: no list, string or subset is in it."""
    if c.kind in (Kind.LIST, Kind.STRING, Kind.SUBSET):
        return False
    return all(part is None or is_numbered(part) for part in c.components)


def refuse_too_many(c: Colset, size: int) -> None:
    """Raises `MlLimit` where a colour set has more values than are listed."""
    if size > MOST_VALUES:
        raise MlLimit(f"the colour set {c.name} has more than {MOST_VALUES} values")


def has_bounds(c: Colset) -> bool:
    """Whether some value of the colour set's type is not legal."""
    own = c.low is not None or c.high is not None or c.length is not None
    return own or c.kind is Kind.SUBSET or any(has_bounds(p) for p in c.components if p is not None)


def is_within(c: Colset, number: Any) -> bool:
    """Whether a number is within the bounds of a colour set."""
    low: Any = c.low
    high: Any = c.high
    return (low is None or low <= number) and (high is None or number <= high)


def no_bounds(c: Colset) -> MlException:
    """What is raised where a colour set has no bounds."""
    return MlException(exception("CPN'Error", f"the colour set {c.name} has no bounds"))


def out_of_range() -> MlException:
    """What is raised where a colour set has no value at a position."""
    return MlException(exception("CPN'Error", "Out of range!"))
