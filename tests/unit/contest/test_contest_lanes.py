"""The lanes of the engine end in time."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path
from queue import SimpleQueue

from pn2code.contest.engine import Said, Task, ask


def test_a_task_that_is_still_being_made_is_not_waited_for() -> None:
    """Nor does its lane say anything to those who use the queue later."""
    go_on = threading.Event()
    is_made = threading.Event()

    def tasks() -> Iterator[Task]:
        go_on.wait(60.0)
        is_made.set()
        raise ValueError("late")
        yield Task("walk", "", 1.0, 1)

    said: Said = SimpleQueue()
    assert not list(ask(Path("engine"), [tasks()], said, until=time.monotonic()))
    go_on.set()
    assert is_made.wait(60.0)
    time.sleep(0.05)
    assert said.empty()
