"""Straight wrists: all joint positions are found, and lines go on through them, begin and end there, or are refused.

The second solver is Newton's method on the forward kinematics alone: it knows of no branches and no wrists.
"""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.robot_cells import arm_kinematics
from helpers.thorough import amount
from pn2code.robot.commands import Pose
from pn2code.robot.motion import plan_lin
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.time_law import MotionLimits
from pn2code.robot.transforms import difference, matrix_of

MODELS = (
    "kr210_r2700",
    "kr120_r2500",
    "irb6700_200_260",
    "gp25",
    "tx2_90",
    "lrmate200id",
    "iiwa14_r820",
)
TURN = 2.0 * math.pi


@cache
def known(model):
    return arm_kinematics(model, None)


def limits_of(k):
    ones = np.ones(len(k.arm.lower))
    return MotionLimits(
        velocity=k.arm.velocity, acceleration=4.0 * ones, jerk=20.0 * ones, axis_velocity=k.arm.velocity,
        linear_velocity=0.2, linear_acceleration=0.5, linear_jerk=5.0, angular_velocity=0.5,
    )  # fmt: skip


def planned(k, q, move, swivel=None):
    start = k.forward(q)
    return plan_lin(k, q, start, start @ matrix_of(move), limits_of(k), swivel=swivel)


def newton(k, q, target, most=1.0):
    """A joint position near q that puts the TCP there, by steps along the Jacobian."""
    q = np.array(q)
    for _ in range(30):
        error = k._error(q[None], target[None])[0]
        if np.abs(error).max() < 1e-11:
            return q
        step = np.linalg.pinv(k.jacobian(q), rcond=1e-6) @ error
        q = q + np.clip(step, -most, most)
    return q if np.abs(k._error(q[None], target[None])).max() < 1e-8 else None


def apart(a, b):
    return np.abs((a - b + math.pi) % TURN - math.pi)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("bend", [0.0, 1e-9, 1e-8])
def test_all_arms_are_found_whatever_rounding_makes_of_the_bend(model, bend):
    """Each position of axes 1 to 3 (of seven axes 1 to 4), where half of them had none."""
    k, random = known(model), np.random.default_rng(7)
    first, _ = k.wrist_axes
    for _ in range(12):
        q = random.uniform(np.maximum(k.arm.lower, -2.5), np.minimum(k.arm.upper, 2.5))
        q[first + 1] = bend
        angle = k.arm_angle_of(q)
        rows = k.all_branches(k.forward(q)[None], angle)[0]
        there = rows[~np.isnan(rows[:, 0])]
        off = apart(there, q)[:, :first].max(axis=1)
        assert off.min() < 1e-6
        assert max(max(difference(k.forward(row), k.forward(q))) for row in there) < 1e-9
        assert k.branch_of(q).index in [
            i for i, r in enumerate(rows) if apart(r, q)[:first].max() < 1e-6
        ]


@pytest.mark.parametrize("model", [m for m in MODELS if m != "iiwa14_r820"])
def test_newton_finds_no_arm_that_the_closed_form_has_not(model):
    k, random = known(model), np.random.default_rng(11)
    compared = 0
    for _ in range(12):
        q = random.uniform(np.maximum(k.arm.lower, -2.5), np.minimum(k.arm.upper, 2.5))
        q[4] = 0.0
        target = k.forward(q)
        found = newton(k, q + random.normal(0.0, 0.8, 6), target, most=0.3)
        if found is None or k.conditioning(found).elbow < 0.05:
            continue
        rows = k.all_branches(target[None])[0]
        off = np.where(np.isnan(rows), np.inf, apart(rows, found))[:, :3].max(axis=1)
        assert off.min() < 1e-5
        compared += 1
    assert compared >= 3


def in_plane(k, first, bend, random):
    """A joint position in general, whose wrist bends in the plane of the forearm."""
    for _ in range(100):
        q = random.uniform(0.5 * np.maximum(k.arm.lower, -2.0), 0.5 * np.minimum(k.arm.upper, 2.0))
        q[first], q[first + 1] = 0.0, bend
        if first == 4:
            q[0] = q[2] = 0.0
        seen = k.conditioning(q)
        if 0.6 < seen.elbow < 2.5 and k.arm.margins(q[None]).min() > 0.5:
            return q
    raise AssertionError("no such position")


@pytest.mark.parametrize("model", MODELS)
def test_lines_in_the_plane_of_the_arm_go_through_begin_and_end_straight(model):
    k, random = known(model), np.random.default_rng(5)
    first, _ = k.wrist_axes
    for bend, turned in ((0.15, 0.3), (-0.15, 0.3), (0.0, 0.2), (0.0, -0.2), (0.15, 0.15)):
        q = in_plane(k, first, bend, random)
        q[first + 2] = 0.0
        # The axis in the tool about which it bends: that of axis 5, seen from the TCP.
        axis = k.forward(q)[:3, :3].T @ k.axes_of(k.link_frames(q[None]))[0, first + 1]
        turn = axis * (-turned if bend > 0 else turned)
        target = k.forward(q).copy()
        target[:3, :3] = target[:3, :3] @ rotation(turn)
        try:
            move = plan_lin(k, q, k.forward(q), target, limits_of(k), swivel=swivel_for(k, q))
        except MotionFault as fault:
            assert fault.kind in ("joint-limit", "unreachable"), str(fault)
            continue
        check_way(k, q, move)
        path = move.sample(np.linspace(0.0, move.duration, 60))
        assert np.abs(path[:, first] - q[first]).max() < 1e-5
        if first == 4:  # with seven axes Newton's method leaves the arm angle
            continue
        follow = np.array(q)
        for pose in move.line.at(move.way(np.linspace(0.0, move.duration, 25))):
            follow = newton(k, follow, pose)
            assert follow is not None
        assert np.abs(follow - path[-1]).max() < 1e-5


def rotation(vector):
    angle = float(np.linalg.norm(vector))
    x, y, z = vector / angle
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew


def swivel_for(k, q):
    angle = k.arm_angle_of(q)
    return None if angle is None else (angle, 0.0)


def check_way(k, q, move):
    """From the arm's own position, on the line, and never faster than its axes."""
    times = np.linspace(0.0, move.duration, 301)
    path = move.sample(times)
    assert np.abs(path[0] - q).max() < 1e-5
    poses = move.line.at(move.way(times))
    assert np.abs(k._error(path, poses)).max() < 2e-9
    speed = np.abs(np.diff(path, axis=0)) / np.diff(times)[:, None] / k.arm.velocity
    assert speed.max() < 1.01
    said = np.array([move.qd(float(t)) for t in times[::15]])
    assert np.abs(said - np.gradient(path, times, axis=0)[::15])[1:-1].max() < 0.1


@settings(max_examples=amount(5, 10), deadline=None)
@given(
    st.sampled_from(MODELS),
    st.integers(0, 2**32),
    st.sampled_from([0.0, 1e-9, 1e-7, 1e-5, 1e-3]),
    st.sampled_from([0.0, 0.4, -1.2, math.pi / 2, math.pi]),
)
def test_a_line_from_or_near_a_straight_wrist_never_leaps(model, seed, bend, turned):
    """Whatever is planned begins where the arm is, is on the line, and keeps the speeds of the axes."""
    k, random = known(model), np.random.default_rng(seed)
    first, _ = k.wrist_axes
    q = in_plane(k, first, bend, random)
    q[first] = turned if abs(turned) < k.arm.upper[first] else 0.0
    move = Pose(
        *random.uniform(-0.05, 0.05, 3), *(random.uniform(-0.3, 0.3, 3) * random.integers(0, 2, 3))
    )
    try:
        path = planned(k, q, move, swivel_for(k, q))
    except MotionFault as fault:
        assert fault.kind in ("unreachable", "joint-limit", "singularity", "axis-speed")
        return
    check_way(k, q, path)


@pytest.mark.parametrize("model", MODELS)
def test_a_tool_that_turns_about_a_straight_wrist_turns_with_axis_6_alone(model):
    k, random = known(model), np.random.default_rng(3)
    first, _ = k.wrist_axes
    q = in_plane(k, first, 0.0, random)
    q[first] = 0.7
    frames = k.link_frames(q[None])
    axis = k.forward(q)[:3, :3].T @ k.axes_of(frames)[0, first + 2]
    target = k.forward(q).copy()
    target[:3, :3] = target[:3, :3] @ rotation(0.4 * axis)
    move = plan_lin(k, q, k.forward(q), target, limits_of(k), swivel=swivel_for(k, q))
    if first == 3 and k.wrist_in_flange is not None and np.hypot(*k.wrist_in_flange[0][:2]) > 1e-9:
        return  # the TCP is beside the axis, so the wrist goes elsewhere
    check_way(k, q, move)
    end = move.q(move.duration)
    assert np.abs((end - q)[[i for i in range(len(q)) if i != first + 2]]).max() < 1e-6
    assert abs(end[first + 2] - q[first + 2]) == pytest.approx(0.4, abs=1e-6)


@pytest.mark.parametrize("off", [1e-7, 1e-5, 1e-3])
def test_a_line_that_passes_slightly_beside_a_straight_wrist_is_refused(off):
    """Axis 4 would have to turn half way round meanwhile, however small the gap is."""
    k = known("kr210_r2700")
    q = np.array([0.0, -1.4, 1.4, off, 0.14, 0.0])
    target = k.forward(np.array([0.0, -1.4, 1.4, -off, -0.14, 0.0]))
    with pytest.raises(MotionFault, match="passes a singularity") as told:
        plan_lin(k, q, k.forward(q), target, limits_of(k))
    assert told.value.kind == "singularity"


def test_the_message_says_how_axis_4_stands_on_the_way():
    k = known("kr210_r2700")
    q = np.array([0.0, -1.4, 1.7, 0.5, 0.0, 0.2])
    with pytest.raises(
        MotionFault, match="leap by 28.6 deg; on this way it stands at 0.0 or 180.0 deg there"
    ):
        planned(k, q, Pose(0.0, 0.0, 0.02, 0.0, 0.0, 0.0))
    q[3] = math.radians(0.0)
    check_way(k, q, planned(k, q, Pose(0.0, 0.0, 0.02, 0.0, 0.0, 0.0)))


def test_a_line_goes_to_a_straight_wrist_and_back_again():
    """Axis 4 ends where the way has it, so that the way back begins there."""
    k = known("gp25")
    q = np.array([0.3, 0.2, 0.1, 0.6, 0.3, -0.4])
    straight = np.array([0.3, 0.2, 0.1, 0.6, 0.0, -0.4])
    there = plan_lin(k, q, k.forward(q), k.forward(straight), limits_of(k))
    check_way(k, q, there)
    end = there.q(there.duration)
    back = plan_lin(k, end, k.forward(straight), k.forward(q), limits_of(k))
    check_way(k, end, back)
    assert np.abs(back.q(back.duration) - q).max() < 1e-5
