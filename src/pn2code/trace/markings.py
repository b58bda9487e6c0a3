"""The markings of a replay. Only those are kept that somebody may ask for: the last one, and where a lasso begins.

kept = Markings(first, claimed_loop(path))
kept.add(after)
len(kept), kept[len(kept) - 1]
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Final

from pn2code.semantics.game.marking import Marking

ALL: Final = "all"
"""It is not known which one will be asked for."""
_TAIL = 1 << 16
"""Bytes in which the last line of a file is looked for."""


class Markings:
    """The markings before the first step and after each.

    Args:
        first: that before the first step.
        wanted: which one will be asked for, beside the last; `ALL`: any of them; None: none.
    """

    def __init__(self, first: Marking, wanted: int | str | None = ALL) -> None:
        self._wanted = wanted
        self._kept: dict[int, Marking] = {}
        self._count = 0
        self.add(first)

    def add(self, marking: Marking) -> None:
        """The one after the next step."""
        if self._wanted in (ALL, self._count):
            self._kept[self._count] = marking
        self._last = marking
        self._count += 1

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, step: int) -> Marking:
        """Raises LookupError: it was not kept."""
        return self._last if step == self._count - 1 else self._kept[step]


def claimed_loop(trace: Path) -> int | str | None:
    """Where a lasso goes back to, by the last line of a file: a step; None: it is none; `ALL`: that is not known."""
    try:
        with trace.open("rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(size - _TAIL, 0))
            rows = file.read(_TAIL).rstrip().splitlines()
    except OSError:
        return ALL
    try:
        end = json.loads(rows[-1]) if len(rows) > 1 else None
    except (ValueError, RecursionError):
        return ALL
    if not isinstance(end, dict):
        return ALL
    loop = end.get("loop")
    return loop if loop is None or (isinstance(loop, int) and not isinstance(loop, bool)) else ALL
