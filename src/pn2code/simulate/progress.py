"""How a simulation goes on."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TextIO

from pn2code.base.progress_line import Line

PERIOD_S = 0.2


class ProgressLine(Line):
    """Shows steps, model time, steps per second, and how much longer it takes at most.

    Args:
        shown: whether anything is shown at all; stream: where.
        steps: at most in a run; 0: nobody knows.
        runs: how many there are.
        clock: seconds since any moment.
    """

    def __init__(
        self,
        *,
        shown: bool = True,
        stream: TextIO | None = None,
        steps: int = 0,
        runs: int = 1,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(shown=shown, stream=stream, plain=True, patient=True, clock=clock)
        self._most, self._runs = steps, runs
        self._last = clock()
        self._last_steps = 0
        self._run, self._before = 1, 0
        self._begun_at: float | None = None
        self._begun_steps = 0

    def update(self, steps: int, now: int | float) -> None:
        """The run has made so many steps, at this model time."""
        if not self.is_heard:
            return
        clock = self._clock()
        if self._begun_at is None:
            self._begun_at, self._begun_steps = clock, steps
        if steps < self._last_steps:  # those of the next run
            self._run, self._before, self._last_steps = (
                self._run + 1,
                self._before + self._last_steps,
                0,
            )
        passed = clock - self._last
        if passed < PERIOD_S:
            return
        rate = (steps - self._last_steps) / passed
        self._last, self._last_steps = clock, steps
        run = f"run {self._run:,} of {self._runs:,}: " if self._runs > 1 else ""
        text = f"{run}{steps:,} steps   time {now}   {rate:,.0f} steps/s"
        self.say(text + self._left(steps, clock - self._begun_at))

    def _left(self, steps: int, passed: float) -> str:
        """By the mean rate from the first word on, which leaves the compilation out."""
        done = self._before + steps
        made = done - self._begun_steps
        if not self._most or passed <= 0 or made <= 0:
            return ""
        left = max(self._most * self._runs - done, 0) * passed / made
        return f"   {left:,.0f} s left at most"
