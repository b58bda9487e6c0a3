"""The lanes of the engine end in time."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest

from pn2code.contest import diagrams
from pn2code.contest.engine import Said, Task, ask
from pn2code.contest.portfolio import space
from pn2code.contest.tables import Tables


def test_a_task_that_is_still_being_made_is_not_waited_for() -> None:
    """Nor does its lane say anything to those who use the queue later."""
    go_on = threading.Event()
    is_made = threading.Event()

    def tasks() -> Iterator[Task]:
        go_on.wait(600.0)
        is_made.set()
        raise ValueError("late")
        yield Task("walk", "", 1.0, 1)

    said: Said = SimpleQueue()
    assert not list(ask(Path("engine"), [tasks()], said, until=time.monotonic()))
    go_on.set()
    assert is_made.wait(600.0)
    time.sleep(0.05)
    assert said.empty()


def test_a_state_space_does_not_wait_for_orders_of_diagrams(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    go_on = threading.Event()

    def late(*_: object) -> list[list[int]]:
        if not go_on.wait(600.0):
            raise AssertionError("it was waited for")
        return []

    monkeypatch.setattr(diagrams, "orders", late)
    tables = Tables((1,), ({0: 1},), ({},), {"p": (0,)}, {"t": (0,)})
    assert space(Path("engine"), tables, seconds=0.0, mebibytes=16, only="diagrams") is None
    go_on.set()
