"""Joint positions, arcs, frames and accelerations: what an arm does on them, and what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.robot.active_motion import Motion
from pn2code.robot.commands import (
    Command,
    MoveAxes,
    MoveCircular,
    MoveHome,
    MoveJoint,
    MoveLinear,
    Pose,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import matrix_of, pose_of

CELL = riveting_cell("good")
START = np.radians([10.0, -100.0, 90.0, 20.0, 40.0, 60.0])
BENCH = Pose(1.0, 2.0, 0.5, 0.1, -0.2, 0.7)


def executor() -> RobotExecutor:
    """Robot 1, away from HOME."""
    made = RobotExecutor(CELL.robot("robot1"), CELL.motion, {"bench": BENCH})
    made.stand(START, made.robot.kinematics.forward(START), "")
    return made


def arc(via: Pose, target: Pose, speed: float | None = None) -> Motion:
    return executor().begin(MoveCircular(via, target, "tool", speed), 0.0)


def test_a_joint_position_is_reached_exactly() -> None:
    arm = executor()
    wanted = tuple(np.radians([-20.0, -80.0, 100.0, 200.0, -30.0, 10.0]).tolist())
    motion = arm.begin(MoveAxes(wanted, 0.5), 0.0)
    assert motion.kind == "ptp"
    assert motion.q(motion.duration).tolist() == list(wanted)
    arm.finish()
    assert arm.q.tolist() == list(wanted)


@pytest.mark.parametrize(
    ("angles", "kind", "message"),
    [
        ((0, 0, 90, 0, 0, 0), "joint-limit", "axis 2 (`joint_2`) would be at 0.00 deg, outside"),
        ((0, -90, 90, 0, 0), "bad-command", "a joint position has 6 finite angles"),
        ((0, -90, math.nan, 0, 0, 0), "bad-command", "a joint position has 6 finite angles"),
    ],
)
def test_joint_positions_that_are_none(angles: tuple[float, ...], kind: str, message: str) -> None:
    with pytest.raises(MotionFault, match="robot1") as caught:
        executor().begin(MoveAxes(tuple(map(math.radians, angles))), 0.0)
    assert caught.value.kind == kind
    assert message in caught.value.message


def test_an_arc_is_on_its_circle_and_through_the_place_on_the_way() -> None:
    motion = arc(pose_mm(60.0, 0, -80.0), pose_mm(150.0, 20.0, -30.0, 0, 9.0, 0))
    k = CELL.robot("robot1").kinematics
    start = k.forward(START)
    places = k.forward_many(motion.sample(np.linspace(0.0, motion.duration, 400)))[:, :3, 3]
    ends = [start @ matrix_of(p) for p in (pose_mm(60.0, 0, -80.0), pose_mm(150.0, 20.0, -30.0))]
    assert np.linalg.norm(places[-1] - ends[1][:3, 3]) < 1e-9
    assert np.linalg.norm(places - ends[0][:3, 3], axis=1).min() < 1e-3
    # The circle through three places is that through any three of them.
    a, b, c = places[0], places[120], places[-1]
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    centre = a + (np.cross(normal, ab) * (ac @ ac) + np.cross(ac, normal) * (ab @ ab)) / (
        2.0 * normal @ normal
    )
    off = np.linalg.norm(places - centre, axis=1) - np.linalg.norm(a - centre)
    assert np.abs(off).max() < 1e-9
    assert np.abs((places - a) @ normal / np.linalg.norm(normal)).max() < 1e-9


@pytest.mark.parametrize("speed", [0.02, 0.3, 5.0])
@pytest.mark.parametrize("size", [10.0, 100.0])
def test_on_an_arc_speed_acceleration_and_jerk_of_the_tcp_are_limited(
    speed: float, size: float
) -> None:
    motion = arc(pose_mm(size, 0, -size), pose_mm(2.0 * size, 0, 0), speed)
    limits = CELL.robot("robot1").limits(CELL.motion)
    path = motion.trajectory
    assert isinstance(path, LinearTrajectory)
    times = np.linspace(0.0, motion.duration, 3000)
    places = path.line.at(path.way(times))[:, :3, 3]
    step = times[1]
    v, a, j = (np.diff(places, n, axis=0) / step**n for n in (1, 2, 3))
    assert np.linalg.norm(v, axis=1).max() <= speed * 1.001
    assert np.linalg.norm(a, axis=1).max() <= limits.linear_acceleration * 1.001
    assert np.linalg.norm(j, axis=1).max() <= limits.linear_jerk * 1.01


@pytest.mark.parametrize(
    ("via", "target", "message"),
    [
        (pose_mm(50.0, 0, 0), pose_mm(100.0, 0, 0), "lie on a line"),
        (pose_mm(0, 0, 0), pose_mm(100.0, 0, 0), "lie on a line"),
        (pose_mm(100.0, 0, 0), pose_mm(100.0, 0, 0), "lie on a line"),
        (pose_mm(-70.0, 0, 0), pose_mm(100.0, 0, 0), "lie on a line"),
        (pose_mm(50.0, 50.0, 0), pose_mm(0, 0, 0), "ends where it begins"),
    ],
)
def test_places_through_which_there_is_no_arc(via: Pose, target: Pose, message: str) -> None:
    with pytest.raises(MotionFault, match=message) as caught:
        arc(via, target)
    assert caught.value.kind == "bad-command"


def test_an_arc_that_leaves_the_reach_is_refused_though_both_ends_are_reached() -> None:
    arm = executor()
    there = arm.pose
    far = Pose(there.x, there.y + 3.0, there.z, there.rx, there.ry, there.rz)
    end = Pose(there.x + 0.05, there.y, there.z, there.rx, there.ry, there.rz)
    arm.begin(MoveLinear(end), 0.0)
    arm.stop(0.0)
    with pytest.raises(MotionFault, match="the arc") as caught:
        arm.begin(MoveCircular(far, end), 0.0)
    assert caught.value.kind in ("unreachable", "joint-limit", "singularity")


@pytest.mark.parametrize("move", [MoveJoint, MoveLinear])
def test_a_pose_in_a_frame_is_that_pose_in_the_world(move: type[MoveJoint | MoveLinear]) -> None:
    arm = executor()
    there = pose_of(matrix_of(arm.pose) @ matrix_of(pose_mm(30.0, -20.0, 10.0, 0, 5.0, 0)))
    own = pose_of(np.linalg.inv(matrix_of(BENCH)) @ matrix_of(there))
    a = executor().begin(move(there), 0.0)
    b = executor().begin(move(own, frame="bench"), 0.0)
    assert np.abs(a.q(a.duration) - b.q(b.duration)).max() < 1e-9
    assert np.abs(matrix_of(b.target) - matrix_of(there)).max() < 1e-9
    with pytest.raises(MotionFault, match="there is no frame `table` in cell.toml"):
        executor().begin(move(own, frame="table"), 0.0)


@pytest.mark.parametrize(
    "command",
    [
        MoveHome(),
        MoveAxes(tuple((START + 0.3).tolist())),
        MoveLinear(pose_mm(80.0, 0, 0), "tool", 0.3),
        MoveCircular(pose_mm(40.0, 40.0, 0), pose_mm(80.0, 0, 0), "tool", 0.3),
    ],
    ids=lambda c: type(c).__name__,
)
def test_less_acceleration_takes_longer_on_the_same_way(command: Command) -> None:
    from dataclasses import replace

    full = executor().begin(command, 0.0)
    part = executor().begin(replace(command, acceleration=0.1), 0.0)  # type: ignore[call-arg]
    assert part.duration > 1.3 * full.duration
    some = np.linspace(0.0, 1.0, 9)
    assert np.abs(part.trajectory.on_way(some) - full.trajectory.on_way(some)).max() < 1e-9
    with pytest.raises(MotionFault, match="acceleration must be a fraction"):
        executor().begin(replace(command, acceleration=1.5), 0.0)  # type: ignore[call-arg]
