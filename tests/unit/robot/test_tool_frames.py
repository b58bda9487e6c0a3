"""Moves that say which tool frame comes to the pose, where a flange carries several tools."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from helpers.robot_cells import pose_mm
from pn2code.geometry.legs import Planner
from pn2code.geometry.tracks import ArmShape, Track
from pn2code.robot.active_motion import Motion
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Command, MoveCircular, MoveJoint, MoveLinear
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array, matrix_of
from unit.geometry.test_spreads import corners
from unit.robot.test_external_axes import DATA, SEAM, loaded, plate, plate_at, rail

GRIPPER = {"x": 0.15, "y": 0.05, "z": 0.2, "pitch": 40.0}
POSE = pose_mm(1000.0, 3600.0, 1200.0, 180.0, 10.0, 90.0)


def cell(is_plain: bool) -> RobotCell:
    data: dict[str, Any] = copy.deepcopy(DATA)
    data["robots"]["left"]["tcps"] = {"gripper": GRIPPER}
    if is_plain:
        del data["robots"]["left"]["axes"], data["frames"]
    found, d = loaded(data)
    assert found is not None, [x.message for x in d]
    return found


CELLS = {"plain": cell(is_plain=True), "axes": cell(is_plain=False)}


def gripper(which: str, q: Array) -> Array:
    robot = CELLS[which].robot("left")
    flange = robot.T_world_base @ robot.kinematics.joint_frames(q)[-1]
    own = matrix_of(pose_mm(150.0, 50.0, 200.0, 0.0, 40.0, 0.0))
    return np.asarray(flange @ own)


def executor(which: str) -> RobotExecutor:
    found = CELLS[which]
    return RobotExecutor(found.robot("left"), found.motion, found.frames)


def done(arm: RobotExecutor, command: Command) -> Motion:
    motion = arm.begin(command, 0.0)
    arm.finish()
    return motion


@pytest.mark.parametrize("which", CELLS)
def test_the_frame_that_is_told_comes_to_the_pose(which: str) -> None:
    arm = executor(which)
    motion = done(arm, MoveJoint(POSE, tcp="gripper"))
    assert np.abs(gripper(which, arm.q) - matrix_of(POSE)).max() < 1e-9
    robot = arm.robot
    own = robot.T_world_base @ robot.kinematics.forward(arm.q)
    assert np.abs(matrix_of(motion.target) - own).max() < 1e-9
    assert np.abs(arm.T_base_tcp - robot.kinematics.forward(arm.q)).max() < 1e-9


@pytest.mark.parametrize("which", CELLS)
def test_a_line_is_that_of_the_frame_that_is_told(which: str) -> None:
    arm = executor(which)
    done(arm, MoveJoint(POSE, tcp="gripper"))
    end = replace(POSE, x=POSE.x + 0.2, ry=POSE.ry - 0.3)
    motion = done(arm, MoveLinear(end, tcp="gripper"))
    path = motion.sample(np.linspace(0.0, motion.duration, 60))
    places = np.array([gripper(which, q)[:3, 3] for q in path])
    start, way = matrix_of(POSE)[:3, 3], np.array([0.2, 0.0, 0.0])
    off = np.cross(places - start, way / 0.2)
    assert np.abs(off).max() < 1e-9
    assert np.abs(gripper(which, path[-1]) - matrix_of(end)).max() < 1e-9
    speed = np.linalg.norm(np.diff(places, axis=0), axis=1).max() / (motion.duration / 59)
    assert speed <= CELLS[which].motion.linear_speed * 1.001
    # Back by an increment in its own frame, and on with the tool's own TCP.
    done(arm, MoveLinear(pose_mm(0.0, 0.0, -50.0), "tool", tcp="gripper"))
    wanted = matrix_of(end) @ matrix_of(pose_mm(0.0, 0.0, -50.0))
    assert np.abs(gripper(which, arm.q) - wanted).max() < 1e-9
    before = arm.robot.T_world_base @ arm.robot.kinematics.forward(arm.q)
    done(arm, MoveLinear(pose_mm(0.0, 0.0, -30.0), "tool"))
    after = arm.robot.T_world_base @ arm.robot.kinematics.forward(arm.q)
    assert np.abs(after - before @ matrix_of(pose_mm(0.0, 0.0, -30.0))).max() < 1e-9


def test_on_a_plate_that_turns_it_is_led_on_the_plate() -> None:
    arm = executor("axes")
    done(arm, MoveJoint(SEAM, frame="seam", tcp="gripper"))
    end = pose_mm(120.0, -40.0, 120.0, 180.0, 0.0, 15.0)
    done(arm, MoveLinear(end, "seam", along=(plate(30.0), rail(0.7)), tcp="gripper"))
    wanted = plate_at(np.radians(30.0)) @ matrix_of(pose_mm(0, 0, 100)) @ matrix_of(end)
    assert np.abs(gripper("axes", arm.q) - wanted).max() < 1e-9
    own = arm.robot.kinematics.forward(arm.q)
    assert np.abs(arm.T_base_tcp - own).max() < 1e-9


def test_a_tool_frame_that_is_not_there() -> None:
    with pytest.raises(MotionFault, match="it has no tool frame `griper`"):
        executor("plain").begin(MoveJoint(POSE, tcp="griper"), 0.0)


@pytest.mark.bullet
@pytest.mark.parametrize("which", CELLS)
def test_no_point_is_further_off_than_the_spread(which: str) -> None:
    found = CELLS[which]
    backend = BulletBackend(found, looks=False)
    shape = ArmShape.of(found.robot("left"), backend)
    backend.close()
    planner = Planner(found)
    over = planner.leg(planner.home("left"), MoveJoint(POSE, tcp="gripper"))
    end = replace(POSE, x=POSE.x + 0.1, ry=POSE.ry - 0.4, rz=POSE.rz + 0.3)
    via = replace(POSE, x=POSE.x + 0.1, z=POSE.z + 0.1)
    by = replace(via, z=POSE.z + 0.05)
    through = MoveLinear(end, tcp="gripper", via=(by,), blend=0.03)
    for command in (
        MoveLinear(end, tcp="gripper"),
        MoveCircular(via, end, tcp="gripper"),
        through,
    ):
        leg = planner.leg(over.end, command)
        assert leg.fault is None and leg.path is not None
        path = getattr(leg.path, "led", leg.path)
        assert isinstance(path, LinearTrajectory)
        track = Track(shape, leg)
        for a, size in ((0.1, 0.02), (0.5, 0.005), (0.7, 0.1), (0.95, 0.001)):
            knots = track.knots(np.array([a]), np.array([a + size]))
            if not np.isfinite(knots.spread).all():
                continue
            within = leg.path.on_way(np.linspace(a, a + size, 40))
            off = np.linalg.norm(corners(track, within) - corners(track, knots.q), axis=3)
            assert (off.max(axis=(0, 2)) <= knots.spread[0] + 1e-9).all()
