"""How something goes on, on standard error: of explorations, comparisons, simulations and runs of cells.

with Line(plain=True, first="reading the net ...") as line:
    line.stage("comparing the supervisor ...")      # a new part of the work
    line.say("12,000 states")                       # how far it is
"""

from __future__ import annotations

import shutil
import sys
import time
from collections.abc import Callable
from types import TracebackType
from typing import IO, Self

PLAIN_PERIOD_S = 10.0
"""In a file or a pipe a line stays: one in ten seconds shows that the work goes on, and is not too much to read."""


class Line:
    """A line that is written over again, and is gone at the end.

    Where the stream is no terminal, nothing is written; with `plain` whole lines are, without control characters: one
    for each stage of the work, and every ten seconds how far it is.

    Args:
        shown: whether anything is shown at all.
        stream: where; stderr by default.
        first: what it says until there is something to tell.
        plain: whether to write lines where the stream is no terminal.
        clock: seconds since any moment.
    """

    def __init__(
        self,
        *,
        shown: bool = True,
        stream: IO[str] | None = None,
        first: str = "compiling ...",
        plain: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._stream = stream or sys.stderr
        is_terminal = self._stream.isatty()
        self._shown = shown and is_terminal
        self._is_plain = shown and plain and not is_terminal
        self._clock = clock
        self._told = 0.0
        self._first = first
        self._written = False

    def __enter__(self) -> Self:
        self.stage(self._first)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.clear()

    def stage(self, text: str) -> None:
        """Shows a text that begins a new part of the work: it is a line of its own where lines stay."""
        if self._is_plain:
            self._write_line(text)
        else:
            self.say(text)

    def say(self, text: str) -> None:
        """Shows a text instead of the one before; what the terminal's width cannot hold is left out."""
        if self._is_plain and self._clock() - self._told >= PLAIN_PERIOD_S:
            self._write_line(text)
        if self._shown:
            self._written = True
            # A text that went on in a second row would leave the first one behind.
            width = shutil.get_terminal_size().columns - 1
            self._stream.write(f"\r\x1b[K{text[:width]}")
            self._stream.flush()

    def keep(self, text: str) -> None:
        """Writes a line that stays, in a terminal, too."""
        if self._shown:
            self.clear()
            self._write_line(text)
        elif self._is_plain:
            self._write_line(text)

    def _write_line(self, text: str) -> None:
        self._told = self._clock()
        self._stream.write(f"{text}\n")
        self._stream.flush()

    def clear(self) -> None:
        """Makes room for something that stays."""
        if self._written:
            self._stream.write("\r\x1b[K")
            self._stream.flush()
            self._written = False
