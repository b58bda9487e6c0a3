"""A process that watches the one that works: at the limit it says what is open, and ends.

    watch = watched(deadline, ["a"])  # from here on the work goes on in a process of its own
    watch.note_open(["a", "b"])
    watch.note_said("a")              # before it is printed

Code in C that does not return (a factorisation, a large number, a pattern), and a machine on which many want the
processors, keep Python from looking at the clock. The process that was called does nothing but wait, so that a
processor is given to it as soon as it wants one: when the time is over it kills the other one, prints
`CANNOT_COMPUTE` for what was not said, and ends with 0. Where that one ends by itself its exit code is that of both;
where it is killed, as when there is no memory left, what is open is said as well. Loading the command may take longer
than its limit, so it is watched before that (`begin`).
"""

from __future__ import annotations

import math
import os
import select
import signal
import sys
import threading
import time
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import NoReturn

from pn2code.base.deadline import Deadline, is_command
from pn2code.contest.words import ALL, UNKNOWN, names, unknown

MOST_S = 60.0
"""What the command has where it is not told."""
OPTIONS = ("--evidence", "--max-seconds", "--memory", "--only")
"""Those of the command that have a value."""
_GRACE_S = 1.25
_GRACE = 0.06
"""So much later than its time, but by no more than that part of it and a quarter of a second, the work may end."""
_LEAST_GRACE_S = 0.25
_POLL_S = 0.2
_PATIENCE_S = 1.0
"""A terminal interrupts both processes; if the one that works has not ended then, it did not hear it."""
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Watch:
    """What the process that watches is told.

    Args:
        told: where it listens; -1: nobody does.
    """

    def __init__(self, told: int = -1) -> None:
        self._told = told

    def note_open(self, names: Iterable[str]) -> None:
        """These lines are wanted."""
        self._tell("".join(f"+{name}\n" for name in names))

    def note_said(self, name: str) -> None:
        """A line is printed next."""
        self._tell(f"-{name}\n")

    def note_all_said(self) -> None:
        """Whatever is open from now on is none of its business."""
        self._tell(".\n")

    def _tell(self, text: str) -> None:
        data = text.encode()
        while self._told >= 0 and data:
            data = data[os.write(self._told, data) :]


_begun: Watch | None = None


def begin(arguments: Sequence[str]) -> None:
    """Watches a command from here on, before it is loaded; not if its arguments are wrong, of which it tells itself.

    Args:
        arguments: of the verb.
    """
    global _begun
    asked = _asked(arguments)
    if asked is not None:
        _begun = watched(*asked)


def _asked(arguments: Sequence[str]) -> tuple[Deadline, list[str]] | None:
    """When the time is over, and the lines that are wanted; None: the arguments are not what they should be."""
    values: dict[str, str] = {}
    others: list[str] = []
    left = iter(arguments)
    for word in left:
        name, sign, value = word.partition("=")
        if name in OPTIONS:
            values[name] = value if sign else next(left, "")
        elif word.startswith("-"):
            return None
        else:
            others.append(word)
    try:
        seconds = float(values.get("--max-seconds", MOST_S))
    except ValueError:
        return None
    if len(others) != 2 or others[1] not in ALL or not math.isfinite(seconds) or seconds < 0.0:
        return None
    return Deadline.of_command(seconds), names(others[1], Path(others[0]))


def watched(deadline: Deadline, names: Iterable[str]) -> Watch:
    """From here on a process works that is watched; it is the one that comes back from here.

    Within a larger program (a test), beside other threads, or without a limit, nobody watches. One that is watched
    from its beginning still is.

    Args:
        deadline: the limit; it may be over already.
        names: the lines that are wanted, as far as they are known; none: they are not.
    """
    if _begun is not None:
        return _begun
    if not is_command() or deadline.seconds is None or threading.active_count() > 1:
        return Watch()
    sys.stdout.flush()
    sys.stderr.flush()
    theirs, ours = os.pipe()
    alive, held = os.pipe()
    worker = os.fork()
    if worker != 0:
        os.close(ours)
        os.close(alive)
        _Watchdog(worker, theirs, deadline, names).run()
    os.close(theirs)
    os.close(held)
    threading.Thread(target=_end_with, args=(alive,), daemon=True).start()
    return Watch(ours)


def _end_with(alive: int) -> None:
    """Nobody works for a process that was killed."""
    os.read(alive, 1)
    os._exit(128 + signal.SIGKILL)


class _Watchdog:
    def __init__(self, worker: int, told: int, deadline: Deadline, names: Iterable[str]) -> None:
        self.worker = worker
        self.told = told
        grace = min(_GRACE_S, _LEAST_GRACE_S + _GRACE * (deadline.seconds or 0.0))
        self.ends = deadline.ends + grace
        self.open: dict[str, None] | None = dict.fromkeys(names) or None
        self.is_all_said = False
        self.heard = b""
        self.interrupted: tuple[int, float] | None = None
        for number in _SIGNALS:
            if signal.getsignal(number) != signal.SIG_IGN:
                signal.signal(number, self._interrupt)

    def _interrupt(self, number: int, _frame: FrameType | None) -> None:
        waits = _PATIENCE_S if number == signal.SIGINT else 0.0
        self.interrupted = number, time.monotonic() + waits

    def run(self) -> NoReturn:
        """Until the other one has ended, or the time is over."""
        while True:
            left = self.ends - time.monotonic()
            if left <= 0.0:
                self._end(is_late=True)
            if self.interrupted is not None and time.monotonic() >= self.interrupted[1]:
                self._kill(self.interrupted[0])
                self.interrupted = signal.SIGKILL, time.monotonic() + _PATIENCE_S
            if select.select([self.told], [], [], min(left, _POLL_S))[0] and not self._hear():
                self._end(is_late=False)

    def _hear(self) -> bool:
        """Whether the other one is still there."""
        data = os.read(self.told, 1 << 16)
        *lines, self.heard = (self.heard + data).split(b"\n")
        for line in map(bytes.decode, lines):
            if line == ".":
                self.is_all_said = True
                continue
            if self.open is None:
                self.open = {}
            if line.startswith("+"):
                self.open[line[1:]] = None
            else:
                self.open.pop(line[1:], None)
        return bool(data)

    def _kill(self, number: int) -> None:
        with suppress(ProcessLookupError):
            os.kill(self.worker, number)

    def _end(self, *, is_late: bool) -> NoReturn:
        if is_late:
            self._kill(signal.SIGKILL)
        code = os.waitstatus_to_exitcode(os.waitpid(self.worker, 0)[1])
        while self._hear():
            pass
        if is_late:
            code = 0
        elif code < 0:
            code = 128 - code
            if self.interrupted is None:
                print(f"pn2code: ended by signal {code - 128}", file=sys.stderr)
        if (is_late or code > 128) and self.interrupted is None and not self.is_all_said:
            names = None if self.open is None else list(self.open)
            with suppress(OSError):  # nobody reads it
                print(*([UNKNOWN] if names is None else map(unknown, names)), sep="\n", flush=True)
        os._exit(code)
