"""How something goes on, on standard error: of explorations, comparisons, simulations and runs of cells.

with Line(plain=True, first="reading the net ...") as line:
    line.stage("comparing the supervisor ...")      # a new part of the work
    line.say("12,000 states")                       # how far it is

with told("reading the net") as line:               # what may be over at once, and says nothing by itself
    line.turn_to("translating the net")

Loops deep inside say how far they are (`how_far.counted`). Where nothing is said for a second, the line says for how
long, so that nothing looks frozen. It is the only one that counts seconds.
"""

from __future__ import annotations

import os
import shutil
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import IO, Self

from pn2code.base.handed_on import to_parent
from pn2code.base.how_far import listening

PLAIN_PERIOD_S = 10.0
"""In a file or a pipe a line stays: one in ten seconds shows that the work goes on, and is not too much to read."""
SILENCE_S = 1.0
"""After so long without a word the seconds are counted."""

_WRITING = threading.RLock()
"""Held while a line is written. A process that is forked must not find the stream in the hands of a thread that it
does not have."""
os.register_at_fork(
    before=_WRITING.acquire,
    after_in_parent=_WRITING.release,
    after_in_child=_WRITING.release,
)


class Line:
    """A line that is written over again, and is gone at the end.

    Where the stream is no terminal, nothing is written; with `plain` whole lines are, without control characters: one
    for each stage of the work, and every ten seconds how far it is. In a terminal, while nothing else is told, the
    seconds since the last word stand behind it.

    Args:
        shown: whether anything is shown at all.
        stream: where; stderr by default.
        first: what it says until there is something to tell.
        plain: whether to write lines where the stream is no terminal.
        patient: there nothing is written before ten seconds have passed: what is over sooner leaves no lines behind.
        clock: seconds since any moment.
        silence: after so many seconds without a word they are counted.
    """

    def __init__(
        self,
        *,
        shown: bool = True,
        stream: IO[str] | None = None,
        first: str = "compiling ...",
        plain: bool = False,
        patient: bool = False,
        clock: Callable[[], float] = time.monotonic,
        silence: float = SILENCE_S,
    ) -> None:
        self._stream = stream or sys.stderr
        is_terminal = self._stream.isatty()
        self._shown = shown and is_terminal
        self._is_plain = shown and plain and not is_terminal
        self._clock = clock
        self._told = clock() if patient else 0.0
        self._is_patient = patient
        self._parent = to_parent()
        self._first = first
        self._written = False
        self._text, self._said = "", 0.0
        self._silence = silence
        self._listening = listening(self.say)
        self._begun: float | None = None
        self._suffix: Callable[[], str] | None = None
        self._over = threading.Event()
        self._counting: threading.Thread | None = None

    @property
    def is_heard(self) -> bool:
        """Whether anything that is said is written."""
        return self._shown or self._is_plain or self._parent is not None

    def __enter__(self) -> Self:
        self._listening.__enter__()
        if self._first:
            self.stage(self._first)
        if self._shown:
            self._counting = threading.Thread(target=self._count, daemon=True)
            self._counting.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._listening.__exit__(kind, value, trace)
        self._over.set()
        if self._counting is not None:
            self._counting.join()
        self.clear()

    def _count(self) -> None:
        """Shows how long nothing has been said, as long as the line is there."""
        while not self._over.wait(self._silence / 2):
            with _WRITING:
                now = self._clock()
                lasted = now - self._said
                if self._begun is not None and now - self._begun >= self._silence:
                    self._begun, self._written = None, True
                    self._show(self._shown_as(lasted))
                elif self._written and self._text and lasted >= self._silence:
                    self._show(self._shown_as(lasted))

    def _shown_as(self, lasted: float) -> str:
        """The last word, and how long ago it was if that is long."""
        more = self._suffix() if self._suffix is not None else ""
        if lasted < self._silence:
            return f"{self._text}{more}"
        seconds = f"{':' if more else ' ...'} {lasted:.0f} s"
        return f"{self._text.removesuffix(' ...')}{seconds}{more}"

    def turn_to(
        self, text: str, more: Callable[[], str] | None = None, since: float | None = None
    ) -> None:
        """Something else takes the time from now on; it is only shown where all that was so begun is not over soon.

        Args:
            text: what.
            more: makes what stands behind the seconds, whenever they are shown.
            since: the moment from which they are counted; None: now.
        """
        self._hand_on(text)
        with _WRITING:
            now = self._clock()
            self._text, self._suffix = text, more
            self._said = now if since is None else since
            if self._shown and self._written:
                self._show(self._shown_as(now - self._said))
            elif self._begun is None:
                self._begun = now

    def stage(self, text: str) -> None:
        """Shows a text that begins a new part of the work: it is a line of its own where lines stay."""
        if self._is_plain and not self._is_patient:
            self._hand_on(text)
            self._write_line(text)
        else:
            self.say(text)

    def say(self, text: str) -> None:
        """Shows a text instead of the one before; what the terminal's width cannot hold is left out."""
        self._hand_on(text)
        if self._is_plain and self._clock() - self._told >= PLAIN_PERIOD_S:
            self._write_line(text)
        if self._shown:
            with _WRITING:
                self._text, self._said, self._written = text, self._clock(), True
                self._begun = self._suffix = None
                self._show(text)

    def _hand_on(self, text: str) -> None:
        if self._parent is not None:
            self._parent(text)

    def _show(self, text: str) -> None:
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
        with _WRITING:
            self._begun = None
            if self._written:
                self._stream.write("\r\x1b[K")
                self._stream.flush()
                self._written = False


@contextmanager
def told(what: str, *, shown: bool = True) -> Iterator[Line]:
    """What may take long and says nothing by itself: a terminal shows from the second second on how long it takes, and
    how far its loops are.

    Nothing else is to be printed meanwhile.
    """
    with Line(first="", shown=shown, plain=True, patient=True) as line:
        line.turn_to(what)
        yield line
