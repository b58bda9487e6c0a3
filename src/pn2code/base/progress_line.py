"""One line on a terminal that tells how something goes on: of explorations, simulations and runs of cells."""

from __future__ import annotations

import shutil
import sys
from types import TracebackType
from typing import IO, Self


class Line:
    """A line that is written over again; nothing where the stream is no terminal. It is gone at the end.

    Args:
        shown: whether anything is shown at all.
        stream: where; stderr by default.
        first: what it says until there is something to tell.
    """

    def __init__(
        self, *, shown: bool = True, stream: IO[str] | None = None, first: str = "compiling ..."
    ) -> None:
        self._stream = stream or sys.stderr
        self._shown = shown and self._stream.isatty()
        self._first = first
        self._written = False

    def __enter__(self) -> Self:
        self.say(self._first)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.clear()

    def say(self, text: str) -> None:
        """Shows a text instead of the one before; what the terminal's width cannot hold is left out."""
        if self._shown:
            self._written = True
            # A text that went on in a second row would leave the first one behind.
            width = shutil.get_terminal_size().columns - 1
            self._stream.write(f"\r\x1b[K{text[:width]}")
            self._stream.flush()

    def clear(self) -> None:
        """Makes room for something that stays."""
        if self._written:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
            self._written = False
