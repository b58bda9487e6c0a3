"""Ctrl-C that ends a run instead of the program: the first one is a wish, the second one ends everything."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any, Self


class Interrupts:
    """While the block lasts, SIGINT and SIGTERM are remembered; a second one is treated as before."""

    def __init__(self) -> None:
        self._wanted = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._remember)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def is_wanted(self) -> bool:
        """Whether the run shall end."""
        return self._wanted

    def _remember(self, number: int, frame: FrameType | None) -> None:
        if self._wanted:
            before = self._before[number]
            if callable(before):
                before(number, frame)
        self._wanted = True
