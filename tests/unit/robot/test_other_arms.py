"""Seven axes, SCARA, gantry, coupled axes: data sheets, all branches, a second inverse, what PyBullet says, moves."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry.lines import Follower
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, MoveAxes, MoveCircular, MoveJoint, MoveLinear, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import MODELS, find_arm
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import difference, matrix_of, pose_of

HERE = Origin("cell.toml")
# Limits and speeds, from the makers' data sheets (degrees, m, and per second); HOME of the tests.
PUBLISHED = {
    "iiwa14_r820": (
        [170, 120, 170, 120, 170, 120, 175],
        [85, 85, 100, 75, 130, 135, 135],
        [0, 30, 0, 90, 0, -60, 0],
    ),
    "cobra_s600": ([105, 150, 0.21, 360], [386, 720, 1.1, 1200], [20, 60, 0.05, 0]),
    "gantry_3000": ([3.0, 1.0, 1.2, 180], [2.0, 2.0, 1.5, 180], [1.0, 0.2, 0.3, 0]),
    "lrmate200id": (
        [170, 145, 205, 190, 125, 360],
        [450, 380, 520, 550, 545, 1000],
        [0, 10, -20, 0, -60, 0],
    ),
}
# Where payloads can be read: in the names that makers give arms, UR5e: its Hardware Manual (stopping distances with the
# maximum payload), LR Mate 200iD: FANUC's product page. Of cobra_s600, and of moments, no published source was found.
PAYLOADS = {
    "irb6700_200_260": 200, "gp25": 25, "iiwa14_r820": 14, "lrmate200id": 7, "ur5e": 5, "ur10e": 12.5,
}  # fmt: skip
NEW = [*PUBLISHED]


def kinematics(name: str) -> Kinematics:
    d = Diagnostics()
    arm = find_arm(name, Path(), HERE, d)
    assert arm is not None, list(d)
    found = Kinematics.of(arm, None, HERE, d)
    assert found is not None, list(d)
    return found


def cell(name: str, **more: Any) -> RobotCell:
    d = Diagnostics()
    robot = {"model": name, "base": {"z": 0.2}, "home": PUBLISHED[name][2], **more}
    found = load({"robots": {"r": robot}}, Path(), lambda *_: HERE, d)
    assert found is not None, [e.message for e in d.errors]
    return found


def executor(name: str, **more: Any) -> RobotExecutor:
    c = cell(name, **more)
    return RobotExecutor(c.robot("r"), c.motion)


def positions(k: Kinematics, count: int, part: float = 1.0) -> Any:
    middle, half = (k.arm.upper + k.arm.lower) / 2, (k.arm.upper - k.arm.lower) / 2
    return np.random.default_rng(7).uniform(
        middle - part * half, middle + part * half, (count, len(half))
    )


def apart(k: Kinematics, a: Any, b: Any) -> Any:
    off = np.abs((a - b + math.pi) % (2 * math.pi) - math.pi)
    off[..., k.slides] = np.abs(a - b)[..., k.slides]
    return off.max(axis=-1)


@pytest.mark.parametrize("name", NEW)
def test_the_arm_is_that_of_the_data_sheet(name: str) -> None:
    k = kinematics(name)
    factor = np.where(k.slides, 1.0, math.degrees(1.0))
    limits, speeds, _ = PUBLISHED[name]
    assert k.arm.upper * factor == pytest.approx(limits)
    assert k.arm.velocity * factor == pytest.approx(speeds)


@pytest.mark.parametrize("name", PAYLOADS)
def test_payloads_are_the_published_ones_and_the_file_says_where_they_are(name: str) -> None:
    d = Diagnostics()
    arm = find_arm(name, Path(), HERE, d)
    assert arm is not None and arm.urdf.rating is not None, list(d)
    assert arm.urdf.rating.payload == PAYLOADS[name]
    assert "<!-- Held against: " in (MODELS / f"{name}.urdf").read_text(encoding="utf-8")


def test_axis_3_of_the_lr_mate_has_the_published_span() -> None:
    """-2.450966 to 4.886922 rad: FANUC's manual B-83494EN/03, as in ROS-Industrial's fanuc_lrmate200id_support."""
    k = kinematics("lrmate200id")
    (coupled,) = k.arm.urdf.couplings
    assert coupled.upper - coupled.lower == pytest.approx(4.886922 + 2.450966, abs=0.01)


def test_reaches_are_the_published_ones() -> None:
    seven = kinematics("iiwa14_r820").joint_frames(np.zeros(7))
    heights = [seven[i][2, 3] for i in (1, 3, 5, 7)]
    assert np.diff([0.0, *heights]) == pytest.approx([0.36, 0.42, 0.4, 0.126])
    assert heights[2] - heights[0] == pytest.approx(0.82)
    scara = kinematics("cobra_s600").forward(np.zeros(4))
    # The flange is 387 to 177 mm above the foot.
    assert scara[:3, 3] == pytest.approx([0.6, 0.0, 0.387])
    k = kinematics("lrmate200id")
    low, high = k.arm.lower, k.arm.upper
    x, y = np.meshgrid(np.linspace(low[1], high[1], 90), np.linspace(low[2], high[2], 90))
    q = np.zeros((x.size, 6))
    q[:, 1], q[:, 2] = x.ravel(), y.ravel()
    assert np.abs(k.link_frames(q)[4][:, 0, 3]).max() == pytest.approx(0.717, rel=0.003)


@pytest.mark.parametrize("name", NEW)
def test_each_position_is_found_again_and_so_are_the_other_branches(name: str) -> None:
    k = kinematics(name)
    q = positions(k, 60)
    poses = k.forward_many(q)
    angles = None if k.arm_angle is None else np.array([k.arm_angle_of(x) for x in q])
    rows = k.all_branches(poses, angles)
    there = ~np.isnan(rows[:, :, 0])
    assert np.abs(k.forward_many(rows[there]) - np.repeat(poses, there.sum(1), axis=0)).max() < 1e-8
    own = np.array([rows[i, k.branch_of(x).index] for i, x in enumerate(q)])
    assert apart(k, own, q).max() < 1e-6
    assert (there.sum(1) == len(k.branches)).mean() > 0.4
    if angles is not None:  # an arm angle is kept on every branch
        found = [k.arm_angle_of(row) for row in rows[there]]
        off = (np.array(found) - np.repeat(angles, there.sum(1)) + math.pi) % (2 * math.pi)
        assert np.abs(off - math.pi).max() < 1e-6


def numeric(k: Kinematics, target: Any, start: Any) -> Any:
    """A second inverse: damped Newton steps on the forward kinematics, nothing else."""
    q = start.copy()
    for _ in range(60):
        now = k.forward(q)
        turn = target[:3, :3] @ now[:3, :3].T
        spin = 0.5 * np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        error = np.concatenate([target[:3, 3] - now[:3, 3], spin])
        columns = []
        for axis in range(len(q)):  # the Jacobian by differences
            step = q.copy()
            step[axis] += 1e-6
            there = k.forward(step)
            by = (there[:3, :3] - now[:3, :3]) @ now[:3, :3].T / 1e-6
            columns.append([*((there[:3, 3] - now[:3, 3]) / 1e-6), by[2, 1], by[0, 2], by[1, 0]])
        j = np.array(columns).T
        q = q + j.T @ np.linalg.solve(j @ j.T + 1e-10 * np.eye(6), error)
        if np.abs(error).max() < 1e-13:
            break
    return q


@pytest.mark.parametrize("name", NEW)
def test_a_second_inverse_finds_the_same(name: str) -> None:
    k = kinematics(name)
    compared = 0
    for q in positions(k, 12, 0.9):
        if k.conditioning(q).condition > 30.0:
            continue
        target = k.forward(q)
        found = numeric(k, target, q + 0.05)
        if max(difference(k.forward(found), target)) > 1e-9:
            continue
        rows = k.all_branches(target[None], k.arm_angle_of(found))[0]
        assert np.nanmin(apart(k, rows, found)) < 1e-6
        compared += 1
    assert compared >= 3


@pytest.mark.parametrize("name", NEW)
def test_the_square_matrix_of_a_line_is_the_derivative_of_what_a_line_is_about(name: str) -> None:
    k = kinematics(name)
    for q in positions(k, 4, 0.8):
        square = k.led_jacobian(q[None])[0]
        assert square.shape == (len(q), len(q))
        for axis in range(len(q)):
            step = np.zeros(len(q))
            step[axis] = 1e-6
            a, b = k.forward(q - step), k.forward(q + step)
            turn = b[:3, :3] @ a[:3, :3].T
            spin = 0.5 * np.array(
                [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
            )
            twist = np.concatenate([b[:3, 3] - a[:3, 3], spin]) / 2e-6
            swivel = 0.0
            if k.arm_angle is not None:
                off = k.arm_angle_of(q + step) - k.arm_angle_of(q - step)  # type: ignore[operator]
                swivel = ((off + math.pi) % (2 * math.pi) - math.pi) / 2e-6
            assert np.abs(k.led_twist(twist, swivel) - square[:, axis]).max() < 1e-5


def test_what_is_said_of_how_fast_the_matrix_changes_holds() -> None:
    """By differences, at random places in the ball for which it is said."""
    k = kinematics("iiwa14_r820")
    random = np.random.default_rng(1)
    base = 7.0 * math.hypot(k.longest, 1.0)
    for q in positions(k, 15, 0.9):
        steep, far = (float(x[0]) for x in k.led_steepness(q[None]))
        for _ in range(5):
            away = random.normal(size=7)
            there = q + away / np.linalg.norm(away) * min(far, 0.5) * random.uniform()
            way = random.normal(size=7)
            way *= 1e-6 / np.linalg.norm(way)
            a, b = k.led_jacobian(np.stack([there, there + way]))
            assert np.linalg.norm(b - a, 2) / 1e-6 <= base + steep
            assert np.linalg.norm(b[6] - a[6]) / 1e-6 <= steep


# Moves


def begin(arm: RobotExecutor, command: Any) -> Any:
    motion = arm.begin(command, 0.0)
    arm.finish()
    return motion


def down(x: float, y: float, z: float, yaw: float = 0.0) -> Pose:
    return Pose(x, y, z, math.pi, 0.0, yaw)


WAYS = {
    "iiwa14_r820": (
        down(0.5, 0.2, 0.5, 2.0),
        down(0.5, -0.2, 0.4, 2.4),
        down(0.6, 0.0, 0.5, 2.0),
    ),
    "cobra_s600": (down(0.4, 0.2, 0.5), down(0.45, -0.2, 0.45, 0.4), down(0.5, 0.0, 0.5)),
    "gantry_3000": (down(0.4, 0.2, 1.2), down(2.0, -0.2, 0.9, 0.4), down(1.5, 0.6, 1.2)),
    "lrmate200id": (down(0.4, 0.2, 0.4), down(0.45, -0.2, 0.45, 0.4), down(0.5, 0.0, 0.4)),
}


@pytest.mark.parametrize("name", NEW)
def test_lines_and_arcs_are_exact_and_what_lies_between_samples_is_known(name: str) -> None:
    first, second, via = WAYS[name]
    arm = executor(name)
    k, base = arm.robot.kinematics, arm.robot.T_world_base
    begin(arm, MoveJoint(first))
    for command in (MoveLinear(second), MoveCircular(via, first)):
        motion = begin(arm, command)
        times = np.linspace(0.0, motion.duration, 30)
        q = motion.sample(times)
        wanted = motion.trajectory.line.at(motion.trajectory.way(times))
        assert np.abs(k.forward_many(q) - wanted).max() < 1e-9
        assert difference(matrix_of(arm.pose), matrix_of(command.target))[0] < 1e-9
        speeds = np.array([motion.trajectory.qd(float(t)) for t in times[1:-1]])
        step = 1e-4
        ahead = motion.sample(times[1:-1] + step) - motion.sample(times[1:-1] - step)
        assert np.abs(ahead / (2 * step) - speeds).max() < 5e-3
        # Pieces: no joint is further from the middle than is said.
        follower = Follower(motion.trajectory.kinematics, motion.trajectory)
        edges = np.linspace(0.0, 1.0, 201)
        middle, away, lost = follower.pieces(edges[:-1], edges[1:])
        assert not lost.any() and np.isfinite(away).all()
        for i in (0, 77, 199):
            between = motion.trajectory.on_way(np.linspace(edges[i], edges[i + 1], 40))
            assert (np.abs(k.unwound(between, middle[i]) - middle[i]) <= away[i] + 1e-9).all()
    assert base.shape == (4, 4)


def test_the_arm_angle_of_a_move_of_the_robot_and_of_neither() -> None:
    pose = down(0.5, 0.2, 0.5)
    for arm, said, wanted in (
        (executor("iiwa14_r820"), None, 0.0),
        (executor("iiwa14_r820", arm_angle=25), None, 25.0),
        (executor("iiwa14_r820", arm_angle=25), -40.0, -40.0),
    ):
        told = None if said is None else math.radians(said)
        begin(arm, MoveJoint(pose, arm_angle=told))
        k = arm.robot.kinematics
        assert math.degrees(k.arm_angle_of(arm.q) or 0.0) == pytest.approx(wanted, abs=1e-6)
        assert difference(matrix_of(arm.pose), matrix_of(pose))[0] < 1e-9


def test_on_a_line_the_arm_angle_goes_evenly_and_increments_keep_it() -> None:
    arm = executor("iiwa14_r820", branch="plus/minus/plus")
    k = arm.robot.kinematics
    begin(arm, MoveJoint(down(0.5, 0.2, 0.5, 2.0), arm_angle=0.6))
    begin(arm, MoveLinear(Pose(0.0, 0.0, -0.05, 0.0, 0.0, 0.0), "tool"))
    assert k.arm_angle_of(arm.q) == pytest.approx(0.6)
    motion = begin(arm, MoveLinear(down(0.5, -0.1, 0.5, 2.0), arm_angle=-0.3))
    for s in (0.0, 0.25, 0.5, 1.0):
        q = motion.trajectory.on_way(np.array([s]))[0]
        assert k.arm_angle_of(q) == pytest.approx(0.6 - 0.9 * s)
    # The elbow alone: the tool stands still.
    motion = begin(arm, MoveLinear(down(0.5, -0.1, 0.5, 2.0), arm_angle=0.5))
    tcp = k.forward_many(motion.sample(np.linspace(0.0, motion.duration, 50)))
    assert motion.duration > 0.5 and np.abs(tcp - tcp[0]).max() < 1e-9
    assert k.arm_angle_of(arm.q) == pytest.approx(0.5)


def test_on_a_rail_and_a_plate_the_arm_angle_goes_along() -> None:
    axes = {
        "rail": {"direction": [0.0, 1.0, 0.0], "from": -0.5, "to": 1.0},
        "plate": {
            "kind": "turntable", "pose": {"x": 0.6, "z": 0.4}, "from": -180.0, "to": 180.0, "radius": 0.2,
        },
    }  # fmt: skip
    d = Diagnostics()
    robot = {"model": "iiwa14_r820", "base": {}, "home": PUBLISHED["iiwa14_r820"][2], "axes": axes}
    frames = {"seam": {"parent": "r.plate", "z": 0.1}}
    c = load({"robots": {"r": robot}, "frames": frames}, Path(), lambda *_: HERE, d)
    assert c is not None, [e.message for e in d.errors]
    arm = RobotExecutor(c.robot("r"), c.motion, c.frames)
    k = arm.robot.kinematics
    begin(arm, MoveJoint(down(0.0, 0.0, 0.0, 2.0), frame="seam", arm_angle=0.2))
    along = (Along("rail", 0.1, True), Along("plate", 0.2, False))
    motion = begin(arm, MoveLinear(down(0.05, 0.0, 0.0, 2.0), "seam", along=along, arm_angle=0.5))
    for s in (0.0, 0.5, 1.0):
        q = motion.trajectory.on_way(np.array([s]))[0]
        assert k.arm_angle_of(q) == pytest.approx(0.2 + 0.3 * s)
        assert q[0] == pytest.approx(0.1 * s)
        seen = motion.trajectory.on_plate(q)
        assert seen[:3, 3] == pytest.approx([0.05 * s, 0.0, 0.1])


def test_an_arm_angle_where_there_is_none() -> None:
    with pytest.raises(MotionFault, match="it has no arm angle"):
        executor("cobra_s600").begin(MoveJoint(down(0.4, 0.2, 0.5), arm_angle=0.1), 0.0)


@pytest.mark.parametrize("name", ["cobra_s600", "gantry_3000"])
def test_poses_that_cannot_be_had_say_why(name: str) -> None:
    first, _, _ = WAYS[name]
    arm = executor(name)
    tilted = Pose(first.x, first.y, first.z, math.pi - math.radians(5.0), 0.0, 0.0)
    for command in (MoveJoint(tilted), MoveLinear(tilted)):
        with pytest.raises(MotionFault, match="it tilts the tool by .* about the vertical") as e:
            arm.begin(command, 0.0)
        assert e.value.kind == "unreachable"
    with pytest.raises(MotionFault, match="out of reach|outside"):
        arm.begin(MoveJoint(down(7.0, 0.0, 0.3)), 0.0)


def test_a_tilted_pose_cannot_be_had_wherever_a_lift_stands() -> None:
    """Whether the place is within reach depends on the lift, which the move does not tell; the tilt does not."""
    lift = {"direction": [0.0, 0.0, 1.0], "from": 0.0, "to": 0.3}
    arm = executor("cobra_s600", axes={"lift": lift})
    arm.reach(MoveLinear(down(0.4, 0.2, 7.0)))
    tilted = Pose(0.4, 0.2, 0.5, math.pi - math.radians(5.0), 0.0, 0.0)
    with pytest.raises(MotionFault, match="it tilts the tool by 5 deg"):
        arm.reach(MoveLinear(tilted))


def test_joint_positions_of_slides_are_in_mm() -> None:
    arm = executor("cobra_s600")
    told = tuple(math.radians(v) for v in (10.0, 20.0, 120.0, 30.0))
    begin(arm, MoveAxes(told))
    assert arm.q == pytest.approx([math.radians(10), math.radians(20), 0.12, math.radians(30)])
    with pytest.raises(MotionFault, match=r"axis 3 .* would be at 300.00 mm, outside 0.00 .. 210"):
        arm.begin(MoveAxes(tuple(math.radians(v) for v in (10.0, 20.0, 300.0, 30.0))), 0.0)
    with pytest.raises(MotionFault, match="has 4 finite numbers"):
        arm.begin(MoveAxes((0.0,) * 6), 0.0)


def test_coupled_axes_are_counted_as_their_maker_does() -> None:
    arm = executor("lrmate200id", home=[0, 0, 0, 0, -30, 0])
    before = arm.robot.kinematics.joint_frames(arm.q)[3]
    begin(arm, MoveAxes(tuple(math.radians(v) for v in (0, 40, 0, 0, -30, 0))))
    after = arm.robot.kinematics.joint_frames(arm.q)[3]
    # Axis 2 alone has moved: the forearm keeps its direction.
    assert np.abs(after[:3, :3] - before[:3, :3]).max() < 1e-12
    assert math.degrees(arm.q[2]) == pytest.approx(40.0)
    with pytest.raises(MotionFault, match=r"axis 3 .* 206.00 deg \(counted with axis 2\), outside"):
        arm.begin(MoveAxes(tuple(math.radians(v) for v in (0, -5, 206, 0, -30, 0))), 0.0)


def test_no_branch_leaves_a_coupled_limit() -> None:
    k = kinematics("lrmate200id")
    left = 0
    for q in positions(k, 80):
        inside = k.arm.margins(q).min() >= 0.0
        rows = [s.q for s in k.inverse(k.forward(q), q)]
        assert inside == any(apart(k, row, q) < 1e-6 for row in rows)
        left += not inside
    assert left > 2


@pytest.mark.parametrize(
    ("model", "change", "message"),
    [
        ("lrmate200id", ('with="joint_2"', 'with="joint_9"'), "`joint_9`, which is no revolute"),
        ("lrmate200id", ('with="joint_2"', 'with="joint_4"'), "which is not before it"),
        ("lrmate200id", (' factor="-1"', ' factor="x"'), "`factor` is `x`"),
        ("cobra_s600", ('<axis xyz="0 0 -1"/>', '<axis xyz="0 1 0"/>'), "axis 3 slides, and is not"),
        ("cobra_s600", ('xyz="0.325 0 0"', 'xyz="0 0 0.1"'), "axes 1 and 2 turn about one line"),
        ("gantry_3000", ('<axis xyz="1 0 0"/>', '<axis xyz="0 1 0"/>'), "are in one plane"),
        ("iiwa14_r820", ('xyz="0 0 0.2155"', 'xyz="0.05 0 0.2155"'), "do not meet in one point"),
        ("iiwa14_r820", ('<axis xyz="0 -1 0"/>', '<axis xyz="1 0 0"/>'), "are not parallel at zero"),
    ],
)  # fmt: skip
def test_arms_that_are_not_known(
    tmp_path: Path, model: str, change: tuple[str, str], message: str
) -> None:
    text = (MODELS / f"{model}.urdf").read_text()
    assert change[0] in text
    (tmp_path / "odd.urdf").write_text(text.replace(change[0], change[1]))
    d = Diagnostics()
    arm = find_arm("odd.urdf", tmp_path, HERE, d)
    assert arm is None or Kinematics.of(arm, None, HERE, d) is None
    assert message in d.errors[0].message, d.errors[0].message


@pytest.mark.parametrize(
    ("model", "more", "message"),
    [
        ("cobra_s600", {"home": [0, 0, 0, 0, 0, 0]}, "has 6 numbers, but its arm `cobra_s600` has 4"),
        ("cobra_s600", {"home": [0, 0, 0.3, 0]}, "axis 3 at 0.3 m, outside 0 .. 0.21"),
        ("cobra_s600", {"branch": "front/up/plus"}, "`left`, `right`"),
        ("cobra_s600", {"arm_angle": 3}, "`arm_angle`, but its arm `cobra_s600` has 4 axes"),
        ("lrmate200id", {"home": [0, -5, 206, 0, -30, 0]}, "206 degrees (counted with `joint_2`)"),
    ],
)  # fmt: skip
def test_what_is_said_of_a_robot_that_its_arm_has_not(
    model: str, more: dict[str, Any], message: str
) -> None:
    d = Diagnostics()
    robot = {"model": model, "base": {}, "home": PUBLISHED[model][2], **more}
    load({"robots": {"r": robot}}, Path(), lambda *_: HERE, d)
    [error] = d.errors
    assert message in error.message


@pytest.mark.bullet
@pytest.mark.parametrize("name", NEW)
def test_pybullet_puts_the_tool_where_we_do_and_links_keep_apart_at_home(name: str) -> None:
    c = cell(name)
    robot = c.robots[0]
    backend = BulletBackend(c, looks=False)
    verdict = Monitor(c, backend).check(0.0, {"r": np.array(robot.home)})
    for q in positions(robot.kinematics, 10):
        backend.set_joints("r", q)
        ours = robot.T_world_base @ robot.kinematics.forward(q)
        assert max(difference(backend.tcp("r"), ours)) < 2e-6
    backend.close()
    assert verdict.fault is None, verdict.fault
    assert not verdict.warnings, verdict.warnings
    assert pose_of(robot.T_world_base).z == pytest.approx(0.2)


@pytest.mark.bullet
@pytest.mark.parametrize("name", NEW)
def test_most_of_the_reach_is_free_of_the_arm_itself(name: str) -> None:
    d = Diagnostics()
    robot = {"model": name, "base": {}, "home": PUBLISHED[name][2]}
    c = load({"robots": {"r": robot}, "scene": {"floor": False}}, Path(), lambda *_: HERE, d)
    assert c is not None
    backend = BulletBackend(c, looks=False)
    monitor = Monitor(c, backend)
    q = [x for x in positions(c.robots[0].kinematics, 50) if c.robots[0].arm.margins(x).min() >= 0]
    free = [monitor.check(float(i), {"r": x}).fault is None for i, x in enumerate(q)]
    backend.close()
    assert sum(free) > 0.6 * len(free)


def test_where_flanges_come_is_as_the_manual_says(root: Path) -> None:
    manual = (root / "docs/robots.md").read_text()
    rows = {
        "cobra_s600": "| `cobra_s600` | 0.163 to 0.600 from the middle, ",
        "gantry_3000": "| `gantry_3000` | x 0 to 3, y -1 to 1 | 0.55 to 1.75 |",
    }
    for name, row in rows.items():
        assert row in manual
        robot = cell(name).robots[0]
        arm, kinematics = robot.arm, robot.kinematics
        ends = np.array([*itertools.product(*zip(arm.lower, arm.upper, strict=True))])
        places = np.array([kinematics.forward(q)[:3, 3] for q in ends])
        low, high = places.min(axis=0), places.max(axis=0)
        if name == "gantry_3000":
            assert np.allclose([low, high], [(0.0, -1.0, 0.55), (3.0, 1.0, 1.75)])
            continue
        assert np.allclose([low[2], high[2]], [0.177, 0.387])
        assert np.degrees(arm.upper[0]) == pytest.approx(105.0)
        bent = np.hypot(*places[:, :2].T)
        straight = kinematics.forward(np.zeros(4))[0, 3]
        assert (bent.min().round(3), round(float(straight), 3)) == (0.163, 0.6)


def pose_out_of_reach(name: str, pose: Pose) -> str:
    """What is said of a pose that the arm does not reach, in its own base."""
    with pytest.raises(MotionFault) as found:
        executor(name).begin(MoveJoint(pose), 0.0)
    return found.value.message


@pytest.mark.parametrize(
    ("name", "pose", "limit"),
    [
        # The links of the SCARA are 325 and 275 mm long, and its tool hangs down wherever it is.
        (
            "cobra_s600",
            Pose(0.8, 0.0, 0.2, math.pi, 0.0, 0.0),
            "with the tool turned so: at most 6",
        ),
        (
            "cobra_s600",
            Pose(0.03, 0.0, 0.2, math.pi, 0.0, 0.0),
            "with the tool turned so: at least 50 mm)",
        ),
        (
            "lrmate200id",
            Pose(5.0, 0.0, 0.4, 0.0, 0.5 * math.pi, 0.0),
            "with the tool turned so: at most ",
        ),
    ],
)
def test_out_of_reach_says_how_far_the_arm_reaches(name: str, pose: Pose, limit: str) -> None:
    said = pose_out_of_reach(name, pose)
    assert "the pose is out of reach: " in said
    assert limit in said


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("cobra_s600", ", elbow 5.7 deg from straight"),
        ("gantry_3000", ""),
        ("iiwa14_r820", ", elbow 5.7 deg, wrist 11.5 deg from straight"),
        ("lrmate200id", ", elbow 5.7 deg, wrist 11.5 deg from straight"),
    ],
)
def test_only_what_an_arm_has_is_straight(name: str, told: str) -> None:
    """A SCARA has no wrist, a gantry not even an elbow."""
    assert kinematics(name).straightness(0.1, 0.2) == told


def test_a_pose_that_is_inside_the_limits_with_the_tool_turned() -> None:
    """It is said by how much, and which `rz` that is; with it the arm goes there."""
    arm = executor("iiwa14_r820")
    with pytest.raises(MotionFault) as caught:
        begin(arm, MoveJoint(Pose(0.6, 0.0, 0.3, math.pi, 0.0, 0.0)))
    assert caught.value.kind == "joint-limit"
    assert (
        "another `arm_angle` may do; with the tool turned by 15 deg about its axis (rz = -15) "
        "the pose is inside the limits"
    ) in str(caught.value)
    begin(arm, MoveJoint(Pose(0.6, 0.0, 0.3, math.pi, 0.0, math.radians(-15.0))))
