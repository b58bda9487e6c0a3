"""Laws of transforms, kinematics and motions over random values."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers.robot_cells import arm_kinematics, riveting_cell
from helpers.thorough import amount
from pn2code.robot.commands import Pose
from pn2code.robot.motion import plan_lin, plan_ptp
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import (
    difference,
    inverse,
    matrix_of,
    pose_of,
    rotation_about,
    rotation_vector,
    translation,
)

lengths = st.floats(-10.0, 10.0, allow_nan=False)
angles = st.floats(-math.pi, math.pi, allow_nan=False)
poses = st.builds(Pose, lengths, lengths, lengths, angles, angles, angles)
unit = st.floats(0.0, 1.0)


@given(poses)
def test_a_pose_and_its_matrix_say_the_same(p):
    t = matrix_of(p)
    assert np.allclose(t[:3, :3] @ t[:3, :3].T, np.eye(3), atol=1e-14)
    assert np.linalg.det(t[:3, :3]) > 0
    again = pose_of(t)
    assert abs(again.ry) <= math.pi / 2
    # Angles within a nanoradian of gimbal lock lose half the digits.
    assert np.allclose(matrix_of(again), t, atol=3e-9)


@given(poses, poses)
def test_inverse_undoes(a, b):
    m, n = matrix_of(a), matrix_of(b)
    assert np.allclose(inverse(m @ n), inverse(n) @ inverse(m), atol=1e-13)


@given(poses)
def test_rotation_vector_turns_back(p):
    r = matrix_of(p)[:3, :3]
    v = rotation_vector(r)
    size = float(np.linalg.norm(v))
    assert size <= math.pi + 1e-9
    back = rotation_about(v / size, size) if size > 1e-12 else np.eye(3)
    assert np.allclose(back, r, atol=1e-7)


@st.composite
def positions(draw):
    k = arm_kinematics()
    return k.arm.lower + np.array([draw(unit) for _ in range(6)]) * (k.arm.upper - k.arm.lower)


@settings(max_examples=amount(30, 60), deadline=None)
@given(positions())
def test_every_solution_is_one(q):
    k = arm_kinematics()
    target = k.forward(q)
    for s in k.inverse(target, q):
        away, turn = difference(k.forward(s.q), target)
        assert max(away, turn) < 2e-9
        assert k.limit_margin(s.q)[0] >= -1e-8


@settings(max_examples=amount(20, 40), deadline=None)
@given(positions(), positions(), st.floats(0.05, 1.0))
def test_joint_moves_keep_their_limits(a, b, speed):
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    limits = robot.limits(cell.motion)
    move = plan_ptp(robot.kinematics, a, b, limits, speed)
    times = np.linspace(0.0, move.duration, 60)
    path = move.sample(times)
    assert np.array_equal(path[0], a)
    assert np.array_equal(path[-1], b)
    speeds = np.array([move.qd(t) for t in times])
    assert (np.abs(speeds) <= limits.velocity * speed * (1 + 1e-9)).all()
    # All axes in proportion: the path is a straight line in joint space, inside the limits' box.
    way = (path - a) @ (b - a) / max(float((b - a) @ (b - a)), 1e-30)
    if np.abs(b - a).max() > 1e-6:
        assert np.allclose(path, a + way[:, None] * (b - a), atol=1e-6)


@settings(max_examples=amount(20, 40), deadline=None)
@given(
    positions(), st.tuples(*[st.floats(-0.15, 0.15)] * 3), st.tuples(*[st.floats(-0.4, 0.4)] * 3)
)
def test_linear_moves_are_on_the_line_or_refused(q, shift, turn):
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    k = robot.kinematics
    start = k.forward(q)
    target = start @ matrix_of(Pose(*shift, *turn))
    try:
        move = plan_lin(k, q, start, target, robot.limits(cell.motion))
    except MotionFault as fault:
        assert fault.kind in ("unreachable", "joint-limit", "singularity", "axis-speed")
        return
    path = move.sample(np.linspace(0.0, move.duration, 23))
    line = target[:3, 3] - start[:3, 3]
    for now in k.forward_many(path):
        gone = now[:3, 3] - start[:3, 3]
        along = gone @ line / max(float(line @ line), 1e-30)
        assert np.linalg.norm(gone - along * line) < 2e-9
    assert max(difference(k.forward(path[-1]), target)) < 2e-9
    assert np.abs(path[0] - q).max() < 1e-5


@settings(max_examples=amount(20, 40), deadline=None)
@given(positions(), st.sampled_from(range(3)), st.floats(0.05, 0.4))
def test_no_line_leaps_where_it_begins(q, axis, angle):
    """With a straight wrist the axes before and after it are only known together."""
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    k = robot.kinematics
    q[4] = 0.0
    start = k.forward(q)
    turn = [angle if i == axis else 0.0 for i in range(3)]
    try:
        move = plan_lin(
            k, q, start, start @ matrix_of(Pose(0, 0, 0, *turn)), robot.limits(cell.motion)
        )
    except MotionFault as fault:
        assert fault.kind in ("unreachable", "joint-limit", "singularity", "axis-speed")
        return
    path = move.sample(np.linspace(0.0, move.duration, 23))
    assert np.abs(path[0] - q).max() < 1e-5
    assert not np.isnan(path).any()


@given(lengths, lengths, lengths)
def test_translations_add(x, y, z):
    both = translation(x, y, z) @ translation(-x, -y, -z)
    assert np.array_equal(both, np.eye(4))
