"""What the tables that the explorer reads have in common: numbers in lines, lists with their length, and an end.

The explorer refuses a table without the last line, so a part of one is never taken for the whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen

END = "end"


@frozen
class Reason:
    """A transition is disabled as long as the place has fewer than `least` tokens; `least` 0: as long as it has any."""

    place: int
    least: int
    helpers: tuple[int, ...]


def row(*numbers: int) -> str:
    """A line."""
    return " ".join(map(str, numbers))


def listed(numbers: Sequence[int]) -> tuple[int, ...]:
    """How many, and which."""
    return len(numbers), *numbers


def reason_rows(reasons: Sequence[Reason]) -> Iterator[str]:
    """How many, and a line for each."""
    yield row(len(reasons))
    for r in reasons:
        yield row(r.place, r.least, *listed(r.helpers))
