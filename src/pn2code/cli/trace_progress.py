"""How far a trace has been repeated: steps, how many a second, and how long it still takes."""

from __future__ import annotations

import time

from pn2code.base.progress_line import Line


class TraceProgress(Line):
    """A line on standard error.

    Args:
        shown: whether anything is shown at all.
        plain: whether lines are written where that is no terminal as soon as it begins, and not after ten seconds only.
    """

    def __init__(self, *, shown: bool = True, plain: bool = False) -> None:
        super().__init__(
            shown=shown, first="repeating the trace ...", plain=True, patient=not plain
        )
        self._began = time.monotonic()

    def report(self, steps: int, share: float) -> None:
        """So many steps have been repeated, which is about this share of them."""
        passed = max(time.monotonic() - self._began, 1e-9)
        left = passed * (1.0 - share) / max(share, 1e-9)
        self.say(f"{steps:,} steps, {steps / passed:,.0f} a second, about {left:.0f} s left")
