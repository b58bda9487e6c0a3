"""The lines of a trace, none of which is longer than a step can be: a file without line ends is not read whole."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TextIO

LONGEST = 50_000_000
"""A longer line of a trace (characters) is not read: it is no line of one."""
TOLD = 500
"""What is kept of a line that is too long."""


def whole_lines(file: TextIO) -> Iterator[str]:
    """The lines of a file; one that is too long is the last, and only its beginning is given, which is no line."""
    while text := file.readline(LONGEST):
        if len(text) == LONGEST:
            yield f"{text[:TOLD]}\n"
            return
        yield text
