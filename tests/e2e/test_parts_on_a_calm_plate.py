"""What stands on a turntable is taken by another arm while the owner of the table moves: the plate must stand then."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.meeting_cell import NET, TOML, meeting_cell
from helpers.thorough import amount
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

AWAY = "{x = 200.0, y = 1500.0, z = 1200.0, rx = 180.0, ry = 0.0, rz = 0.0}"


def touches(does: str) -> str:
    """Robot 2 goes down to a box on the plate of robot 1, does something there, and goes away."""
    return (
        f"(moveJoint (at (1000.0, 180.0)); moveLinear (at (650.0, 180.0)); {does}; "
        "moveLinear (at (1000.0, 180.0)); moveHome ())"
    )


def cell(folder: Path, first: str, second: str) -> Path:
    """Robot 1 and robot 2 do something at the same time."""
    net = NET.replace("1`2", "1`1").replace(
        "  fun work () = ();\n",
        "  fun work () = ();\n  fun grip () = ();\n  fun drop () = ();\n  fun turn (a : real) = ();\n"
        "  fun seam (p : POSE, a : real) = ();\n",
    )
    net = net.replace("(visit 0.0)", f"({first})").replace("(visit 180.0)", second)
    toml = TOML.replace(
        "[robots.robot1]\n",
        'grip = { command = "tool", action = "grip", duration_s = 0.5, takes = "box" }\n'
        'drop = { command = "tool", action = "drop", duration_s = 0.5, releases = "box" }\n'
        'turn = { command = "move_external", turntable = "plate" }\n'
        'seam = { command = "move_linear", frame = "world", turntable = "plate" }\n[robots.robot1]\n',
        1,
    ).replace(
        'tool = "counterpoint"\nbase = { x = 3.0', 'tool = "vacuum_gripper"\nbase = { x = 3.0'
    )
    toml += """
[robots.robot1.axes.plate]
kind = "turntable"
pose = { x = 1.5, y = 0.0, z = 0.5 }
from = -200.0
to = 200.0
radius = 0.3
[parts.box]
kind = "box"
size = [0.2, 0.2, 0.15]
at = [{ x = 1.5, z = 0.575 }]
grips = [{ z = 0.075, roll = 180.0 }, { z = 0.075, roll = 180.0, yaw = 180.0 }]
"""
    return meeting_cell(folder, guarded=False, net=net, toml=toml)


def seam(degrees: float) -> str:
    """A line while the plate turns."""
    return (
        f"seam ({{x = 200.0, y = 1400.0, z = 1200.0, rx = 180.0, ry = 0.0, rz = 0.0}}, {degrees})"
    )


@pytest.mark.parametrize(
    ("first", "answers"),
    [
        (f"moveJoint ({AWAY}); moveHome ()", {"yes"}),
        ("turn 90.0; turn 0.0", {"no", "unknown"}),
        (f"moveJoint ({AWAY}); {seam(40.0)}; moveHome ()", {"no"}),  # as below
    ][: amount(2, 3)],
)
def test_the_owner_moves_elsewhere(first: str, answers: set[str], tmp_path: Path) -> None:
    folder = cell(tmp_path / "cell", first, touches("grip ()"))
    done = CliRunner().invoke(app, ["check", "--geometry", "--json", str(folder)])
    found: dict[str, Any] = json.loads(done.stdout)["layouts"][0]
    assert found["pairs_answer"] in answers, done.output


def test_nothing_touches_what_turns_on_a_line(tmp_path: Path) -> None:
    """The tool rests on the box, which turns under it: that was permitted, as on any line."""
    folder = cell(
        tmp_path / "cell", f"moveJoint ({AWAY}); {seam(90.0)}; moveHome ()", touches("work ()")
    )
    done = CliRunner().invoke(app, ["check", "--geometry", "--json", str(folder)])
    found: dict[str, Any] = json.loads(done.stdout)["layouts"][0]
    assert found["pairs_answer"] == "no", done.output
    assert "box.1" in found["pairs"][0]["links"], done.output
    options = RunOptions(tmp_path / "run", backend="bullet", looks=False, checked=False)
    result = run_cell(folder, options, Diagnostics())
    assert result is not None and "collide" in result.record.reason
