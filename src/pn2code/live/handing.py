"""Handing things to another process without ever waiting for it.

    handing = Handing(process.stdin.fileno())
    if handing.is_free():
        handing.give({"t": 1.0})

What does not fit into the pipe is kept and sent later; until then the pipe is not free, and whoever has something to
say leaves it out. So at most one thing waits, and the giver is never held up.
"""

from __future__ import annotations

import os
import pickle
import select
import struct
import time
from typing import IO, Any

_HEAD = struct.Struct("<Q")
LARGEST = 1 << 30


class Handing:
    """The writing end of a pipe, which is not waited for."""

    def __init__(self, into: int) -> None:
        os.set_blocking(into, False)
        self._into = into
        self._left = memoryview(b"")
        self.is_broken = False
        """Nobody reads any more."""

    def is_free(self) -> bool:
        """Whether all that was given has gone."""
        self._push()
        return not self.is_broken and not self._left

    def give(self, thing: Any) -> None:
        """Hands something over.

        Raises:
            RuntimeError: it is not free; what is on its way would be cut off.
        """
        if self._left:
            raise RuntimeError("the pipe is not free")
        data = pickle.dumps(thing, pickle.HIGHEST_PROTOCOL)
        self._left = memoryview(_HEAD.pack(len(data)) + data)
        self._push()

    def finish(self, seconds: float) -> bool:
        """Waits so long at most until all has gone; whether it has."""
        until = time.monotonic() + seconds
        while not self.is_free():
            left = until - time.monotonic()
            if self.is_broken or left <= 0:
                return False
            select.select([], [self._into], [], left)
        return True

    def _push(self) -> None:
        while self._left and not self.is_broken:
            try:
                done = os.write(self._into, self._left)
            except BlockingIOError:
                return
            except OSError:
                self.is_broken = True
                return
            self._left = self._left[done:]


def taken(stream: IO[bytes]) -> Any:
    """The next thing from the reading end; None: there is no more."""
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    size = _HEAD.unpack(head)[0]
    data = stream.read(size)
    return pickle.loads(data) if len(data) == size else None
