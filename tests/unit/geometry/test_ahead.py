"""Answers that other processes work out ahead."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial

import pytest

from pn2code.geometry.ahead import WORTH, Ahead

COUNT = 2 * WORTH


def squared(n: int) -> tuple[int, int]:
    """With who has worked it out."""
    return n * n, os.getpid()


def tasks(work: Callable[[int], object] = squared) -> list[Callable[[], object]]:
    return [partial(work, n) for n in range(COUNT)]


def is_there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def test_others_work_and_the_order_is_that_of_who_asks() -> None:
    with Ahead(tasks(), 2) as ahead:
        pids = ahead.processes
        found = [ahead.take(i) for i in range(0, COUNT, 3)]
    assert [x for x, _ in found] == [n * n for n in range(0, COUNT, 3)]  # type: ignore[misc]
    assert {p for _, p in found} <= set(pids) and os.getpid() not in pids  # type: ignore[misc]
    assert len(pids) == 2 and not any(map(is_there, pids))


@pytest.mark.parametrize(("count", "jobs"), [(WORTH - 1, 2), (COUNT, 1)])
def test_small_work_is_done_here(count: int, jobs: int) -> None:
    with Ahead(tasks()[:count], jobs) as ahead:
        assert ahead.processes == []
        assert ahead.take(7) == (49, os.getpid())


def test_what_nobody_wants_is_not_worked_out() -> None:
    with Ahead(tasks(), 2, lambda i: i % 10 == 0) as ahead:
        for i in range(0, COUNT, 10):
            assert ahead.take(i)[0] == i * i  # type: ignore[index]
        assert not ahead._done


def test_it_is_taken_in_any_order() -> None:
    with Ahead(tasks(), 3) as ahead:
        for i in reversed(range(COUNT)):
            assert ahead.take(i)[0] == i * i  # type: ignore[index]


def test_those_that_are_killed_are_missed_by_nobody() -> None:
    with Ahead(tasks(), 2) as ahead:
        for i in range(COUNT):
            if i in (5, 40):
                os.kill(ahead.processes[0], signal.SIGKILL)
            assert ahead.take(i)[0] == i * i  # type: ignore[index]
        assert ahead.processes == []


def test_where_the_last_is_lost_while_it_is_told_the_task_is_done_here() -> None:
    with Ahead(tasks(), 2) as ahead:
        ahead.take(0)
        for h in ahead._helpers:
            h.process.kill()
            h.process.join()
            h.tasks.clear()  # so that it is told something again
        ahead._given.clear()
        assert ahead.take(COUNT - 1) == squared(COUNT - 1)
        assert ahead.processes == []


def test_an_exception_is_raised_where_the_task_is_taken() -> None:
    def work(n: int) -> int:
        if n == 20:
            raise ValueError("twenty")
        return n

    with Ahead(tasks(work), 2) as ahead:
        for i in range(20):
            assert ahead.take(i) == i
        with pytest.raises(ValueError, match="twenty"):
            ahead.take(20)
        assert ahead.take(21) == 21


def test_interrupts_are_for_who_asks_only() -> None:
    def work(n: int) -> int:
        time.sleep(0.002)
        return n

    with pytest.raises(KeyboardInterrupt), Ahead(tasks(work), 2) as ahead:
        pids = ahead.processes
        ahead.take(0)
        for pid in pids:
            os.kill(pid, signal.SIGINT)
        assert [ahead.take(i) for i in range(1, 9)] == list(range(1, 9))
        assert ahead.processes == pids
        raise KeyboardInterrupt
    assert not any(map(is_there, pids))


def test_they_end_with_who_asks_whatever_ends_it() -> None:
    program = """
import os, signal, sys
from functools import partial
from pn2code.geometry.ahead import Ahead
ahead = Ahead([partial(pow, n, 2) for n in range(100)], 3)
ahead.take(0)
print(*ahead.processes, flush=True)
os.kill(os.getpid(), signal.SIGKILL)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=False
    )
    pids = [int(word) for word in done.stdout.split()]
    assert len(pids) == 3
    until = time.monotonic() + 600.0
    while any(map(is_there, pids)) and time.monotonic() < until:
        time.sleep(0.01)
    assert not any(map(is_there, pids))
