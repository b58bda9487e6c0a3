"""One line on a terminal that tells how a run goes on."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Self, TextIO

PERIOD_S = 0.2


class Line:
    """A line that is written over again; nothing where the stream is no terminal. It is gone at the end.

    Args:
        shown: whether anything is shown at all.
        stream: where; stderr by default.
    """

    def __init__(self, *, shown: bool = True, stream: TextIO | None = None) -> None:
        self._stream = stream or sys.stderr
        self._shown = shown and self._stream.isatty()
        self._written = False

    def __enter__(self) -> Self:
        self.say("compiling ...")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._written:
            self._stream.write("\r\x1b[K")
            self._stream.flush()

    def say(self, text: str) -> None:
        """Shows a text instead of the one before."""
        if self._shown:
            self._written = True
            self._stream.write(f"\r\x1b[K{text}")
            self._stream.flush()


class ProgressLine(Line):
    """Shows steps, model time and steps per second."""

    def __init__(self, *, shown: bool = True, stream: TextIO | None = None) -> None:
        super().__init__(shown=shown, stream=stream)
        self._last = time.monotonic()
        self._last_steps = 0

    def update(self, steps: int, now: int | float) -> None:
        """The run has made so many steps, at this model time."""
        if not self._shown:
            return
        clock = time.monotonic()
        passed = clock - self._last
        if passed < PERIOD_S:
            return
        rate = (steps - self._last_steps) / passed
        self._last, self._last_steps = clock, steps
        self.say(f"{steps:,} steps   time {now}   {rate:,.0f} steps/s")
