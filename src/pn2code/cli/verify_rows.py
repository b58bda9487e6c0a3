"""Lines of what `pn2code verify` prints: how wide they are, a name with what there is to say, numbers of things."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

WIDTH = 110
_NAME = 21


def row(name: str, what: str) -> Iterator[str]:
    """A line with a name on the left, and further lines below it."""
    wrapped = textwrap.wrap(what, WIDTH - _NAME - 2) or [""]
    yield f"  {name:<{_NAME}}{wrapped[0]}"
    yield from (f"  {'':{_NAME}}{line}" for line in wrapped[1:])


def count_of(count: int, what: str) -> str:
    """A number of things, in words."""
    return f"{count} {what}{'s' * (count != 1)}"
