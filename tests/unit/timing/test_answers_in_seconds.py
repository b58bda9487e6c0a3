"""Answers in seconds that depend on more than the longest wait."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.diagnostics import Origin
from pn2code.properties.meaning import Atom, Property, Response
from pn2code.semantics.values.data import Data, MlException
from pn2code.timing import verified
from pn2code.timing.answers import Cycle
from pn2code.timing.doings import NS
from pn2code.timing.unstopped import Unstopped
from pn2code.verify.answers.properties import Answer
from pn2code.verify.controller.control_types import CAPACITY, FINITE, MEMORY, Check, Control

ASK, END = 0, 1
FIRST = Atom("fires", ASK)


def judge(
    monkeypatch: pytest.MonkeyPatch, waits: tuple[int, ...], control: Control | None = None
) -> tuple[verified._Judge, list[str]]:
    """One for a cell with a layout for each wait (s); and the runs that it writes."""
    written: list[str] = []
    measured: list[Any] = []
    for seconds in waits:
        arcs = [[(1, 0, ASK)], [(2, seconds * NS, END)], []]
        search: Any = SimpleNamespace(
            why="",
            successors=arcs,
            surely=lambda arcs=arcs: arcs,
            held_up=lambda *_: 0,
            path_to=lambda _: [],
            situations=[(i, (), ()) for i in range(3)],
            stuck=[],
            ends={2},
            faults={},
            stopped=set,
            graph=SimpleNamespace(
                over=set(),
                marked=[{}, {}, {}],
                running=SimpleNamespace(owing={}),
                partition=SimpleNamespace(net=SimpleNamespace(timed=False)),
            ),
        )
        runs = Unstopped(search, 120 * NS)
        anyhow = SimpleNamespace(why="open")
        measured.append(SimpleNamespace(search=search, anyhow=anyhow, runs=runs))
    layouts = [
        SimpleNamespace(name=f"l{s}", cycle=Cycle((), "", (), None, None, (), 3)) for s in waits
    ]
    times: Any = SimpleNamespace(why="", layouts=layouts)

    def shown(_: Any, a: Answer, one: Any, found: Any) -> Answer:
        written.append(layouts[measured.index(one)].name)
        return Answer(a.about, "no", value=found.ns / NS, cell=True)

    def event(_self: Any, _a: Any, _one: Any, formula: Atom) -> Any:
        return lambda mark: mark == formula.number

    monkeypatch.setattr(verified._Judge, "_shown", shown)
    monkeypatch.setattr(verified._Judge, "_event", event)
    opened: Any = SimpleNamespace(config=None)
    none: Any = None
    return verified._Judge(control, opened, none, times, measured, Path()), written


def asked(seconds: str) -> Answer:
    response = Response(FIRST, Atom("fires", END), None, seconds)
    about = Property("p", "", "", "response", True, response, (), Origin("cell.cpn"))
    return Answer(about, "inconclusive", cell=True)


def test_the_run_that_is_kept_is_that_of_the_layout_that_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    one, written = judge(monkeypatch, (3, 7, 9))
    found = one.answer(asked("5"))
    assert (found.answer, found.value, written) == ("no", 7.0, ["l7"])
    found = one.answer(asked("10"))
    assert (found.answer, found.value) == ("yes", 9.001)


@pytest.mark.parametrize(
    ("check", "answer"),
    [
        (Check(CAPACITY, "no", "place `a` holds 2 tokens"), "inconclusive"),
        (Check(MEMORY, "no", "a list is too long"), "inconclusive"),
        (Check(MEMORY, "yes", "there is room"), "no"),
        (Check(FINITE, "no", "it fires for ever"), "no"),
    ],
)
def test_a_supervisor_that_has_no_room_may_stop_before(
    check: Check, answer: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whether it does in the run that would show a "no" nobody knows."""
    nobody: Any = None
    one, _ = judge(monkeypatch, (7,), Control(nobody, (check,), None))
    found = one.answer(asked("5"))
    assert found.answer == answer
    assert answer == "no" or check.says in found.why


def test_a_condition_that_raises_an_exception_has_no_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """`fires(Again, {1 div n = 1})` was an internal error."""

    def raises(*_: Any) -> bool:
        raise MlException(Data("Div", 0))

    monkeypatch.setattr(verified, "Game", lambda *_, **__: None)
    monkeypatch.setattr(verified._Judge, "_is", raises)
    graph = SimpleNamespace(
        elements=[SimpleNamespace(number=0, is_step=False, owner=0)],
        partition=SimpleNamespace(net=None),
        storage={},
    )
    one: Any = SimpleNamespace(search=SimpleNamespace(graph=graph))
    none: Any = None
    judge = verified._Judge(None, none, none, none, (), Path())
    found = judge._event(asked("5"), one, FIRST)
    assert found == "its condition on a binding raised the exception `Div`"
