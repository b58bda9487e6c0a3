"""Arms with parallel axes 2, 3 and 4: published dimensions, all branches, moves; arms without a closed form."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import parallel
from pn2code.robot.commands import MoveJoint, MoveLinear, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.kinematics import BRANCHES, Kinematics
from pn2code.robot.model import MODELS, find_arm, find_tool
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of

pytest.importorskip("eaik")

# Denavit-Hartenberg lengths in m, from the maker's data sheets: d1, a2, a3, d4, d5, d6; and the reach.
PUBLISHED = {
    "ur10e": ((0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655), 1.3),
    "ur5e": ((0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996), 0.85),
}
HERE = Origin("cell.toml")


def nowhere(*_path: object) -> Origin:
    return HERE


def kinematics(name: str, tool: str = "") -> Kinematics:
    d = Diagnostics()
    arm = find_arm(name, Path(), HERE, d)
    held = find_tool(tool, Path(), HERE, d) if tool else None
    assert arm is not None, list(d)
    found = Kinematics.of(arm, held, HERE, d)
    assert found is not None, list(d)
    return found


def positions(count: int) -> Any:
    return np.random.default_rng(5).uniform(-3.1, 3.1, (count, 6))


def denavit_hartenberg(name: str, q: Any) -> Any:
    """The frame of the flange as the maker defines it; its base looks the other way."""
    d1, a2, a3, d4, d5, d6 = PUBLISHED[name][0]
    half = math.pi / 2
    rows = [(0, d1, half), (a2, 0, 0), (a3, 0, 0), (0, d4, half), (0, d5, -half), (0, d6, 0)]
    out = np.eye(4)
    for theta, (a, d, alpha) in zip(q + np.array([math.pi, 0, 0, 0, 0, 0]), rows, strict=True):
        ct, st, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
        out = out @ np.array(
            [
                [ct, -st * ca, st * sa, a * ct],
                [st, ct * ca, -ct * sa, a * st],
                [0, sa, ca, d],
                [0, 0, 0, 1],
            ]
        )
    return out


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_arm_is_that_of_the_data_sheet(name: str) -> None:
    k = kinematics(name)
    for q in positions(50):
        published, ours = denavit_hartenberg(name, q), k.forward(q)
        assert np.allclose(ours[:3, 3], published[:3, 3], atol=1e-9)
        assert np.allclose(ours[:3, 2], published[:3, 2], atol=1e-9)
    lengths, reach = PUBLISHED[name]
    # The makers give the reach to the middle of the wrist, in round numbers.
    assert abs(lengths[1] + lengths[2]) + lengths[4] == pytest.approx(reach, rel=0.08)


@pytest.mark.parametrize("name", PUBLISHED)
def test_each_position_is_found_again_on_its_branch(name: str) -> None:
    k = kinematics(name, "vacuum_gripper")
    q = positions(300)
    poses = k.forward_many(q)
    rows = k.all_branches(poses)
    there = ~np.isnan(rows[:, :, 0])
    assert np.abs(k.forward_many(rows[there]) - np.repeat(poses, there.sum(1), axis=0)).max() < 1e-8
    own = np.array([rows[i, k.branch_of(x).index] for i, x in enumerate(q)])
    assert np.abs((own - q + math.pi) % (2 * math.pi) - math.pi).max() < 1e-7
    assert (there.sum(1) == len(BRANCHES)).mean() > 0.5  # the others are on the edge of the reach


@pytest.mark.parametrize("name", PUBLISHED)
def test_branches_differ_as_their_names_say(name: str) -> None:
    k = kinematics(name)
    q = np.array([0.3, -1.2, 1.6, -1.9, -1.4, 0.2])
    found = {str(s.branch): s.q for s in k.inverse(k.forward(q))}
    assert len(found) == 8
    elbows = {b: k.joint_frames(x)[2][2, 3] for b, x in found.items()}
    for side in ("front", "back"):
        for wrist in ("plus", "minus"):
            assert elbows[f"{side}/up/{wrist}"] > elbows[f"{side}/down/{wrist}"]
    assert {math.sin(x[4]) > 0 for b, x in found.items() if b.endswith("plus")} == {
        math.sin(found["front/up/plus"][4]) > 0
    }


def executor(name: str = "ur10e") -> RobotExecutor:
    d = Diagnostics()
    robot = {
        "model": name,
        "tool": "vacuum_gripper",
        "base": {"z": 0.5},
        "home": [0, -90, 100, -100, -90, 0],
    }
    cell = load({"robots": {"r": robot}}, Path(), nowhere, d)
    assert cell is not None, list(d)
    return RobotExecutor(cell.robot("r"), cell.motion)


def test_lines_are_straight() -> None:
    arm = executor()
    first, second = Pose(0.6, 0.3, 0.7, math.pi, 0.0, 0.2), Pose(0.6, -0.3, 0.6, math.pi, 0.1, -0.4)
    arm.begin(MoveJoint(first), 0.0)
    arm.finish()
    motion = arm.begin(MoveLinear(second), 0.0)
    k = arm.robot.kinematics
    times = np.linspace(0.0, motion.duration, 200)
    path = k.forward_many(motion.sample(times))
    base = arm.robot.T_world_base
    world = np.array([(base @ t)[:3, 3] for t in path])
    a, b = matrix_of(first)[:3, 3], matrix_of(second)[:3, 3]
    way = (b - a) / np.linalg.norm(b - a)
    off = (world - a) - ((world - a) @ way)[:, None] * way
    assert np.abs(off).max() < 1e-9
    assert np.abs(np.diff(motion.sample(times), axis=0)).max() < 0.1  # on one branch
    arm.finish()
    assert np.abs(matrix_of(arm.pose) - matrix_of(second)).max() < 1e-9


def test_what_cannot_be_reached() -> None:
    with pytest.raises(MotionFault, match="out of reach"):
        executor("ur5e").begin(MoveJoint(Pose(1.2, 0.0, 0.7, math.pi, 0.0, 0.0)), 0.0)


def test_without_the_solver_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    real = importlib.util.find_spec
    monkeypatch.setattr(
        parallel.importlib.util, "find_spec", lambda n, *a: None if n == "eaik" else real(n, *a)
    )
    d = Diagnostics()
    arm = find_arm("ur10e", Path(), HERE, d)
    assert arm is not None and Kinematics.of(arm, None, HERE, d) is None
    assert "pip install 'pn2code[arms]'" in d.errors[0].message


def test_an_arm_that_no_solver_knows(tmp_path: Path) -> None:
    text = (
        (MODELS / "ur10e.urdf")
        .read_text()
        .replace('<axis xyz="0 0 -1"/>', '<axis xyz="0.6 0 -0.8"/>')
    )
    (tmp_path / "odd.urdf").write_text(text.replace("meshes/", f"{MODELS}/meshes/"))
    d = Diagnostics()
    arm = find_arm("odd.urdf", tmp_path, HERE, d)
    assert arm is not None, list(d)
    assert Kinematics.of(arm, None, HERE, d) is None
    assert d.errors[0].code == "unsupported-robot-kinematics"
    assert "axes 5 and 6 do not meet" in str(d.errors[0].notes[0])
