"""What arms may carry: masses, centres, moments, and what a load leaves of speeds and accelerations."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.commands import MoveJoint, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.model import MODELS
from pn2code.robot.payload import GRAVITY, Rating
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

HERE = Origin("cell.toml")
TOOL = """<robot name="hand"><link name="palm"><inertial><origin xyz="0 0 0.1"/><mass value="3"/></inertial></link>
<link name="finger"><inertial><mass value="1"/></inertial></link><link name="tcp"/>
<joint name="a" type="fixed"><origin xyz="0 0 0.2"/><parent link="palm"/><child link="finger"/></joint>
<joint name="b" type="fixed"><origin xyz="0 0 0.3"/><parent link="palm"/><child link="tcp"/></joint></robot>
"""
TAKE = {"grip": {"command": "tool", "takes": "box"}, "lift": {"command": "tool", "takes": "drum"}}


def said(
    folder: Path, mass: float, model: str = "lrmate200id", **robot: Any
) -> tuple[Any, Diagnostics]:
    (folder / "hand.urdf").write_text(TOOL)
    data = {
        "robots": {
            "r": {"model": model, "tool": "hand.urdf", "base": {}, "home": [0, 10, -20, 0, -60, 0], **robot}
        },
        "parts": {
            "box": {"kind": "box", "size": [0.1, 0.1, 0.1], "mass": mass, "grips": [{"z": 0.05, "roll": 180.0}]},
            "drum": {"kind": "cylinder", "radius": 0.1, "length": 0.1, "mass": 0.5},
        },
        "primitives": TAKE,
    }  # fmt: skip
    d = Diagnostics()
    return load(data, folder, lambda *_: HERE, d), d


def cell(folder: Path, mass: float, **robot: Any) -> RobotCell:
    found, d = said(folder, mass, **robot)
    assert isinstance(found, RobotCell), [e.message for e in d.errors]
    return found


def test_masses_and_centres_are_those_of_tool_and_part(tmp_path: Path) -> None:
    c = cell(tmp_path, 2.0)
    alone, box, drum = c.robots[0].loads(c.parts, ("box", "drum"))
    assert (alone.mass, box.mass, drum.mass) == (4.0, 6.0, 4.5)
    assert alone.centre == pytest.approx([0, 0, (3 * 0.1 + 1 * 0.2) / 4])
    # The box hangs 50 mm beyond the TCP, the drum is gripped in its middle.
    assert box.centre == pytest.approx([0, 0, (4 * 0.125 + 2 * 0.35) / 6])
    assert drum.centre == pytest.approx([0, 0, (4 * 0.125 + 0.5 * 0.3) / 4.5])


@pytest.mark.parametrize(
    ("mass", "taken", "says"),
    [
        (0.5, ("box", "drum"), ""),
        (4.0, (), ""),
        (4.0, ("drum",), ""),
        (4.0, ("box",), "`hand.urdf` (4 kg) and a part `box` (4 kg), 8 kg, but 7 kg are rated"),
        (2.5, ("box",), "from axis 4: 18.58 Nm, but 16.6 Nm are rated"),
    ],
)
def test_what_is_too_much_is_named(
    mass: float, taken: tuple[str, ...], says: str, tmp_path: Path
) -> None:
    c = cell(tmp_path, mass)
    found = c.robots[0].overload(c.parts, taken)
    assert says in found and bool(found) == bool(says), found


def test_a_moment_is_that_of_the_worst_position() -> None:
    """By the forward kinematics: the distance of the load from the axis, wherever later axes stand."""
    c = load(
        {"robots": {"r": {"model": "lrmate200id", "base": {}, "home": [0, 0, 0, 0, -60, 0]}}},
        Path(), lambda *_: HERE, Diagnostics(),
    )  # fmt: skip
    assert c is not None
    k = c.robots[0].kinematics
    at = np.array([0.05, -0.02, 0.1])
    far = [0.0, 0.0, 0.0]
    for q5 in np.linspace(-2.1, 2.1, 41):
        for q6 in np.linspace(-math.pi, math.pi, 41):
            frames = k.link_frames(np.array([[0, 0, 0, 0, q5, q6]]))
            axes = k.axes_of(frames)[0]
            point = (frames[-1][0] @ [*at, 1.0])[:3]
            for i in range(3):
                arm = point - frames[3 + i][0, :3, 3]
                far[i] = max(far[i], float(np.linalg.norm(np.cross(axes[3 + i], arm))))
    centre = k.wrist_in_flange
    assert centre is not None
    for i, length in enumerate(far):
        moments = [1e9, 1e9, 1e9]
        hangs = replace(next(c.robots[0].loads({}, ())), mass=1.0, centre=at)
        moments[i] = GRAVITY * length * 1.02
        assert Rating(5.0, tuple(moments)).exceeded(hangs, centre) == ""
        moments[i] = GRAVITY * length * 0.98
        assert f"axis {i + 4}" in Rating(5.0, tuple(moments)).exceeded(hangs, centre)


def slower(folder: Path) -> str:
    rows = '<pn2code load="4" speed="1" acceleration="1"/><pn2code load="6" speed="0.5" acceleration="0.25"/>'
    text = (MODELS / "lrmate200id.urdf").read_text().replace("meshes/", f"{MODELS}/meshes/")
    (folder / "slow.urdf").write_text(text.replace("</robot>", rows + "</robot>"))
    return "slow.urdf"


def test_a_load_makes_the_arm_slower(tmp_path: Path) -> None:
    model = slower(tmp_path)
    plain, half, heavy = (
        cell(tmp_path, mass, model=model, carries=["box"]) for mass in (0.0, 1.0, 2.0)
    )
    assert [c.robots[0].pace for c in (plain, half, heavy)] == [(1, 1), (0.75, 0.625), (0.5, 0.25)]
    durations = []
    for c in (plain, half, heavy):
        arm = RobotExecutor(c.robots[0], c.motion)
        durations.append(arm.begin(MoveJoint(Pose(0.5, 0.1, 0.4, 3.0, 0.0, 0.0)), 0.0).duration)
    assert durations[0] < durations[1] < durations[2]
    limits = heavy.robots[0].limits(heavy.motion)
    assert limits.axis_velocity == pytest.approx(heavy.robots[0].arm.velocity * 0.5)
    # What it does not carry does not count.
    assert cell(tmp_path, 2.0, model=model, carries=["drum"]).robots[0].pace == (0.875, 0.8125)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('payload="7"', 'payload="0"'), "must be above zero"),
        (('payload="7"', 'payload="x"'), "`payload` is `x`"),
        (('moments="16.6 16.6 9.4"', 'moments="16.6"'), "3 numbers are expected"),
        (('speed="0.5"', 'speed="1.5"'), "above 0, at most 1"),
        (('load="6"', 'load="3"'), "not in rising order"),
    ],
)
def test_mistakes_in_what_an_arm_says(
    change: tuple[str, str], message: str, tmp_path: Path
) -> None:
    path = tmp_path / slower(tmp_path)
    assert change[0] in path.read_text()
    path.write_text(path.read_text().replace(*change))
    found, d = said(tmp_path, 1.0, model="slow.urdf")
    assert found is None and message in d.errors[0].message, d.errors[0].message


def test_moments_without_the_wrist_that_they_are_about(tmp_path: Path) -> None:
    """They would not be looked at, whatever the arm carries."""
    pytest.importorskip("eaik")
    text = (MODELS / "ur5e.urdf").read_text().replace("meshes/", f"{MODELS}/meshes/")
    assert 'payload="5"' in text
    text = text.replace('payload="5"', 'payload="50" moments="1 1 1"')
    (tmp_path / "arm.urdf").write_text(text)
    found, d = said(tmp_path, 1.0, model="arm.urdf")
    (error,) = d.errors
    assert found is None and error.message.startswith("`moments` are about axes 4, 5 and 6")
    assert error.origin.file == str(tmp_path / "arm.urdf")


def test_a_kind_of_parts_that_is_not_there(tmp_path: Path) -> None:
    found, d = said(tmp_path, 1.0, carries=["bix"])
    assert found is None and "carries" in d.errors[0].message and "`box`" in d.errors[0].hint
    assert d.errors[0].message.endswith("names `bix`, which is no kind of parts")
