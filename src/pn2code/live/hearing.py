"""What the server of the live view says to the run: lines, read without ever waiting.

    hearing = Hearing(process.stdout.fileno())
    hearing.is_stopping()      # somebody wants the cell to stop
    hearing.present()          # people who may interfere with the run
    hearing.taken()            # what they wish

The lines are `stop`, `{"present": 2}` and `{"wish": {...}}`. When the server has gone, nobody is there.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import Any

_AT_ONCE = 1 << 16
MOST_WISHES = 1000
"""That wait; more are not kept."""


class Hearing:
    """The reading end of the server's standard output."""

    def __init__(self, of: int) -> None:
        os.set_blocking(of, False)
        self._of = of
        self._part = b""
        self._is_stopping = self._is_over = False
        self._present = 0
        self._wishes: list[Mapping[str, Any]] = []

    def is_stopping(self) -> bool:
        """Whether somebody who may do so wants the cell to stop."""
        self._look()
        return self._is_stopping

    def present(self) -> int:
        """How many people are there who may interfere."""
        self._look()
        return self._present

    def taken(self) -> list[Mapping[str, Any]]:
        """Their wishes since the last call."""
        self._look()
        wishes, self._wishes = self._wishes, []
        return wishes

    def _look(self) -> None:
        while not self._is_over:
            try:
                new = os.read(self._of, _AT_ONCE)
            except BlockingIOError:
                return
            except OSError:
                new = b""
            if not new:
                self._is_over, self._present = True, 0
                return
            *lines, self._part = (self._part + new).split(b"\n")
            for line in lines:
                self._hear(line)

    def _hear(self, line: bytes) -> None:
        if line == b"stop":
            self._is_stopping = True
            return
        said = json.loads(line)
        self._present = int(said.get("present", self._present))
        if "wish" in said and len(self._wishes) < MOST_WISHES:
            self._wishes.append(said["wish"])
