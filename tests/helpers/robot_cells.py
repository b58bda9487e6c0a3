"""Robot cells for tests: two arms of the library, and the riveting cell of the examples with its path."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from pn2code.diagnostics import NOWHERE, Diagnostics, Origin
from pn2code.robot.commands import Command, MoveHome, MoveJoint, MoveLinear, Pose
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import find_arm, find_tool
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "riveting"


def nowhere(*path: str | int) -> Origin:
    return Origin("cell.toml", part=".".join(map(str, path)))


@cache
def arm_kinematics(model: str = "kr210_r2700", tool: str | None = "drill_riveter") -> Kinematics:
    d = Diagnostics()
    arm = find_arm(model, EXAMPLE, NOWHERE, d)
    found = find_tool(tool, EXAMPLE, NOWHERE, d) if tool else None
    assert arm is not None, list(d)
    kinematics = Kinematics.of(arm, found, NOWHERE, d)
    assert kinematics is not None, list(d)
    return kinematics


def geometry(layout: str = "good") -> dict[str, Any]:
    """The raw sections of the example's cell.toml with a layout applied."""
    from pn2code.cell.load import load

    d = Diagnostics()
    found = load(EXAMPLE / "cell.toml", d, layout=layout)
    assert found is not None, list(d)
    return found.geometry


@cache
def riveting_cell(layout: str) -> RobotCell:
    d = Diagnostics()
    cell = load(geometry(layout), EXAMPLE, nowhere, d)
    assert cell is not None, list(d)
    return cell


def pose_mm(
    x: float, y: float, z: float, rx: float = 0.0, ry: float = 0.0, rz: float = 0.0
) -> Pose:
    """Of mm and degrees."""
    a, b, c = (math.radians(v) for v in (rx, ry, rz))
    return Pose(x / 1000.0, y / 1000.0, z / 1000.0, a, b, c)


RIVETS = 7


def riveting_path(robot: int) -> Iterator[tuple[str, Command]]:
    """The 22 rows of Table 2 by their recipe, then HOME: (phase, command); robot 1 or 2.

    The numbers are the reference's, without the rounding to float32 (which has tests elsewhere).
    """
    angle = math.radians(-105.0)
    # 100 mm back from the reference along the tool's z; robot 2 faces robot 1.
    side = -100.0 if robot == 1 else 100.0
    y, z = 5898.8 - side * math.sin(angle), 2135.05 + side * math.cos(angle)
    yield "approach", MoveJoint(pose_mm(5750.0, y, z, -105.0 if robot == 1 else 75.0))
    pitch = 1000.0 / (RIVETS - 1)
    for i in range(RIVETS):
        yield "in", MoveLinear(pose_mm(0.0, 0.0, 100.0), "tool")
        yield "out", MoveLinear(pose_mm(0.0, 0.0, -100.0), "tool")
        if i + 1 < RIVETS:
            yield "pitch", MoveLinear(pose_mm(pitch, 0.0, 0.0), "tool")
    yield "back", MoveLinear(pose_mm(-5.0 * pitch, 0.0, 0.0), "tool")
    yield "home", MoveHome()
