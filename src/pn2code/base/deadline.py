"""The time that a command may take, from its start to its last line.

    deadline = Deadline.after(60.0)
    with deadline.enforced():          # pure Python that nobody can ask to end: it is left by an exception
        files = generate(net)
    if deadline.is_over(): ...

Whatever runs as a process of its own is asked to end, or is ended, when `is_over` says so.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from types import FrameType

from pn2code.base.frozen import frozen

_AGAIN_S = 0.1
"""An exception that is raised in a destructor is lost: the alarm comes again and again until it has been heard."""
_LEAST_S = 1e-6
"""An alarm in no time at all would be none."""
GRACE = 0.03
"""A process that was told its limit, and does not end, is ended after so large a part of the limit ..."""
GRACE_S = 0.03
"""... and so many seconds more."""

_LOADER = "<frozen importlib._bootstrap>"
"""Where Python loads modules."""

_started: float | None = None


def note_start() -> None:
    """Notes that the command begins now; loading the modules of a verb takes some tenths of a second."""
    global _started
    _started = time.monotonic()


def is_command() -> bool:
    """Whether this process is a command, and not a program that uses its functions."""
    return _started is not None


class OverError(BaseException):
    """A deadline came while pure Python was at work. It is no error of what was done, so nothing catches it."""


class TimeIsOverError(OverError):
    """The time of some work is over: who has set the deadline goes on without it."""


class CommandIsOverError(OverError):
    """The time of a command is over that has no answer then; it passes those who wait for the end of other work."""


@frozen
class Deadline:
    """When the time is over.

    Args:
        seconds: how long there was from the start; None: for ever.
        ends: the time of `clock` at which it is over.
        clock: seconds, always forward.
    """

    seconds: float | None = None
    ends: float = 0.0
    clock: Callable[[], float] = time.monotonic

    @staticmethod
    def after(seconds: float | None, clock: Callable[[], float] = time.monotonic) -> Deadline:
        """So many seconds from now on; None: never."""
        return Deadline(seconds, clock() + (seconds or 0.0), clock)

    @staticmethod
    def of_command(seconds: float | None) -> Deadline:
        """So many seconds from the start of the command on; None: never."""
        began = time.monotonic() if _started is None else _started
        return Deadline(seconds, began + (seconds or 0.0))

    @property
    def left(self) -> float | None:
        """Seconds, less than 0 when it has been over for some time; None: there is no end."""
        return None if self.seconds is None else self.ends - self.clock()

    def share(self, part: float) -> Deadline:
        """A deadline after a part of what is left, for the first of several things."""
        left = self.left
        if left is None:
            return self
        return replace(self, ends=self.clock() + part * max(left, 0.0))

    def is_over(self) -> bool:
        """Whether the time is over."""
        left = self.left
        return left is not None and left <= 0.0

    def is_long_over(self) -> bool:
        """Whether what was told to end by then, and has not, is to be ended."""
        left = self.left
        return left is not None and -left > GRACE * (self.seconds or 0.0) + GRACE_S

    @contextmanager
    def enforced(self, error: type[OverError] = TimeIsOverError) -> Iterator[None]:
        """While the block lasts it is left with the error when the time is over (in the main thread only).

        Blocks may be inside each other: the outer deadline counts again when the inner block has been left.

        Raises:
            TimeIsOverError, CommandIsOverError: the time is over, perhaps before the block has begun.
        """
        left = self.left
        if left is None or threading.current_thread() is not threading.main_thread():
            yield
            return
        if left <= 0.0:
            raise error
        ring = partial(self._ring, error=error)
        before = signal.signal(signal.SIGALRM, ring)
        outer, _ = signal.setitimer(signal.ITIMER_REAL, max(left, _LEAST_S), _AGAIN_S)
        began = time.monotonic()
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, before)
            if outer > 0.0:
                rest = outer - (time.monotonic() - began)
                signal.setitimer(signal.ITIMER_REAL, max(rest, _LEAST_S), _AGAIN_S)

    def _ring(
        self, number: int, frame: FrameType | None, error: type[OverError] = TimeIsOverError
    ) -> None:
        if self.is_over() and not _is_importing(frame) and not _is_leaving():
            raise error


def _is_importing(frame: FrameType | None) -> bool:
    """Whether a module is being loaded, which is not broken off.

    The loader of a compiled module turns every exception into an ImportError, and the module could not be loaded again.
    """
    while frame is not None:
        if frame.f_code.co_filename == _LOADER:
            return True
        frame = frame.f_back
    return False


def _is_leaving() -> bool:
    """Whether the blocks are being left already: what they tidy up on the way out is not broken off."""
    problem = sys.exc_info()[1]
    while problem is not None and not isinstance(problem, OverError):
        problem = problem.__context__
    return problem is not None


NEVER = Deadline()
"""For those who have all the time."""
