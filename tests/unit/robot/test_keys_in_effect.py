"""What keys of `[motion]`, `[scene]` and `[tools]` do to moves, shapes and contacts of a cell."""

from __future__ import annotations

import copy
import math
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.robot_cells import EXAMPLE, geometry, nowhere, pose_mm
from helpers.tool_cell import TOML, placed
from pn2code.diagnostics import Diagnostics
from pn2code.robot.active_motion import Motion
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Command, Handling, Measure, MoveAxes, MoveLinear, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.geometry import panel_bodies
from pn2code.robot.monitor import Monitor
from pn2code.robot.part import PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import PanelConfig, RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of

ARMS: dict[str, Any] = tomllib.loads("""
[robots.arm]
model = "gp25"
base = { z = 0.3 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]

[robots.gantry]
model = "gantry_3000"
base = { y = 6.0 }
home = [1.0, 0.0, 0.2, 0.0]

[scene]
floor = false
""")
MOTION = {
    "joint_speed": 0.4,
    "joint_acceleration_deg_s2": 60.0,
    "joint_jerk_deg_s3": 200.0,
    "slide_acceleration": 0.5,
    "slide_jerk": 2.0,
    "linear_speed": 0.02,
    "linear_acceleration": 0.05,
    "linear_jerk": 0.2,
    "angular_speed_deg_s": 5.0,
    "measure_s": 2.5,
}
"""Each slower than by default."""
SLOWER = {
    "joint_speed": {"turns", "slides"},
    "joint_acceleration_deg_s2": {"turns"},
    "joint_jerk_deg_s3": {"turns"},
    "slide_acceleration": {"slides"},
    "slide_jerk": {"slides"},
    "linear_speed": {"line"},
    "linear_acceleration": {"line", "turning line"},
    "linear_jerk": {"line", "turning line"},
    "angular_speed_deg_s": {"turning line"},
    "measure_s": {"measures"},
}
"""What takes longer then, and nothing else does."""


def loaded(data: dict[str, Any], folder: Path = EXAMPLE) -> RobotCell:
    d = Diagnostics()
    found = load(data, folder, nowhere, d)
    assert found is not None, [e.message for e in d.errors]
    return found


def moved(cell: RobotCell, robot: str, command: Command) -> Motion:
    return RobotExecutor(cell.robot(robot), cell.motion).begin(command, 0.0)


def took(**motion: float) -> dict[str, float]:
    cell = loaded({**copy.deepcopy(ARMS), "motion": motion})
    start = RobotExecutor(cell.robot("arm"), cell.motion).pose
    there = pose_mm(1000 * start.x - 100, 1000 * start.y, 1000 * start.z)
    line = MoveLinear(pose_mm(0, 0, 100), frame="tool")
    turning = MoveLinear(pose_mm(0, 0, 1, 0, 0, 40), frame="tool")
    turns = MoveAxes(tuple(math.radians(x) for x in (60.0, 0.0, 0.0, 0.0, -90.0, 0.0)))
    slides = MoveAxes(tuple(math.radians(x) for x in (2000.0, 0.0, 200.0, 0.0)))
    return {
        "turns": moved(cell, "arm", turns).duration,
        "slides": moved(cell, "gantry", slides).duration,
        "line": moved(cell, "arm", line).duration,
        "turning line": moved(cell, "arm", turning).duration,
        "measures": moved(cell, "arm", Measure(there)).duration,
    }


@pytest.mark.parametrize("key", MOTION)
def test_motion(key: str) -> None:
    usual, slow = took(), took(**{key: MOTION[key]})
    assert {what for what in usual if slow[what] > usual[what] + 1e-6} == SLOWER[key]
    assert all(slow[x] == usual[x] for x in usual if x not in SLOWER[key])


def test_sample_s_is_how_far_checks_are_apart() -> None:
    turns = MoveAxes(tuple(math.radians(x) for x in (60.0, 0.0, 0.0, 0.0, -90.0, 0.0)))
    for seconds in (0.02, 0.005):
        cell = loaded({**copy.deepcopy(ARMS), "motion": {"sample_s": seconds}})
        assert moved(cell, "arm", turns).step == seconds


PANEL = {
    "radius": 2.2,
    "axis_y": 5.1,
    "axis_z": 1.3,
    "x_from": 5.2,
    "x_to": 7.4,
    "arc_from": -20.0,
    "arc_to": 20.0,
    "facing": 12.0,
    "skin": 0.01,
    "ribs": [5.6],
    "rib_height": 0.03,
    "rib_thickness": 0.02,
    "stringer_pitch": 3.0,
    "stringer_height": 0.05,
    "stands": False,
}


def panel_of(**keys: Any) -> PanelConfig:
    data = copy.deepcopy(geometry())
    data["scene"]["panel"].update(keys)
    panel = loaded(data).scene.panel
    assert panel is not None
    return panel


def solids(panel: PanelConfig) -> list[tuple[Any, ...]]:
    return [(b.name, s.kind, s.pose, s.size) for b in panel_bodies(panel) for s in b.solids]


@pytest.mark.parametrize("key", PANEL)
def test_panel(key: str) -> None:
    """Each key changes what arms are measured against."""
    assert solids(panel_of(**{key: PANEL[key]})) != solids(panel_of())


def test_a_joint_of_the_panel_is_only_drawn() -> None:
    data = copy.deepcopy(geometry())
    was = data["scene"]["panel"].get("joint", False)
    other = panel_of(joint=not was)
    assert solids(other) == solids(panel_of())
    drawn = [pickle.dumps([b.draw() for b in panel_bodies(p)]) for p in (other, panel_of())]
    assert drawn[0] != drawn[1]


def test_tool_contact_depth_lets_tools_touch_the_skin() -> None:
    """And each other; without it, nothing may."""
    data = copy.deepcopy(geometry())
    data["scene"]["tool_contact_depth"] = 0.007
    skin = [c for c in loaded(data).scene.contacts if c.b == "panel/skin"]
    assert {(c.a, c.depth) for c in skin} == {
        ("robot1/tool_tip", 0.007),
        ("robot2/tool_tip", 0.007),
    }
    data["scene"]["tool_contact_depth"] = 0.0
    assert not [c for c in loaded(data).scene.contacts if c.b == "panel/skin"]


@pytest.mark.bullet
@pytest.mark.parametrize(("near", "is_told"), [(0.02, False), (0.2, True)])
def test_warning_clearance_is_from_where_on_it_is_told(near: float, is_told: bool) -> None:
    data = copy.deepcopy(ARMS)
    data["scene"] = {"floor": False, "warning_clearance": near}
    data["scene"]["objects"] = [
        {"name": "box", "size": [0.1, 0.1, 0.1], "pose": {"x": -0.45, "z": 0.5}}
    ]
    cell = loaded(data)
    backend = BulletBackend(cell, looks=False)
    joints = {r.name: np.array(r.home) for r in cell.moving}
    try:
        verdict = Monitor(cell, backend).check(0.0, joints)
    finally:
        backend.close()
    assert verdict.fault is None
    assert bool(verdict.warnings) == is_told, verdict.clearances


@pytest.mark.parametrize(("degrees", "is_right"), [("2.0", False), ("4.0", True)])
def test_angle_deg_is_how_far_a_coupling_may_be_turned(
    tmp_path: Path, degrees: str, is_right: bool
) -> None:
    toml = TOML.replace('rack = "rackLeft"', f'rack = "rackLeft"\nangle_deg = {degrees}')
    cell, d = placed(tmp_path, toml)
    assert cell is not None, [e.message for e in d.errors]
    turned = matrix_of(Pose(0.3, -0.9, 0.75, math.pi, 0.0, math.radians(3.0)))
    lock = Handling("couples", "gripper")
    if is_right:
        assert Parts(cell).handle("arm", lock, turned).effect == "couples"
    else:
        with pytest.raises(PartFault, match=r"and 3.0 deg away \(at most 2 mm, 2 deg\)"):
            Parts(cell).handle("arm", lock, turned)
