"""When an explorer that was told its limit, and does not end, is ended.

It stops at its limit by itself and prints what it has found. Where others use the processors as well, that takes it
longer by the clock on the wall, though not in its own computing time: its grace is counted in both, so that nothing is
lost because it had to wait.
"""

from __future__ import annotations

from collections.abc import Callable

from pn2code.base.deadline import GRACE, GRACE_S, Deadline

MOST = 2.0
"""After so many times the grace a process is ended, whatever it does: a limit of time is kept."""


class Grace:
    """The grace of one process.

    Args:
        deadline: when it should have ended.
        used: seconds of processor time that all its threads have used until now; None: not known, or it has ended.
    """

    def __init__(self, deadline: Deadline, used: Callable[[], float | None]) -> None:
        self._deadline = deadline
        self._used = used
        self._at_the_end: float | None = None

    def is_over(self) -> bool:
        """Whether the process is to be ended now; to be asked from time to time, before the deadline as well."""
        left = self._deadline.left
        if left is None or left > 0.0:
            return False
        used = self._used()
        if self._at_the_end is None:
            self._at_the_end = used
        if not self._deadline.is_long_over():
            return False
        grace = GRACE * (self._deadline.seconds or 0.0) + GRACE_S
        if used is None or self._at_the_end is None or -left > MOST * grace:
            return True
        return used - self._at_the_end > grace
