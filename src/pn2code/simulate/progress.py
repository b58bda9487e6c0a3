"""How a simulation goes on."""

from __future__ import annotations

import time
from typing import TextIO

from pn2code.base.progress_line import Line

PERIOD_S = 0.2


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
