"""Input files: one token of a place, as `cnative/src/supervisor/supervisor_input.c` reads it when the supervisor
starts.

read("5\\n1 2 3\\n", lines_of(colset))      # (5, 1.0, 2.0, 3.0)
read("5\\n1 2 x\\n", lines_of(colset))      # Mistake(2, 5, "`x` is not a number (...)")
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.cell.scalars import Scalar
from pn2code.channels.scalars import Malformed, ScalarValue, parse_scalars

MOST_BYTES = 65_535
"""Of an input file: what the supervisor has room for."""


@frozen
class Mistake:
    """What is wrong first, and where; counted from 1."""

    line: int
    column: int
    what: str


def read(text: str, wanted: Sequence[Sequence[Scalar]]) -> tuple[ScalarValue, ...] | Mistake:
    """The scalars of the token in an input file, or what is wrong with the file.

    Args:
        text: of the file, a character a byte.
        wanted: what each line holds (`cell.scalars.lines_of` the place's colour set).
    """
    if len(text) > MOST_BYTES:
        return Mistake(1, 1, f"the file is longer than the {MOST_BYTES:,} bytes that are possible")
    found = list(_filled(text))
    scalars_read: list[ScalarValue] = []
    for number, scalars in enumerate(wanted):
        if number == len(found):
            labels = " ".join(f"`{s.label}`" for s in scalars)
            last = text.count("\n") + (text[-1:] not in ("", "\n"))
            what = f"the file ends where line {number + 1} of {len(wanted)} is expected: {labels}"
            return Mistake(last + 1, 1, what)
        at, line = found[number]
        values = parse_scalars(scalars, line)
        if isinstance(values, Malformed):
            return Mistake(at, values.column, values.text)
        scalars_read += values
    if len(found) > len(wanted):
        at, line = found[len(wanted)]
        return Mistake(at, 1, f"found `{line.strip()[:60]}` after what belongs here")
    return tuple(scalars_read)


def _filled(text: str) -> Iterator[tuple[int, str]]:
    """The lines that are neither blank nor comments."""
    for number, line in enumerate(text.split("\n"), 1):
        shown = line.strip(" \t\r")
        if shown and not shown.startswith("#"):
            yield number, line
