"""The trace of a game while it is played: lines on disk, cut off when the game goes another way.

tape = Tape(path)
tape.add(0, [line])             # after entry 0 of the history
tape.copy(out, start=0, end=1)

The memory of a history ends; the trace of the game does not.
"""

from __future__ import annotations

import array
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO


class Tape:
    """The lines of a game's steps.

    Args:
        path: a file of its own.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("w+b")
        self._ends = array.array("q", [0])

    def close(self) -> None:
        """No more lines."""
        self._file.close()

    def clear(self) -> None:
        """A new game."""
        self._cut(0)

    def _cut(self, entries: int) -> None:
        if len(self._ends) > entries + 1:
            del self._ends[entries + 1 :]
            self._file.seek(self._ends[-1])
            self._file.truncate()

    def add(self, number: int, lines: Iterable[bytes]) -> None:
        """The lines of an entry, from 0; those of this number and later ones are gone."""
        self._cut(number)
        self._file.seek(self._ends[-1])
        written = 0
        for line in lines:
            written += self._file.write(line)
        self._ends.append(self._ends[-1] + written)

    def copy(self, out: BinaryIO, start: int, end: int) -> None:
        """Writes the lines of the entries from `start` to before `end`."""
        self._file.seek(self._ends[start])
        left = self._ends[end] - self._ends[start]
        while left > 0:
            data = self._file.read(min(left, 1 << 20))
            if not data:
                return
            out.write(data)
            left -= len(data)
