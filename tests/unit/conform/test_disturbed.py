"""Notes of robots that stood and of messages that were late or lost: what a trace says after them must be possible."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from pn2code.conform.disturbed import Disturbed

ROBOT, SUPERVISOR = 0, 1
"""The transitions: the robot sends on `done`, the supervisor takes from it."""


def followed() -> Disturbed:
    channel = SimpleNamespace(name="done", file="done.robcad", place=0, writer=1, reader=0)
    owners = [SimpleNamespace(name="supervisor"), SimpleNamespace(name="robot")]
    partition: Any = SimpleNamespace(transition_owner=(1, 0), owners=owners, channels=(channel,))
    config: Any = SimpleNamespace(channels=())
    return Disturbed(config, partition)


def step(made: Disturbed, t: float, transition: int, before: int, after: int) -> str | None:
    one: Any = SimpleNamespace(index=transition)
    around: list[Any] = [SimpleNamespace(places=("x" * n,)) for n in (before, after)]
    return made.step({"t": t}, one, *around)


def note(event: str, t: float, **more: Any) -> dict[str, Any]:
    return {"t": t, "event": event, "robot": "robot", **more}


def message(t: float, fate: str, channel: str = "done", **more: Any) -> dict[str, Any]:
    return note("message", t, channel=channel, fate=fate, by="person", **more)


def test_a_robot_that_stood_is_not_at_its_end_before() -> None:
    made = followed()
    assert made.note(note("stand", 1.0, duration=2.0)) is None
    assert made.note(note("stand", 1.0, duration=20.0)) is None
    assert made.begins("robot", 1.0) is None
    assert "until 23 s" in str(made.begins("robot", 2.0))
    assert "until 23 s" in str(made.note(note("stand", 3.0, duration=1.0)))
    assert "until 23 s" in str(step(made, 22.0, ROBOT, 0, 0))
    assert step(made, 2.0, SUPERVISOR, 0, 0) is None
    assert made.left("robot")
    assert step(made, 23.0, ROBOT, 0, 0) is None
    assert not made.left("robot")


def test_who_is_held_stands_once_and_goes_on_after() -> None:
    made = followed()
    assert "nobody held it" in str(made.note(note("stand", 1.0, duration=2.0, by="person")))
    assert made.note(note("hold", 2.0, by="person")) is None
    assert "stands already" in str(made.note(note("hold", 3.0, by="person")))
    assert "for how long" in str(made.held())
    assert made.note(note("stand", 4.0, duration=2.0, by="person")) is None
    assert made.held() is None
    assert "only a `person`" in str(made.note(note("hold", 5.0, by="nobody")))
    assert "stood for -1 s" in str(made.note(note("stand", 6.0, duration=-1.0)))


def test_a_lost_message_is_taken_by_nobody() -> None:
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert made.note(message(1.0, "lost")) is None
    assert "that was lost" in str(step(made, 2.0, SUPERVISOR, 1, 0))
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert made.note(message(1.0, "lost")) is None
    assert step(made, 2.0, ROBOT, 1, 2) is None
    assert step(made, 3.0, SUPERVISOR, 2, 1) is None


def test_a_late_message_is_not_taken_before_it_came() -> None:
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert made.note(message(1.0, "late", seconds=5.0)) is None
    assert "came at 6 s" in str(step(made, 2.0, SUPERVISOR, 1, 0))
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert made.note(message(1.0, "late", seconds=5.0)) is None
    assert step(made, 6.0, SUPERVISOR, 1, 0) is None


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (message(1.0, "eaten"), "not `eaten`"),
        (message(1.0, "late"), "how many seconds"),
        (message(1.0, "lost", seconds=1.0), "how many seconds"),
        (message(1.0, "lost", channel="other"), "writes no channel `other`"),
    ],
)
def test_a_message_has_a_channel_and_a_fate(line: dict[str, Any], why: str) -> None:
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert why in str(made.note(line))


def test_only_what_has_just_been_sent_has_a_fate() -> None:
    made = followed()
    assert "has sent no message on `done`" in str(made.note(message(1.0, "lost")))
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert made.note(message(1.0, "lost")) is None
    assert "has sent no message on `done`" in str(made.note(message(1.0, "lost")))
    made = followed()
    assert step(made, 1.0, ROBOT, 0, 1) is None
    assert step(made, 1.0, SUPERVISOR, 1, 0) is None
    assert "has sent no message on `done`" in str(made.note(message(1.0, "lost")))
