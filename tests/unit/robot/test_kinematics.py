"""Forward and inverse kinematics, branches, conditioning; models that have no closed form."""

import math
from pathlib import Path

import numpy as np
import pytest

from helpers.robot_cells import arm_kinematics, pose_mm, riveting_cell
from pn2code.diagnostics import NOWHERE, Diagnostics
from pn2code.robot.kinematics import BRANCH_NAMES, BRANCHES, Branch, Kinematics
from pn2code.robot.model import MODELS, find_arm, find_tool
from pn2code.robot.transforms import difference, inverse, matrix_of

EXACT = 1e-10  # m and rad: the inverse against the forward kinematics
MODELS_AND_TOOLS = [("kr210_r2700", "drill_riveter"), ("kr120_r2500", "counterpoint")]


@pytest.fixture(params=MODELS_AND_TOOLS, ids=lambda p: p[0])
def k(request):
    return arm_kinematics(*request.param)


def random_positions(k, count, seed=1):
    return np.random.default_rng(seed).uniform(k.arm.lower, k.arm.upper, (count, 6))


def test_stretched_arm_reaches_as_far_as_the_data_sheet_says():
    bare = arm_kinematics("kr210_r2700", None)
    t = bare.forward(np.zeros(6))
    assert t[:3, 3] == pytest.approx([0.35 + 1.15 + 1.2 + 0.215, 0.0, 0.675 - 0.041])
    # The flange's z looks forward, x down.
    assert np.allclose(t[:3, :3], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]], atol=1e-15)


def test_tool_centre_point_is_half_a_metre_from_the_flange():
    t = arm_kinematics().forward(np.zeros(6))
    assert t[0, 3] == pytest.approx(0.35 + 1.15 + 1.2 + 0.215 + 0.5)


def test_axes_turn_as_published():
    """A1 and A4, A6 are left-handed about z and x; A2, A3, A5 tilt downwards when positive."""
    k = arm_kinematics("kr210_r2700", None)
    assert k.forward([0.1, 0, 0, 0, 0, 0])[1, 3] < 0
    for axis in (1, 2, 4):
        q = np.zeros(6)
        q[axis] = 0.1
        assert k.forward(q)[2, 3] < 0.675 - 0.041


def test_every_branch_reaches_the_pose(k):
    q = random_positions(k, 300)
    targets = k.forward_many(q)
    rows = k.all_branches(targets)
    there = ~np.isnan(rows[:, :, 0])
    assert there.sum(axis=1).min() >= 4
    for i, b in np.argwhere(there):
        away, turn = difference(k.forward(rows[i, b]), targets[i])
        assert max(away, turn) < EXACT


def test_one_branch_is_the_position_it_came_from(k):
    for q in random_positions(k, 100, seed=2):
        found = [s for s in k.inverse(k.forward(q), q) if np.abs(s.q - q).max() < 1e-7]
        assert len(found) == 1
        assert found[0].branch == k.branch_of(q)


def test_branch_names_mean_what_they_say(k):
    for q in random_positions(k, 60, seed=3):
        for s in k.inverse(k.forward(q)):
            frames = k.joint_frames(s.q)
            p1, p2, p3, wrist = (frames[i][:3, 3] for i in (0, 1, 2, 4))
            forward = (p2 - p1) * [1, 1, 0]
            assert ((wrist - p1) @ forward > 0) == (s.branch.shoulder == "front")
            side = np.cross([0, 0, 1], forward)
            assert (np.cross(wrist - p2, p3 - p2) @ side < 0) == (s.branch.elbow == "up")
            assert (math.sin(s.q[4]) > 0) == (s.branch.wrist == "plus")


def test_solutions_are_inside_the_limits_and_near_the_reference_turn():
    k = arm_kinematics()
    q = np.radians([10, -90, 90, 300, 40, -340])
    s = k.nearest(k.forward(q), q)
    assert s is not None
    assert s.q == pytest.approx(q, abs=1e-9)
    for other in k.inverse(k.forward(q), q):
        assert (other.q >= k.arm.lower - 1e-9).all()
        assert (other.q <= k.arm.upper + 1e-9).all()


def test_nearest_is_the_one_reached_first_and_a_branch_can_be_demanded():
    k = arm_kinematics()
    start = np.radians([0, -110, 110, 0, 45, 90])
    target = k.forward(np.radians([20, -90, 80, 10, 30, 60]))
    chosen = k.nearest(target, start)
    times = [(np.abs(s.q - start) / k.arm.velocity).max() for s in k.inverse(target, start)]
    assert len(times) > 1
    assert (np.abs(chosen.q - start) / k.arm.velocity).max() == pytest.approx(min(times))
    flipped = k.nearest(target, start, Branch(chosen.branch.index ^ 4))
    assert flipped.branch.wrist != chosen.branch.wrist
    assert difference(k.forward(flipped.q), target)[0] < EXACT


def test_out_of_reach_has_no_solution():
    k = arm_kinematics()
    far = matrix_of(pose_mm(4000, 0, 1000))
    assert k.inverse(far) == ()
    assert k.nearest(far, np.zeros(6)) is None


@pytest.mark.parametrize("wrist", [0.0, 1e-9, 1e-6, 1e-4])
def test_exact_near_a_straight_wrist(wrist):
    k = arm_kinematics()
    q = np.array([0.3, -1.5, 1.2, 0.4, wrist, 0.2])
    target = k.forward(q)
    solutions = k.inverse(target, q)
    assert solutions
    for s in solutions:
        assert max(difference(k.forward(s.q), target)) < 1e-9


def test_jacobian_is_the_derivative(k):
    h = 1e-6
    for q in random_positions(k, 20, seed=4):
        jacobian = k.jacobian(q)
        for axis in range(6):
            step = np.zeros(6)
            step[axis] = h
            a, b = k.forward(q - step), k.forward(q + step)
            assert (b - a)[:3, 3] / (2 * h) == pytest.approx(jacobian[:3, axis], abs=1e-7)
            turn = (b[:3, :3] @ a[:3, :3].T - np.eye(3)) / (2 * h)
            spin = [turn[2, 1], turn[0, 2], turn[1, 0]]
            assert spin == pytest.approx(jacobian[3:, axis], abs=1e-5)


def test_states_agree_with_their_parts(k):
    positions = random_positions(k, 3)
    for q, t, c in zip(positions, *k.states(positions), strict=True):
        assert t == pytest.approx(k.forward(q), abs=1e-12)
        assert c.condition == pytest.approx(k.conditioning(q).condition, rel=1e-9)


PUBLISHED = {
    # (layout, robot): condition numbers over the seven rivets, from the study of the cell.
    ("paper", "robot2"): [13.9, 14.2, 15.2, 16.9, 20.0, 26.9, 102],
    ("good", "robot2"): [8.8, 8.6, 8.4, 8.4, 8.4, 8.6, 8.8],
    ("good", "robot1"): [10.3, 10.7, 11.1, 11.2, 11.1, 10.7, 10.3],
}


@pytest.mark.parametrize("case", PUBLISHED, ids=" ".join)
def test_conditioning_over_the_rivets(case):
    layout, name = case
    robot = riveting_cell(layout).robot(name)
    q = np.array(robot.home)
    found = []
    for i in range(7):
        angle = -105 if name == "robot1" else 75
        pose = matrix_of(pose_mm(5750 + i * 1000 / 6, 5898.8, 2135.05, angle))
        s = robot.kinematics.nearest(inverse(robot.T_world_base) @ pose, q)
        q = s.q
        found.append(robot.kinematics.conditioning(q))
    assert [c.condition for c in found] == pytest.approx(PUBLISHED[case], rel=0.006)
    if layout == "paper":
        assert found[-1].sigma_min == pytest.approx(0.035, abs=0.0005)
        assert math.degrees(found[-1].elbow) == pytest.approx(7.9, abs=0.05)


def test_branches_have_eight_different_names():
    assert len(BRANCH_NAMES) == len(BRANCHES) == 8
    assert BRANCH_NAMES["front/up/plus"] == Branch(0)


# Models of one's own


def test_unknown_model_and_tool_are_reported_with_a_suggestion():
    d = Diagnostics()
    assert find_arm("kr210_r270", Path(), NOWHERE, d) is None
    assert find_tool("drill_rivet", Path(), NOWHERE, d) is None
    assert [e.code for e in d.errors] == ["robot-model", "robot-tool"]
    assert "did you mean `kr210_r2700`?" in d.errors[0].hint
    assert "did you mean `drill_riveter`?" in d.errors[1].hint


def changed(tmp_path, old, new, count=1):
    text = (MODELS / "kr210_r2700.urdf").read_text()
    assert old in text
    path = tmp_path / "arm.urdf"
    path.write_text(text.replace(old, new, count))
    return path


def own_arm(tmp_path, d):
    return find_arm("arm.urdf", tmp_path, NOWHERE, d)


def test_own_arm_by_path_with_other_lengths_and_zero(tmp_path):
    """Half-size links, an offset shoulder, the forearm bent at zero: parameters follow the URDF."""
    changed(tmp_path, 'xyz="1.15 0 0" rpy="0 0 0"', 'xyz="0.6 0.02 0.1" rpy="0 0.7 0"')
    d = Diagnostics()
    arm = own_arm(tmp_path, d)
    k = Kinematics.of(arm, None, NOWHERE, d)
    assert k is not None, list(d)
    for q in random_positions(k, 50):
        t = k.forward(q)
        near = min(np.abs(s.q - q).max() for s in k.inverse(t, q))
        assert near < 1e-6


def test_arm_without_spherical_wrist_is_unsupported(tmp_path):
    old = 'name="joint_6" type="revolute"><origin xyz="0 0 0"'
    changed(tmp_path, old, old.replace("0 0 0", "0 0.1 0"))
    d = Diagnostics()
    assert Kinematics.of(own_arm(tmp_path, d), None, NOWHERE, d) is None
    [error] = d.errors
    assert error.code == "unsupported-robot-kinematics"
    assert "axes 4, 5 and 6 do not meet in one point (axis 6 is 0.1 m off)" in error.message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<robot name", "<robo name", "not XML"),
        ('type="revolute"', 'type="floating"', "type `floating`, which is not supported"),
        ('<parent link="base_link"/>', '<parent link="base"/>', "unknown link `base`"),
        ('<axis xyz="0 0 -1"/>', '<axis xyz="0 0 0"/>', "axis of joint `joint_1` has length zero"),
        ('<axis xyz="0 0 -1"/>', '<axis xyz="0 0 one"/>', "3 numbers are expected"),
        ('type="revolute"', 'type="fixed"', "5 moving joints between `base_link` and `flange`"),
        ('velocity="2.', 'velocity="-2.', "a `velocity` above zero"),
    ],
)
def test_mistakes_in_a_urdf_are_reported(tmp_path, old, new, message):
    changed(tmp_path, old, new)
    d = Diagnostics()
    assert own_arm(tmp_path, d) is None
    [error] = d.errors
    assert error.code == "robot-urdf"
    assert message in error.message


def test_missing_files_are_reported(tmp_path):
    d = Diagnostics()
    assert find_arm("no.urdf", tmp_path, NOWHERE, d) is None
    assert "there is no file" in d.errors[0].message


def test_entities_in_a_urdf_are_not_expanded(tmp_path):
    bomb = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><robot name="&b;">'
    path = changed(tmp_path, '<robot name="kr210_r2700">', bomb)
    path.write_text(path.read_text())
    d = Diagnostics()
    own_arm(tmp_path, d)
    assert "aaaa" not in "".join(e.message for e in d)
