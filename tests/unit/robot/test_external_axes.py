"""External axes: where arms are on their tracks, and what is led on a plate that turns."""

from __future__ import annotations

import copy
import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.robot_cells import nowhere, pose_mm
from pn2code.diagnostics import Diagnostics
from pn2code.replay.arrays import unpacked
from pn2code.replay.cell import describe
from pn2code.robot.active_motion import Motion, turned
from pn2code.robot.along import AlongTrajectory
from pn2code.robot.carried import WithAxes
from pn2code.robot.commands import (
    Along,
    Command,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import Array, matrix_of, pose_of, rotation_about

DATA: dict[str, Any] = tomllib.loads("""
[robots.left]
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 1.0, y = 2.0, z = 0.4, yaw = 90.0 }
home = [0.0, -100.0, 110.0, 0.0, 80.0, 0.0]

[robots.left.axes.rail]
direction = [0.0, 2.0, 0.0]
from = -1.0
to = 3.0
home = 0.5
speed = 0.4
acceleration = 0.8
jerk = 4.0

[robots.left.axes.plate]
kind = "turntable"
pose = { x = 1.0, y = 3.9, z = 0.7, yaw = 20.0 }
from = -180.0
to = 360.0
speed = 40.0
radius = 0.5
objects = [{ name = "work", size = [0.4, 0.2, 0.1], pose = { z = 0.05 } }]

[frames.seam]
parent = "left.plate"
z = 0.1

[motion]
linear_speed = 0.1
""")
SEAM = pose_mm(0.0, 0.0, 120.0, 180.0, 0.0, 0.0)


def loaded(data: dict[str, Any]) -> tuple[RobotCell | None, Diagnostics]:
    d = Diagnostics()
    return load(data, Path(), nowhere, d), d


def cell() -> RobotCell:
    found, d = loaded(DATA)
    assert found is not None, [x.message for x in d]
    return found


CELL = cell()
LEFT = CELL.robot("left")


def rail(position: float) -> Along:
    return Along("rail", position, is_track=True)


def plate(degrees: float) -> Along:
    return Along("plate", math.radians(degrees), is_track=False)


def executor() -> RobotExecutor:
    return RobotExecutor(LEFT, CELL.motion, CELL.frames)


def done(arm: RobotExecutor, command: Command) -> Motion:
    motion = arm.begin(command, 0.0)
    arm.finish()
    return motion


def over_seam(turned: float = 0.0) -> RobotExecutor:
    arm = executor()
    done(arm, MoveJoint(SEAM, frame="seam", along=(plate(turned),)))
    return arm


def tcp(q: Array) -> Array:
    return np.asarray(LEFT.T_world_base @ LEFT.kinematics.forward(q))


def plate_at(angle: float) -> Array:
    turned = np.eye(4)
    turned[:3, :3] = rotation_about((0.0, 0.0, 1.0), angle)
    return np.asarray(matrix_of(pose_mm(1000, 3900, 700, 0, 0, 20)) @ turned)


def test_a_joint_position_has_tracks_first_and_turntables_last() -> None:
    assert LEFT.arm.axes[0] == "rail"
    assert LEFT.arm.axes[-1] == "plate"
    assert len(LEFT.home) == 8
    assert LEFT.home[0] == 0.5
    assert LEFT.arm.called(0) == "external axis `rail`"
    assert LEFT.arm.called(1).startswith("axis 1 (")


def test_a_track_carries_the_arm_along_its_direction() -> None:
    q = np.array(LEFT.home)
    away = q.copy()
    away[0] += 1.25
    # y of the base is -x of the world.
    assert np.abs(tcp(away) - tcp(q) - _shift(-1.25, 0.0, 0.0)).max() < 1e-12


def _shift(x: float, y: float, z: float) -> Array:
    out = np.zeros((4, 4))
    out[:3, 3] = (x, y, z)
    return out


def test_only_the_track_moves_where_it_alone_is_told_to() -> None:
    arm = executor()
    motion = done(arm, MoveExternal((rail(2.0),)))
    path = motion.sample(np.linspace(0.0, motion.duration, 300))
    assert np.ptp(path[:, 1:], axis=0).max() == 0.0
    assert path[-1, 0] == 2.0
    step = motion.duration / 299
    speed, acceleration, jerk = (np.abs(np.diff(path[:, 0], n)).max() / step**n for n in (1, 2, 3))
    assert speed <= 0.4 + 1e-9
    assert acceleration <= 0.8 + 1e-6
    assert jerk <= 4.0 * 1.01


def test_home_is_that_of_the_arm_and_leaves_the_track_where_it_is() -> None:
    arm = executor()
    done(arm, MoveExternal((rail(2.0), plate(30.0))))
    done(arm, MoveAxes(tuple(np.array(LEFT.home[1:7]) + 0.1)))
    done(arm, MoveHome())
    assert arm.q[0] == 2.0
    assert arm.q[1:7].tolist() == list(LEFT.home[1:7])
    assert arm.q[7] == math.radians(30.0)


@pytest.mark.parametrize("kind", [MoveJoint, MoveLinear])
def test_a_pose_of_the_world_is_reached_wherever_the_track_stands(kind: Any) -> None:
    arm = over_seam()
    goal = replace(arm.pose, y=arm.pose.y - 0.1)
    for position in (0.5, 0.2, 0.7):
        motion = done(arm, kind(goal, along=(rail(position),)))
        assert np.abs(tcp(arm.q) - matrix_of(goal)).max() < 1e-9
        assert motion.q(motion.ends)[0] == position


@pytest.mark.parametrize("turned", [0.0, 35.0, -50.0])
def test_a_frame_of_a_turntable_turns_with_it(turned: float) -> None:
    arm = over_seam(turned)
    wanted = plate_at(math.radians(turned)) @ matrix_of(pose_mm(0, 0, 100)) @ matrix_of(SEAM)
    assert np.abs(tcp(arm.q) - wanted).max() < 1e-9


def moves_on_plate() -> list[MoveLinear | MoveCircular]:
    far = pose_mm(150, 60, 120, 180, 0, 20)
    both = (rail(0.8), plate(40.0))
    return [
        MoveLinear(far, "seam"),
        MoveLinear(far, "seam", along=(plate(40.0),)),
        MoveLinear(far, "seam", along=both),
        MoveLinear(SEAM, "seam", along=both),
        MoveCircular(pose_mm(80, 90, 120, 180), far, "seam", along=both),
    ]


@pytest.mark.parametrize("command", moves_on_plate(), ids=lambda c: type(c).__name__)
def test_on_a_plate_that_turns_the_tcp_is_led_on_the_plate(command: Any) -> None:
    still = over_seam().begin(replace(command, along=()), 0.0)
    arm = over_seam()
    motion = arm.begin(command, 0.0)
    assert isinstance(motion.trajectory, AlongTrajectory)
    some = np.linspace(0.0, 1.0, 23)
    for one, other in zip(
        still.trajectory.on_way(some), motion.trajectory.on_way(some), strict=True
    ):
        on_plate = np.linalg.inv(plate_at(other[7])) @ tcp(other)
        assert np.abs(on_plate - np.linalg.inv(plate_at(one[7])) @ tcp(one)).max() < 1e-9
    times = np.linspace(0.0, motion.duration, 2000)
    q = motion.sample(times)
    places = np.array([(np.linalg.inv(plate_at(x[7])) @ tcp(x))[:3, 3] for x in q])
    speed = np.linalg.norm(np.diff(places, axis=0), axis=1).max() / times[1]
    assert speed <= CELL.motion.linear_speed * 1.001
    limits = LEFT.limits(CELL.motion)
    assert (np.abs(np.diff(q, axis=0)) / times[1] <= limits.axis_velocity + 1e-6).all()
    arm.finish()
    assert np.abs(arm.q - q[-1]).max() < 1e-12
    assert np.abs(matrix_of(motion.target) - tcp(q[-1])).max() < 1e-9


@pytest.mark.parametrize("command", moves_on_plate(), ids=lambda c: type(c).__name__)
def test_speeds_of_the_way_are_those_of_the_poses_on_it(command: Any) -> None:
    motion = over_seam().begin(command, 0.0)
    path = motion.trajectory
    assert isinstance(path, AlongTrajectory)
    s, h = np.linspace(0.05, 0.95, 7), 1e-6
    way = path.line
    before, after = way.at(s - h), way.at(s + h)
    shifts = (after - before)[:, :3, 3] / (2.0 * h)
    assert np.abs(shifts - way.shifts(s)).max() < 1e-6
    here = way.at(s)
    spins = way.spins(here[:, :3, :3], s)
    rates = (after - before)[:, :3, :3] / (2.0 * h) @ np.transpose(here[:, :3, :3], (0, 2, 1))
    found = np.stack([rates[:, 2, 1], rates[:, 0, 2], rates[:, 1, 0]], axis=1)
    assert np.abs(found - spins).max() < 1e-6
    # What the geometry check relies on.
    assert np.linalg.norm(shifts, axis=1).max() <= way.length + 1e-9
    assert np.linalg.norm(spins, axis=1).max() <= way.angle + 1e-9
    bends = (way.shifts(s + h) - way.shifts(s - h)) / (2.0 * h)
    assert np.linalg.norm(bends, axis=1).max() <= way.bend + 1e-6


@pytest.mark.parametrize(
    ("command", "kind", "message"),
    [
        (MoveExternal((rail(3.2),)), "joint-limit", "external axis `rail` would be at 3200.00 mm"),
        (MoveExternal((plate(-190),)), "joint-limit", "outside -180.00 .. 360.00"),
        (MoveExternal((Along("lift", 1.0, is_track=True),)), "bad-command", "it has no track"),
        (
            MoveExternal((Along("rail", 1.0, is_track=False),)),
            "bad-command",
            "it has no turntable `rail`",
        ),
        (MoveExternal((rail(math.nan),)), "bad-command", "cannot go to nan"),
        (MoveJoint(SEAM, frame="seam", along=(rail(3.0),)), "unreachable", "out of reach"),
    ],
)
def test_where_external_axes_cannot_go(command: Command, kind: str, message: str) -> None:
    with pytest.raises(MotionFault, match=message) as caught:
        executor().begin(command, 0.0)
    assert caught.value.kind == kind
    assert "robot `left`" in caught.value.message


def test_a_fault_on_the_way_tells_its_pose_in_the_world() -> None:
    arm = over_seam()
    with pytest.raises(MotionFault) as caught:
        arm.begin(MoveLinear(SEAM, "seam", along=(rail(3.0),)), 0.0)
    pose = caught.value.pose
    assert pose is not None
    # The TCP stays on the plate, so it is where it was.
    assert np.abs(matrix_of(pose) - tcp(arm.q)).max() < 1e-3


def test_what_a_pose_leads_to_depends_on_axes_that_the_move_does_not_tell() -> None:
    arm = executor()
    assert arm.depends(MoveJoint(SEAM))
    assert not arm.depends(MoveJoint(SEAM, along=(rail(0.1),)))
    assert arm.depends(MoveLinear(SEAM, "seam", along=(rail(0.1),)))
    assert not arm.depends(MoveLinear(SEAM, "seam", along=(rail(0.1), plate(0.0))))
    assert not arm.depends(MoveHome())
    arm.reach(MoveJoint(pose_mm(9000, 9000, 0)))  # nobody knows
    with pytest.raises(MotionFault, match="out of reach"):
        arm.reach(MoveJoint(pose_mm(9000, 9000, 0), along=(rail(0.1),)))


def changed(section: tuple[str, ...], **new: Any) -> dict[str, Any]:
    data = copy.deepcopy(DATA)
    table = data
    for name in section:
        table = table[name]
    table.update(new)
    return data


RAIL = ("robots", "left", "axes", "rail")
PLATE = ("robots", "left", "axes", "plate")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (changed(RAIL, to=-2.0), "but a number above `from` is expected"),
        (changed(RAIL, home=4.0), "external axis `rail` of robot `left` begins at 4 m, outside -1"),
        (changed(RAIL, direction=[0.0, 0.0, 0.0]), "but three numbers, not all of them 0 are expected"),
        (changed(RAIL, radius=0.5), "unknown key `radius`"),
        (changed(RAIL, kind="wheel"), "is `wheel`, but `track` or `turntable` is expected"),
        (changed(PLATE, direction=[1, 0, 0]), "unknown key `direction`"),
        (changed(("robots", "left", "axes"), link_1=DATA["robots"]["left"]["axes"]["rail"]),
         "cannot be called `link_1`"),
        (changed(("frames", "seam"), parent="left.plat"), "the name of another frame is expected"),
    ],
)  # fmt: skip
def test_axes_that_cannot_be(data: dict[str, Any], message: str) -> None:
    found, d = loaded(data)
    assert found is None
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]


def test_a_frame_on_the_plate_of_a_robot_that_is_wrong_is_no_second_mistake() -> None:
    _, d = loaded(changed(("robots", "left"), tool="torsch.urdf"))
    assert [e.code for e in d.errors] == ["robot-tool"], [e.message for e in d.errors]


def test_whether_a_plate_turns_meanwhile_is_worked_out_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It is asked at each sample of a run, and each end of a way is an inverse."""
    asked: list[float] = []
    of_line = AlongTrajectory.q

    def q(path: AlongTrajectory, t: float) -> Array:
        asked.append(t)
        return of_line(path, t)

    still, arm = over_seam(), over_seam()
    calm = still.begin(MoveLinear(SEAM, frame="seam", along=(rail(0.2),)), 0.0)
    motion = arm.begin(MoveLinear(SEAM, frame="seam", along=(plate(40.0),)), 0.0)
    assert isinstance(motion.trajectory, AlongTrajectory)
    monkeypatch.setattr(AlongTrajectory, "q", q)
    for _ in range(3):
        assert turned(LEFT, motion) == {"left/plate"} and turned(LEFT, calm) == frozenset()
    assert sorted(asked) == sorted((0.0, motion.duration, 0.0, calm.duration))


def test_without_its_limits_an_axis_is_none() -> None:
    data = copy.deepcopy(DATA)
    del data["robots"]["left"]["axes"]["rail"]["from"]
    found, d = loaded(data)
    assert found is None
    assert any("is missing" in e.message for e in d.errors), [e.message for e in d.errors]


def test_a_plate_is_part_of_the_kinematics() -> None:
    k = LEFT.kinematics
    assert isinstance(k, WithAxes)
    q = np.array(LEFT.home)
    q[7] = 0.7
    frames = k.joint_frames(q)
    assert np.abs(LEFT.T_world_base @ frames[7] - plate_at(0.7)).max() < 1e-12
    assert np.abs(frames[-1] @ k.T_flange_tcp - k.forward(q)).max() < 1e-12


def test_the_replay_page_gets_joints_that_slide() -> None:
    """The page multiplies frames as here (`templates/web/kinematics.js`)."""
    described = describe(CELL)
    (robot,) = described["robots"]
    q = np.array(LEFT.home) + 0.3
    frames = {0: np.array(robot["base"]).reshape(4, 4)}
    for joint in robot["joints"]:
        frame = frames[joint["parent"]] @ np.array(joint["frame"]).reshape(4, 4)
        if joint["moves"] >= 0:
            move = np.eye(4)
            if joint.get("slides"):
                move[:3, 3] = np.array(joint["axis"]) * q[joint["moves"]]
            else:
                move[:3, :3] = rotation_about(joint["axis"], q[joint["moves"]])
            frame = frame @ move
        frames[joint["child"]] = frame
    assert np.abs(frames[robot["tcp"]] - tcp(q)).max() < 1e-7
    assert [j["moves"] for j in robot["joints"] if j.get("slides")] == [0]
    numbers = {x["name"]: i for i, x in enumerate(robot["links"])}
    assert np.abs(frames[numbers["plate"]] - plate_at(q[7])).max() < 1e-7
    glb = unpacked(described["glb"]).astype(np.uint8).tobytes()
    nodes = json.loads(glb[20 : 20 + int.from_bytes(glb[12:16], "little")])["nodes"]
    assert len(nodes[robot["links"][numbers["plate"]]["node"]]["children"]) == 2


@pytest.mark.parametrize("frame", ["world", "seam"])
def test_a_way_through_poses_while_external_axes_stand(frame: str) -> None:
    """As of an arm without them: the ends are exact, the corner is rounded within its zone."""
    arm = over_seam(35.0)
    at = np.eye(4)
    if frame == "seam":
        at = plate_at(math.radians(35.0)) @ matrix_of(pose_mm(0, 0, 100))
    begin = tcp(arm.q)
    here = np.linalg.inv(at) @ begin

    def shifted(x: float, y: float) -> Any:
        own = here.copy()
        own[:2, 3] += (x, y)
        return pose_of(own)

    motion = arm.begin(
        MoveLinear(shifted(0.1, 0.08), frame, via=(shifted(0.1, 0.0),), blend=0.03), 0.0
    )
    assert motion.kind == "blend" and isinstance(motion.trajectory, AlongTrajectory)
    places = np.stack([tcp(q)[:3, 3] for q in motion.trajectory.on_way(np.linspace(0.0, 1.0, 401))])
    places = (np.linalg.inv(at) @ np.c_[places, np.ones(401)].T).T[:, :3] - here[:3, 3]
    assert np.abs(places[0]).max() < 1e-9
    assert np.abs(places[-1] - [0.1, 0.08, 0.0]).max() < 1e-9
    off = np.minimum(np.abs(places[:, 1]), np.abs(places[:, 0] - 0.1))
    near = np.linalg.norm(places - [0.1, 0.0, 0.0], axis=1)
    assert off[near > 0.03 + 1e-9].max() < 1e-9
    assert near.min() == pytest.approx(0.01 * math.sin(math.pi / 4.0), rel=0.02)


def test_external_axes_do_not_move_on_a_way_through_poses() -> None:
    far = pose_mm(150, 60, 120, 180, 0, 20)
    command = MoveLinear(
        far, "seam", along=(plate(40.0),), via=(pose_mm(80, 90, 120, 180),), blend=0.01
    )
    with pytest.raises(MotionFault, match="external axes stand still on a linear move through"):
        over_seam().begin(command, 0.0)
