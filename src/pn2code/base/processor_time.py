"""What a process has computed, and how long one waits for its next word.

A process that has to wait for the processor, since others compute as well, has had no chance to answer: patience with
it is counted in its own processor time, so that what comes out does not depend on who else is at work.

    patience = Patience(60.0, lambda: processor_time(process.pid))
    while no_answer():
        if patience.is_over(): ...      # it computes and computes
    patience.renew()                    # it has said something
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

_PROC = Path("/proc")
_BASE_S = 0.5
"""Most answers come earlier than that; until then nobody looks what a process has used."""
_IDLE = 20.0
"""Times the patience by the clock after which a process has had its time, whether it computes or not."""


def processor_time(pid: int) -> float | None:
    """Seconds of processor time of a process with all its threads; None where the system does not tell."""
    words = _stat(pid)
    return None if words is None else _used(words)


def group_time(group: int) -> float | None:
    """The same of all processes of a group together; one that has ended, and was waited for, no longer counts."""
    try:
        pids = [int(name.name) for name in _PROC.iterdir() if name.name.isdecimal()]
    except OSError:
        return None
    known = [words for pid in pids if (words := _stat(pid)) is not None and int(words[2]) == group]
    return sum(map(_used, known)) if known else None


def _stat(pid: int) -> list[str] | None:
    """Of its line in the system's table what comes after the name: that, in parentheses, may have blanks in it."""
    with suppress(OSError):
        text = (_PROC / str(pid) / "stat").read_text(encoding="utf-8", errors="replace")
        return text.rpartition(")")[2].split()
    return None


def _used(words: list[str]) -> float:
    return float(int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class Patience:
    """With one process that should say something.

    Args:
        seconds: of processor time that it may take for it.
        used: what it has used since its start; None: the system does not tell, and the clock decides.
        clock: seconds, always forward.
    """

    def __init__(
        self,
        seconds: float,
        used: Callable[[], float | None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._seconds = seconds
        self._used = used
        self._clock = clock
        self.renew()

    def renew(self) -> None:
        """It has said something: what it takes for the next word counts from now on."""
        self._began = self._clock()
        self._before: float | None = None

    def is_over(self) -> bool:
        """Whether it has computed for so long; to be asked from time to time."""
        waited = self._clock() - self._began
        if waited > _IDLE * self._seconds:
            return True
        if waited < min(_BASE_S, self._seconds):
            return False
        used = self._used()
        if used is None:
            return waited > self._seconds
        if self._before is None:
            self._before = used
        return used - self._before > self._seconds
