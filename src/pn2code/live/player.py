"""Something that pulls lines, such as `replay_lines`, made into something that they are given to one by one.

    with Player(lambda lines: replay_lines(lines, net)) as player:
        player.play(header)
        result = player.play(line)        # None while it goes on

It has a thread of its own; both take turns, so a line has been dealt with when `play` returns.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

from pn2code.base.closing import Closing

T = TypeVar("T")


class Player(Closing, Generic[T]):
    """Turns a pull into a push.

    Args:
        work: is given the lines, and ends when there are no more, or when it wants no more.
    """

    def __init__(self, work: Callable[[Iterator[str]], T]) -> None:
        self._lines: queue.Queue[str | None] = queue.Queue()
        self._turns: queue.Queue[bool] = queue.Queue()
        self._result: T | None = None
        self._problem: BaseException | None = None
        self._thread = threading.Thread(target=self._run, args=(work,), daemon=True)
        self._thread.start()
        self._is_asking = self._turns.get()

    def play(self, line: str) -> T | None:
        """Gives it a line; its result when it has ended, which it may have done long before."""
        if self._is_asking:
            self._lines.put(line)
            self._is_asking = self._turns.get()
        if self._problem is not None:
            raise self._problem
        return self._result

    def close(self) -> None:
        """There are no more lines."""
        if self._is_asking:
            self._lines.put(None)
            self._is_asking = self._turns.get()
        self._thread.join()

    def _source(self) -> Iterator[str]:
        while True:
            self._turns.put(True)
            line = self._lines.get()
            if line is None:
                return
            yield line

    def _run(self, work: Callable[[Iterator[str]], T]) -> None:
        try:
            self._result = work(self._source())
        except BaseException as problem:
            self._problem = problem
        finally:
            self._turns.put(False)
