"""A person's hand in a run: questions with a default and an end, values, holding, fates of messages."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from helpers.scripts import MemoryFiles, checked
from pn2code.cell.config import SensorConfig
from pn2code.cell.partition import ChannelKind
from pn2code.cell.scalars import Scalar, ScalarKind
from pn2code.channels import ChannelSpec, SharedDirectory
from pn2code.diagnostics import NOWHERE
from pn2code.robot.active_motion import Motion
from pn2code.robot.commands import Pose, Wait
from pn2code.robot.trajectories import Still
from pn2code.run.choices import Choice, permitted
from pn2code.run.hand import Hand, Said
from pn2code.run.late_files import Fate, LateFiles
from pn2code.run.realtime import RealtimeEngine
from pn2code.run.runner import CellStoppedError, RobotRunner
from pn2code.run.stops import Paused, paused, resumed
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.requests import FileError, Sense
from pn2code.tdl.types import Type

RESULT = Scalar(ScalarKind.INT, "RESULT", "RESULT", (), 1, 3)
TEXT = Scalar(ScalarKind.STRING, "TEXT", "TEXT")
KEY = ("robot1", "drill")


class Person:
    """Wishes, and a body that keeps what is done to it."""

    def __init__(self) -> None:
        self.here = 1
        self.wishes: list[dict[str, Any]] = []
        self.done: list[tuple[Any, ...]] = []
        self.now = 0.0

    def present(self) -> int:
        return self.here

    def taken(self) -> list[dict[str, Any]]:
        wishes, self.wishes = self.wishes, []
        return wishes

    def stand(self, party: str) -> None:
        self.done.append(("stand", party))

    def go_on(self, party: str, seconds: float) -> None:
        self.done.append(("go on", party, seconds))

    def stood(self, party: str, seconds: float) -> None:
        self.done.append(("stood", party, seconds))

    def fail(self, party: str) -> None:
        self.done.append(("fail", party))

    def promise(self, party: str, channel: str, fate: Fate | None) -> None:
        self.done.append(("promise", party, channel, fate))


def all_of(values: Iterable[Any]) -> Sequence[Any]:
    return tuple(values)


def small(values: Iterable[Any]) -> Sequence[Any]:
    return tuple(v for v in values if v < 3)


class Held:
    """A hand and its person."""

    def __init__(self) -> None:
        self.person = Person()
        choices = {
            KEY: Choice(*KEY, "drilled", RESULT),
            ("belt", "label"): Choice("belt", "label", "s", TEXT),
        }
        channels = {"robot1": ("flag",), "belt": ()}
        self.hand = Hand(choices, channels, self.person, 15.0, lambda: self.person.now)

    def wish(self, do: str, **more: Any) -> dict[str, Any]:
        """Wishes something; what pages are told then."""
        self.person.wishes.append({"do": do, **more})
        self.hand.look(self.person)
        return self.hand.told()

    def ask(self) -> Said | None:
        return self.hand.asked(*KEY, 1, small, 57)


@pytest.fixture
def held() -> Held:
    return Held()


def test_a_person_is_asked_with_the_permitted_values_and_chooses(held: Held) -> None:
    assert held.ask() is None and held.hand.answer("robot1") is None
    (question,) = held.hand.told()["questions"]
    assert question == {
        "number": 1, "party": "robot1", "sensor": "drill", "variable": "drilled", "line": 57,
        "says": "", "allowed": "a value of RESULT from 1 to 3",
        "values": ["1", "2"], "own": "1", "left": 15.0,
    }  # fmt: skip
    for value, why in (("3", "could not go on"), ("4", "outside"), ("x", "not an integer")):
        assert why in held.wish("answer", number=1, value=value)["refused"][1]
    assert "not open" in held.wish("answer", number=2, value="1")["refused"][1]
    held.person.now = 3.0
    assert held.wish("answer", number=1, value="2")["questions"] == []
    said = held.hand.answer("robot1")
    assert said is not None and (said.value, said.by) == (2, "person")
    assert (
        said.why
        == "sensor drill: 2, chosen by a person after 3.0 s; by itself it would have said 1"
    )


def test_nobody_is_waited_for_beyond_what_was_said(held: Held) -> None:
    assert held.ask() is None
    held.person.now = 14.9
    assert held.hand.answer("robot1") is None
    held.person.now = 15.0
    said = held.hand.answer("robot1")
    assert said is not None and (said.value, said.by) == (1, "")
    assert "nobody answered within 15 s" in said.why
    assert "not open" in held.wish("answer", number=1, value="2")["refused"][1]


def test_what_is_seen_is_looked_at_again_when_nobody_answered(held: Held) -> None:
    """Meanwhile a part may have come, or gone."""
    assert held.ask() is None
    held.person.now = 15.0
    told: list[Said] = []
    engine = SimpleNamespace(
        hand=held.hand,
        sensors=SimpleNamespace(seen={"drill": ("infeed", "box")}),
        _sensor_says=lambda _robot, _request: 2,
        _told=lambda _robot, _request, said: told.append(said),
        _heed_request=lambda _robot, _request: None,
    )
    robot = SimpleNamespace(name="robot1", asking=SimpleNamespace(sensor="drill"))
    assert RealtimeEngine._robot_turn(engine, robot)  # type: ignore[arg-type]
    assert told == [Said(2, "", "sensor drill: 2 is seen now, as nobody answered within 15 s")]


def test_nobody_is_waited_for_who_is_not_there(held: Held) -> None:
    held.person.here = 0
    assert held.ask() == Said(1)
    held.person.here = 1
    assert held.ask() is None
    held.person.here = 0
    said = held.hand.answer("robot1")
    assert said is not None and (said.value, said.by) == (1, "") and "nobody was there" in said.why


def test_what_is_chosen_beforehand_is_said_without_asking(held: Held) -> None:
    held.wish("next", party="robot1", sensor="drill", value="2")
    held.wish("way", party="robot1", sensor="drill", way="own")
    assert (held.ask(), held.ask()) == (Said(2, "person"), Said(1))
    held.wish("way", party="robot1", sensor="drill", way="always", value="2")
    held.person.here = 0  # it holds when the page is closed
    assert (held.ask(), held.ask()) == (Said(2, "person"), Said(2, "person"))
    held.wish("way", party="robot1", sensor="drill", way="always", value="3")
    assert held.ask() == Said(1)  # its program could not go on with 3
    assert "drill cannot say 3 to robot1 here" in held.hand.told()["refused"][1]


def test_where_there_is_no_choice_nobody_is_asked(held: Held) -> None:
    assert held.hand.asked(*KEY, 1, lambda values: [1]) == Said(1)
    assert held.hand.asked("robot1", "unknown", 7, all_of) == Said(7)


def test_values_that_cannot_be_listed_are_typed(held: Held) -> None:
    assert held.hand.asked("belt", "label", "", all_of) is None
    (question,) = held.hand.told()["questions"]
    assert (question["values"], question["own"]) == ([], '""')
    assert "not a string" in held.wish("answer", number=1, value="x")["refused"][1]
    held.wish("answer", number=1, value='"<b>"')
    said = held.hand.answer("belt")
    assert said is not None and said.value == "<b>"


def test_a_robot_is_held_and_goes_on(held: Held) -> None:
    held.wish("hold", party="robot1")
    held.wish("hold", party="robot1")
    assert held.hand.holds("robot1") and not held.hand.holds("belt")
    assert held.hand.told()["held"] == {"robot1": None}
    held.person.now = 4.0
    held.wish("go", party="robot1")
    held.wish("hold", party="belt", seconds=2)
    held.person.now = 6.5
    held.hand.look(held.person)
    held.wish("hold", party="robot1")
    held.person.here = 0  # the page was closed: nothing stands for ever
    held.hand.look(held.person)
    assert held.person.done == [
        ("stand", "robot1"), ("go on", "robot1", 4.0), ("stand", "belt"), ("go on", "belt", 2.5),
        ("stand", "robot1"), ("go on", "robot1", 0.0),
    ]  # fmt: skip


def test_a_hold_that_outlasts_the_run_is_told(held: Held) -> None:
    held.person.now = 1.0
    held.wish("hold", party="belt")
    held.person.now = 4.0
    held.hand.ended(held.person)
    held.hand.ended(held.person)
    assert held.person.done == [("stand", "belt"), ("stood", "belt", 3.0)]


def test_messages_and_failures_are_passed_on(held: Held) -> None:
    told = held.wish("delay", party="robot1", channel="flag", seconds=5)
    assert told["fates"] == [{"party": "robot1", "channel": "flag", "late": 5.0}]
    held.wish("lose", party="robot1", channel="flag")
    held.hand.fulfilled("robot1", "flag")
    assert held.hand.told()["fates"] == []
    held.wish("let", party="robot1", channel="flag")
    held.wish("fail", party="belt")
    fates = [Fate(5.0), Fate(None), None]
    assert held.person.done == [
        *(("promise", "robot1", "flag", f) for f in fates),
        ("fail", "belt"),
    ]


@pytest.mark.parametrize(
    "wish",
    [
        {"do": "answer", "number": []}, {"do": "hold", "party": "nobody"}, {"do": "hold", "party": ["belt"]},
        {"do": "fail"}, {"do": "lose", "party": "belt", "channel": "flag"}, {"do": {}}, {},
        {"do": "hold", "party": "belt", "seconds": "5"}, {"do": "hold", "party": "belt", "seconds": math.nan},
        {"do": "delay", "party": "robot1", "channel": "flag"}, {"do": "way", "party": "belt", "sensor": "drill"},
        {"do": "way", "party": "robot1", "sensor": "drill", "way": "never"},
        {"do": "next", "party": "robot1", "sensor": "drill", "value": {}},
    ],
)  # fmt: skip
def test_odd_wishes_are_refused(held: Held, wish: dict[str, Any]) -> None:
    held.person.wishes.append(wish)
    held.hand.look(held.person)
    assert held.hand.told()["refused"][0] == 1 and held.person.done == []


SCRIPT = """
program belt
input go "go.robcad" : signal
output out "out.robcad" : int
var v : int
begin
  wait until filled(go)
  sense eye into v
  clear go
  if v = 1 then
    write out v
  elsif v = 2 then
    tool reject for 1 s
  else
    stop "nothing can happen with", v
  end if
end program
"""


def test_values_with_which_a_program_cannot_go_on_are_not_permitted() -> None:
    files = MemoryFiles({"go": (1,)})
    heard: list[Any] = []
    running = Interpreter(checked(SCRIPT), files, heard.append)
    assert isinstance(running.resume(), Sense)
    assert permitted(running, files, (1, 2, 3)) == (1, 2)
    assert heard == [] and files.read("go") == (1,) and files.read("out") is None


def test_a_motion_stands_and_goes_on_where_it_was() -> None:
    nowhere = Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    motion = Motion("r", Wait(4.0), "wait", 10.0, Still(np.zeros(6), 4.0), nowhere, nowhere)
    standing = paused(motion, 11.0)
    assert standing.ends == math.inf and standing.q(500.0).tolist() == [0.0] * 6
    assert resumed(motion, 11.0) is motion
    again = paused(resumed(standing, 13.0), 14.0)
    done = resumed(again, 14.5)
    assert isinstance(done.trajectory, Paused)
    assert done.trajectory.pauses == ((1.0, 2.0), (2.0, 0.5))
    assert done.ends == 16.5


def test_messages_come_late_or_never(tmp_path: Path) -> None:
    spec = ChannelSpec("flag", "flag.robcad", (RESULT,), "robot1", "supervisor", ChannelKind.FLAG)
    heard: list[Any] = []
    with (
        SharedDirectory(tmp_path, "supervisor", (spec,)) as supervisor,
        SharedDirectory(tmp_path, "robot1", (spec,)) as robot,
    ):
        supervisor.announce()
        assert robot.await_supervisor(0.0)
        files = LateFiles(robot, 0.0, lambda: 10.0, lambda *what: heard.append(what))
        files.fates["flag"] = Fate(5.0)
        files.write("flag", (2,))
        assert supervisor.read("flag") is None and files.deliver(14.9) == []
        with pytest.raises(FileError, match="late"):
            files.write("flag", (1,))
        assert files.deliver(15.0) == ["flag"]
        message = supervisor.read("flag")
        assert message is not None and message.scalars == (2,)  # type: ignore[union-attr]
        files.fates["flag"] = Fate(None)
        with pytest.raises(FileError, match="still holds"):
            files.write("flag", (1,))  # it is full, as without fates
        supervisor.clear("flag")
        files.fates["flag"] = Fate(None)
        files.write("flag", (3,))
        assert files.deliver(math.inf) == [] and supervisor.read("flag") is None
        files.write("flag", (1,))
        assert supervisor.read("flag").scalars == (1,)  # type: ignore[union-attr]
    assert heard == [("flag", Fate(5.0)), ("flag", Fate(None))]


def test_a_question_has_the_words_of_the_sensor_and_what_it_may_be_told() -> None:
    person = Person()
    says = Choice(
        "robot1",
        "gauge",
        "d",
        Scalar(ScalarKind.INT, "DEPTH", "DEPTH", (), -2, 900),
        "how deep the hole is",
    )
    hand = Hand({("robot1", "gauge"): says}, {}, person, 5.0, lambda: person.now)
    assert hand.asked("robot1", "gauge", 3, all_of) is None
    (asked,) = hand.told()["questions"]
    described = hand.described()["sensors"][0]
    for told in (asked, described):
        assert told["says"] == "how deep the hole is"
        assert told["allowed"] == "a value of DEPTH from -2 to 900"
    assert asked["values"] == []


@pytest.mark.parametrize(
    ("asking", "says"),
    [
        (Sense("eye", Type.INT, 12), "r.tdl:12: robot1: its question to sensor eye fails"),
        (None, "r.tdl:7: robot1: its program fails"),
    ],
)
def test_what_is_made_to_fail(asking: Sense | None, says: str) -> None:
    """A question that is open, and not the command before it."""
    nothing: Any = None
    robot = RobotRunner("robot1", "r.tdl", nothing, nothing, nothing, line=7, asking=asking)
    noted: list[str] = []
    engine = SimpleNamespace(
        _named=lambda _party: robot, _interfered=lambda _party, text: noted.append(text)
    )
    with pytest.raises(CellStoppedError, match=re.escape(says)):
        RealtimeEngine.fail(engine, "robot1")  # type: ignore[arg-type]
    assert noted == [says.split(": ")[2].replace(" fails", " was made to fail")]


@pytest.mark.parametrize(
    ("sensor", "tells"),
    [
        ({}, ""),
        ({"sees": "infeed"}, "whether something is at infeed"),
        ({"sees": "infeed", "part": "box"}, "whether a box is at infeed"),
        ({"sees": "mill.door", "at": 0.9}, "whether mill.door is at 0.9"),
        ({"sees": "infeed", "says": "what the eye finds"}, "what the eye finds"),
    ],
)
def test_a_sensor_that_sees_says_what(sensor: dict[str, Any], tells: str) -> None:
    config = SensorConfig("eye", "there", "", None, 1, NOWHERE, **sensor)
    assert config.tells == tells
