"""The lanes of the engine end in time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from queue import SimpleQueue

import pytest

from pn2code.contest import diagrams, equation
from pn2code.contest.engine import Said, Task, ask
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import AtMost, Constant, Op, Tokens
from pn2code.contest.portfolio import answers
from pn2code.contest.space import space
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


def test_orders_are_not_made_better_for_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Callable[[], bool]] = []
    is_asked = threading.Event()

    def better(*_: object, enough: Callable[[], bool], **__: object) -> list[int]:
        asked.append(enough)
        is_asked.set()
        return [0, 1]

    monkeypatch.setattr(diagrams, "improved", better)
    tables = Tables((1, 0), ({0: 1},), ({1: 1},), {"p": (0,), "q": (1,)}, {"t": (0,)})
    assert space(Path("engine"), tables, seconds=0.0, mebibytes=16, only="diagrams") is None
    assert is_asked.wait(600.0)
    assert asked[0]()


class _Solver:
    """A solver that is never done: who waits for it waits as long as it would."""

    def __init__(self) -> None:
        self.waited: list[float] = []
        self.lock = threading.Lock()

    def acquire(self, timeout: float) -> bool:
        self.waited.append(timeout)
        return False

    def __enter__(self) -> None:
        self.lock.acquire()

    def __exit__(self, *_: object) -> None:
        self.lock.release()


def test_linear_programs_are_waited_for_once_and_only_while_there_is_time(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However many threads solve some."""
    solver = _Solver()
    monkeypatch.setattr(equation, "_solving", solver)
    tables = Tables((1, 0), ({0: 1}, {1: 1}), ({1: 1}, {0: 1}), {"p": (0,)}, {"t": (0,)})
    often = Op("A", (Op("G", (Op("E", (Op("X", (AtMost(Tokens(("p",)), Constant(0)),)),)),)),))
    asked = [
        Asked("f", (), None, value=True, formula=often, kind="ctl"),
        Asked("g", (Part("reach", "reach dead"),), None, value=True),
    ]
    seconds = 0.15  # too little for the engine
    list(answers(Path("engine"), tables, asked, seconds=seconds))
    assert sum(solver.waited) <= 0.05 * seconds
    assert len(solver.waited) == 1
