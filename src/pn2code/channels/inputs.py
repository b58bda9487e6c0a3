"""Input files: one token of a place, as `cnative/src/supervisor/supervisor_input.c` reads it when the supervisor
starts.

problem("5\\n1 2 x\\n", lines_of(colset))      # Mistake(2, 5, "`x` is not a number (...)"); None: the file is right
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from pn2code.cell.scalars import Scalar
from pn2code.channels.scalars import Malformed, parse_scalars


@dataclass(frozen=True, slots=True)
class Mistake:
    """What is wrong first, and where; counted from 1."""

    line: int
    column: int
    what: str


def problem(text: str, wanted: Sequence[Sequence[Scalar]]) -> Mistake | None:
    """What is wrong with an input file.

    Args:
        text: of the file, a character a byte.
        wanted: what each line holds (`cell.scalars.lines_of` the place's colour set).
    """
    found = list(_filled(text))
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
    if len(found) > len(wanted):
        at, line = found[len(wanted)]
        return Mistake(at, 1, f"found `{line.strip()[:60]}` after what belongs here")
    return None


def _filled(text: str) -> Iterator[tuple[int, str]]:
    """The lines that are neither blank nor comments."""
    for number, line in enumerate(text.split("\n"), 1):
        shown = line.strip(" \t\r")
        if shown and not shown.startswith("#"):
            yield number, line
