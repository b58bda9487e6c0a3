"""Answers that are worked out ahead by other processes, and taken in order by this one.

with Ahead(tasks, jobs=2) as ahead:
    for i in order:
        ahead.take(i)               # as tasks[i]() would give it

Who takes them goes on as if it had worked them out itself, so what comes of them does not depend on the number of
processes. These are copies of this one, with all that it has read and planned; they get numbers of tasks and send what
they give. Where one has ended (somebody has killed it, a task raises an exception) what it had is worked out here. They
end with this process, whatever ends it, and leave interrupts to it.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import warnings
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from types import TracebackType
from typing import Generic, TypeVar

from pn2code.base.frozen import record

T = TypeVar("T")
WORTH = 48
"""Tasks for which processes are begun."""
_AT_ONCE = 2
"""Tasks that a process has, so that it need not wait for the next one."""
_WINDOW = 8
"""Tasks for each process that are worked out before they are taken."""


@record
class _Helper:
    process: BaseProcess
    told: Connection
    tasks: list[int]


class Ahead(Generic[T]):
    """Works tasks out.

    Args:
        tasks: they, about in the order in which they are taken.
        jobs: processes; 1: everything is worked out here, when it is taken.
        wanted: whether a task need be worked out ahead.
    """

    def __init__(
        self,
        tasks: Sequence[Callable[[], T]],
        jobs: int,
        wanted: Callable[[int], bool] = lambda _task: True,
    ) -> None:
        self._tasks, self._wanted = tasks, wanted
        self._helpers: list[_Helper] = []
        self._given: set[int] = set()
        self._done: dict[int, T] = {}
        self._next = 0
        if jobs > 1 and len(tasks) >= WORTH and sys.platform == "linux":
            self._begin(jobs)

    def __enter__(self) -> Ahead[T]:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        raised: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @property
    def processes(self) -> list[int]:
        """Their numbers in the system."""
        return [h.process.pid for h in self._helpers if h.process.pid is not None]

    def take(self, task: int) -> T:
        """What a task gives; each is taken once."""
        while task not in self._done:
            if not self._helpers:
                return self._tasks[task]()
            self._give(task)
            if self._helpers:  # none may be left to whom it could be given
                self._hear()
        return self._done.pop(task)

    def close(self) -> None:
        """Ends the processes."""
        for h in self._helpers:
            h.told.close()
            h.process.kill()
        for h in self._helpers:
            h.process.join()
            h.process.close()
        self._helpers = []

    def _begin(self, jobs: int) -> None:
        context = multiprocessing.get_context("fork")
        others: list[Connection] = []
        with warnings.catch_warnings():
            # Other threads of this process only say how far it is; the copies say nothing.
            warnings.simplefilter("ignore", DeprecationWarning)
            for _ in range(jobs):
                told, own = context.Pipe()
                others.append(told)
                process = context.Process(
                    target=_work, args=(self._tasks, own, list(others)), daemon=True
                )
                # An interrupt before its first line would end it: it waits until the copy hears none.
                before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
                try:
                    process.start()
                except OSError:  # the system has no room for more
                    told.close()
                    break
                finally:
                    signal.pthread_sigmask(signal.SIG_SETMASK, before)
                    own.close()
                self._helpers.append(_Helper(process, told, []))

    def _give(self, first: int) -> None:
        """Gives all processes something to do: what is taken first, then what comes after it."""
        self._next = max(self._next, first)
        for h in list(self._helpers):
            while len(h.tasks) < _AT_ONCE:
                task = self._following(first)
                if task is None:
                    return
                try:
                    h.told.send(task)
                except OSError:
                    self._lose(h)
                    break
                h.tasks.append(task)
                self._given.add(task)

    def _following(self, first: int) -> int | None:
        if first not in self._given:
            return first
        end = min(len(self._tasks), first + _WINDOW * len(self._helpers))
        while self._next < end:
            task = self._next
            self._next += 1
            if task not in self._given and self._wanted(task):
                return task
        return None

    def _hear(self) -> None:
        """Waits for something that is done."""
        by = {h.told: h for h in self._helpers}
        for told in wait(list(by)):
            assert isinstance(told, Connection)
            h = by[told]
            try:
                task, found = told.recv()
            except (EOFError, OSError):
                self._lose(h)
                continue
            h.tasks.remove(task)
            self._done[task] = found

    def _lose(self, h: _Helper) -> None:
        """One has ended: what it had is open again."""
        self._given -= set(h.tasks)
        self._helpers.remove(h)
        h.told.close()
        h.process.join()
        h.process.close()


def _work(
    tasks: Sequence[Callable[[], object]], own: Connection, others: Sequence[Connection]
) -> None:
    """What a process does until nobody is at the other end."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    for other in others:
        other.close()
    try:
        while True:
            task = own.recv()
            own.send((task, tasks[task]()))
    except BaseException:
        os._exit(0)  # whoever asked works it out, and hears of exceptions
