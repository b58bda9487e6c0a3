"""Moves of all kinds in scripts: read, printed, and what they tell the arm."""

from __future__ import annotations

import math

import pytest

from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.robot.approach import pose_before
from pn2code.robot.commands import MoveAxes, MoveCircular, MoveHome, MoveJoint, MoveLinear, Pose
from pn2code.robot.transforms import matrix_of
from pn2code.tdl import pretty
from pn2code.tdl import tree as t
from pn2code.tdl.check import check
from pn2code.tdl.interpret import Interpreter
from pn2code.tdl.parse import parse
from pn2code.tdl.requests import Execute, Fault

P = Pose(0.1, 0.0, 0.3, math.pi, 0.0, 0.0)
HALF = "pose(100 mm, 0 mm, 300 mm, 180 deg, 0 deg, 0 deg)"


def program(move: str) -> t.Program:
    text = f"program t\nvar e : real := 0.5\nvar p : pose := {HALF}\nbegin\n  {move}\n  stop e, p\nend program\n"
    d = Diagnostics()
    found = parse(SourceText(text, Origin("t.tdl", 1, 1)), d)
    assert found is not None, [e.message for e in d.errors]
    return found


def told(move: str, frames: tuple[str, ...] = ("bench", "via")) -> object:
    d = Diagnostics()
    checked = check(program(move), d, frames)
    assert checked is not None, [e.message for e in d.errors]
    request = Interpreter(checked, None).resume()  # type: ignore[arg-type]
    return request.command if isinstance(request, Execute) else request


@pytest.mark.parametrize(
    ("move", "command"),
    [
        (
            "move $joint axes(0 deg, -90 deg, 90 deg, 0 deg, 45 deg, 180 deg) at 30 %",
            MoveAxes((0.0, -math.pi / 2, math.pi / 2, 0.0, math.pi / 4, math.pi), 0.3),
        ),
        ("move $joint p in bench acceleration 40 %", MoveJoint(P, 1.0, "bench", 0.4)),
        ("move $joint home at 30 % acceleration e", MoveHome(0.3, 0.5)),
        (
            "move $linear p in bench at 50 mm/s acceleration 25 %",
            MoveLinear(P, "bench", 0.05, 0.25),
        ),
        ('move $linear p in "via"', MoveLinear(P, "via")),
        (
            "move $linear p via p, p in bench with $blend = 20 mm at 50 mm/s acceleration 25 %",
            MoveLinear(P, "bench", 0.05, 0.25, via=(P, P), blend=0.02),
        ),
        (
            "move $linear p via p with $tool gripper, $arm angle = 90 deg, $blend = e * 1 mm",
            MoveLinear(P, tcp="gripper", arm_angle=math.pi / 2, via=(P,), blend=0.0005),
        ),
        (
            "move $circular p via before(p, 100 mm) in bench at 50 mm/s",
            MoveCircular(Pose(0.1, 0.0, 0.4, math.pi, 0.0, 0.0), P, "bench", 0.05),
        ),
    ],
)
def test_moves_are_told_as_they_are_written_and_printed_as_they_were(
    move: str, command: object
) -> None:
    found = told(move)
    if isinstance(found, MoveCircular):
        assert isinstance(command, MoveCircular)
        assert matrix_of(found.via) == pytest.approx(matrix_of(command.via), abs=1e-12)
        assert (found.target, found.frame, found.speed) == (P, "bench", 0.05)
    else:
        assert found == command
    (statement, *_) = program(move).body
    assert isinstance(statement, t.Move)
    assert pretty.simple(statement) == move


def test_the_speed_of_lines_is_that_of_arcs() -> None:
    d = Diagnostics()
    found = check(program("speed $linear 70 mm/s move $circular p via p"), d)
    assert found is not None
    request = Interpreter(found, None).resume()  # type: ignore[arg-type]
    assert isinstance(request, Execute)
    assert request.command == MoveCircular(P, P, "world", 0.07)


def test_an_acceleration_that_is_computed_is_a_fraction() -> None:
    found = told("e := e * 4.0 move $joint p acceleration e")
    assert isinstance(found, Fault)
    assert found.message == "acceleration 200 % is not above zero and at most 100 %"


def test_a_zone_that_is_computed_is_above_zero() -> None:
    found = told("e := e - 0.5 move $linear p via p with $blend = e * 1 mm")
    assert isinstance(found, Fault)
    assert found.message == "a zone of 0 mm for corners is not above zero"


def test_frames_are_those_of_the_cell() -> None:
    d = Diagnostics()
    assert check(program("move $joint p in bensh"), d, ("bench",)) is None
    assert [e.message for e in d.errors] == ["there is no frame `bensh`"]
    assert d.errors[0].hint == "did you mean `bench`?"


def test_the_pose_before_is_against_the_z_of_the_tool() -> None:
    pose = (100.0, 200.0, 300.0, 20.0, -30.0, 70.0)
    before = pose_before(pose, 40.0)
    at = matrix_of(Pose(0.1, 0.2, 0.3, *map(math.radians, pose[3:])))
    assert before[3:] == pose[3:]
    assert [v / 1000.0 for v in before[:3]] == pytest.approx(
        at[:3, 3] - 0.04 * at[:3, 2], abs=1e-12
    )
    assert all(map(math.isnan, pose_before((1.0, 2.0, 3.0, math.inf, 0.0, 0.0), 1.0)[:3]))
