"""Says once a second how long something takes that says nothing by itself.

with Ticking(line.say, "verification"):
    process.wait()                          # "verification: 12 s"

with told("reading the net"):               # the same in a line of its own
    read(path)
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Self

from pn2code.base.progress_line import Line

PERIOD_S = 1.0


class Ticking:
    """A thread that tells while a block lasts.

    Args:
        say: is given what is to be said; it is called by that thread, and no more after the block.
        what: what takes the time.
        period: between two words, s.
    """

    def __init__(self, say: Callable[[str], None], what: str, period: float = PERIOD_S) -> None:
        self._say, self._what, self._period = say, what, period
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._tell, daemon=True)

    def __enter__(self) -> Self:
        self._began = time.monotonic()
        self._thread.start()
        return self

    def turn_to(self, what: str) -> None:
        """Something else takes the time from now on; the seconds are those of all."""
        self._what = what

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._over.set()
        self._thread.join()

    def _tell(self) -> None:
        while not self._over.wait(self._period):
            self._say(f"{self._what}: {time.monotonic() - self._began:.0f} s")


@contextmanager
def told(what: str) -> Iterator[Ticking]:
    """What may take long and says nothing by itself: a terminal shows from the second second on how long it takes.

    Nothing else is to be printed meanwhile.
    """
    with Line(first="") as line, Ticking(line.say, what) as ticking:
        yield ticking
