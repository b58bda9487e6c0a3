"""Notes of a run whose times cannot be: a step before its tool's action ends, and two actions at once."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from pn2code.conform.notes import RunNotes
from pn2code.robot.commands import ToolAction


def notes() -> RunNotes:
    config: Any = SimpleNamespace(
        primitives=None, sensors=(), parts_at_start={}, tools_at_start={}, channels=()
    )
    owners = [SimpleNamespace(name="supervisor"), SimpleNamespace(name="belt")]
    partition: Any = SimpleNamespace(transition_owner=(1,), owners=owners, channels=())
    made = RunNotes(config, partition)
    listener: Any = object()
    made._listener = listener
    calls: Any = [ToolAction("advance", 3.0)]
    made._calls = calls
    return made


def tool(t: float) -> dict[str, Any]:
    return {"t": t, "event": "tool", "robot": "belt", "action": "advance", "duration": 3.0}


def step(made: RunNotes, t: float) -> str | None:
    transition: Any = SimpleNamespace(index=0, plan=())
    marking: Any = SimpleNamespace(places=())
    return made.step({"t": t, "binding": {}}, transition, marking, marking)


def test_a_step_ends_after_its_actions() -> None:
    made = notes()
    assert made.note(tool(0.0)) is None and step(made, 3.0) is None
    made = notes()
    assert made.note(tool(0.0)) is None
    assert "only at 3 s" in str(step(made, 2.0))


def test_a_robot_does_one_thing_at_a_time() -> None:
    made = notes()
    assert made.note(tool(0.0)) is None
    assert "until 3 s" in str(made.note(tool(1.0)))
