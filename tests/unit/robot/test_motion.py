"""Trajectories and the executor: exactness, limits, faults."""

import math
from dataclasses import replace

import numpy as np
import pytest

from helpers.robot_cells import arm_kinematics, pose_mm, riveting_cell, riveting_path
from pn2code.robot.commands import (
    Measure,
    MoveHome,
    MoveJoint,
    MoveLinear,
    ToolAction,
    Wait,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion import plan_lin, plan_ptp
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.tcp_path import Line
from pn2code.robot.time_law import Law
from pn2code.robot.trajectories import LinearTrajectory, Still
from pn2code.robot.transforms import difference, matrix_of

NANOMETRE = 1e-9  # m: 1e-6 mm, what is promised for poses and lines


@pytest.fixture
def robot():
    return riveting_cell("good").robot("robot1")


@pytest.fixture
def limits(robot):
    return robot.limits(riveting_cell("good").motion)


@pytest.fixture
def executor(robot):
    return RobotExecutor(robot, riveting_cell("good").motion)


START = np.radians([10.0, -100.0, 90.0, 20.0, 40.0, 60.0])


def test_joint_move_reaches_its_speed_and_not_more(robot, limits):
    target = START + np.radians([60, 0, 0, 0, 0, 30])
    move = plan_ptp(robot.kinematics, START, target, limits)
    times = np.linspace(0, move.duration, 400)
    speeds = np.array([move.qd(t) for t in times])
    assert speeds[:, 0].max() == pytest.approx(limits.velocity[0], rel=1e-3)
    numeric = np.gradient(move.sample(times), times, axis=0)
    assert np.allclose(numeric[5:-5], speeds[5:-5], atol=0.01)
    acceleration = np.gradient(speeds, times, axis=0)
    assert np.abs(acceleration).max() <= limits.acceleration[0] * 1.01


def test_half_speed_takes_longer_on_the_same_path(robot, limits):
    target = START + np.radians([60, 20, -30, 0, 10, 30])
    fast = plan_ptp(robot.kinematics, START, target, limits)
    slow = plan_ptp(robot.kinematics, START, target, limits, 0.25)
    assert slow.duration > 2 * fast.duration
    half = slow.q(slow.duration / 2)
    assert half == pytest.approx(fast.q(fast.duration / 2), abs=1e-9)


def test_joint_move_to_where_it_stands_takes_no_time(robot, limits):
    move = plan_ptp(robot.kinematics, START, START.copy(), limits)
    assert move.duration == 0.0
    assert np.array_equal(move.q(0.0), START)


@pytest.mark.parametrize("speed", [0.0, -1.0, 1.5, math.nan])
def test_senseless_speed_is_refused(robot, limits, speed):
    with pytest.raises(MotionFault, match="speed must be a fraction") as caught:
        plan_ptp(robot.kinematics, START, START + 0.1, limits, speed)
    assert caught.value.kind == "bad-command"


def test_joint_move_beyond_a_limit_is_refused(robot, limits):
    target = START.copy()
    target[1] = math.radians(-150)
    with pytest.raises(MotionFault) as caught:
        plan_ptp(robot.kinematics, START, target, limits)
    assert caught.value.kind == "joint-limit"
    assert "axis 2 (`joint_2`) would be at -150.00 deg, outside -140.00 .. -5.00" in str(
        caught.value
    )


def test_linear_move_is_on_the_line_and_turns_evenly(robot, limits):
    k = robot.kinematics
    start = k.forward(START)
    target = start @ matrix_of(pose_mm(30, -60, 120, 0, 12, 5))
    move = plan_lin(k, START, start, target, limits)
    line = Line(start, target)
    times = np.linspace(0, move.duration, 101)
    for t, now in zip(times, k.forward_many(move.sample(times)), strict=True):
        s = move.way(np.array([t]))
        away, turn = difference(now, line.at(s)[0])
        assert away < NANOMETRE
        assert turn < NANOMETRE
    assert max(difference(k.forward(move.q(move.duration)), target)) < NANOMETRE


def test_what_is_surely_slower_is_slower(robot, limits):
    k = robot.kinematics
    start = k.forward(START)
    move = plan_lin(k, START, start, start @ matrix_of(pose_mm(30, -60, 120, 0, 12, 5)), limits)
    most = np.abs(move.rates(move.grid, move.speeds, move.fractions)).max(axis=0)
    assert move.is_slower(most * 1.0001)
    assert not move.is_slower(most * 0.9999)
    assert not move.is_slower(most), "rounding decides"


def test_nothing_is_surely_slower_near_a_straight_wrist(robot, limits):
    k = robot.kinematics
    q = START.copy()
    q[4] = 1e-7
    start = k.forward(q)
    move = LinearTrajectory(
        k, Line(start, start @ matrix_of(pose_mm(0, 0, 1))), k.branch_of(q), Law(1.0, 1.0, 1.0), q
    )
    assert not move.is_slower(np.full(6, np.inf))


def test_linear_move_keeps_its_speed_limits(robot, limits):
    k = robot.kinematics
    start = k.forward(START)
    move = plan_lin(k, START, start, start @ matrix_of(pose_mm(0, 0, 200)), limits, 0.08)
    times = np.linspace(0, move.duration, 300)
    positions = k.forward_many(move.sample(times))[:, :3, 3]
    speeds = np.linalg.norm(np.diff(positions, axis=0), axis=1) / np.diff(times)
    assert speeds.max() == pytest.approx(0.08, rel=1e-6)
    assert speeds[0] < 0.01
    # qd agrees with q.
    t, h = 0.4 * move.duration, 1e-5
    assert (move.q(t + h) - move.q(t - h)) / (2 * h) == pytest.approx(move.qd(t), abs=1e-6)


def test_pure_turn_on_the_spot(robot, limits):
    k = robot.kinematics
    start = k.forward(START)
    move = plan_lin(k, START, start, start @ matrix_of(pose_mm(0, 0, 0, 0, 0, 40)), limits)
    assert move.duration > math.radians(40) / limits.angular_velocity
    middle = k.forward(move.q(move.duration / 2))
    away, turn = difference(start, middle)
    assert away < NANOMETRE
    assert math.degrees(turn) == pytest.approx(20.0, abs=1e-6)


def test_no_way_takes_no_time(robot, limits):
    start = robot.kinematics.forward(START)
    assert isinstance(plan_lin(robot.kinematics, START, start, start, limits), Still)


def fault_of(k, q, increment, limits, speed=None):
    start = k.forward(q)
    with pytest.raises(MotionFault) as caught:
        plan_lin(k, q, start, start @ matrix_of(increment), limits, speed)
    return caught.value


def test_line_out_of_reach(robot, limits):
    q = np.radians([0, -60, 60, 0, 30, 0])
    fault = fault_of(robot.kinematics, q, pose_mm(0, 0, 2500), limits, 0.5)
    assert fault.kind in ("unreachable", "singularity")
    assert fault.time is not None


def test_line_beyond_a_joint_limit(robot, limits):
    q = np.radians([0, -80, 80, 0, 118, 0])
    fault = fault_of(robot.kinematics, q, pose_mm(0, 0, 0, 0, 25, 0), limits)
    assert fault.kind == "joint-limit"
    assert "axis 5" in str(fault)


def test_line_through_a_straight_wrist_is_a_singularity(robot, limits):
    """Axis 4 would have to turn half way round while the wrist passes straight, slightly beside it."""
    k = robot.kinematics
    q = np.radians([0, -80, 80, 0.5, 8, 0])
    fault = fault_of(k, q, pose_mm(0, 0, 0, 1.0, -16, 0), limits)
    assert fault.kind == "singularity"
    assert "passes a singularity (condition number" in str(fault)
    assert "axis 4" in str(fault) or "axis 6" in str(fault)


def test_line_exactly_through_a_straight_wrist_goes_on_with_axis_4_as_it_was(robot, limits):
    k, q = robot.kinematics, np.radians([0, -80, 80, 0, 8, 0])
    start = k.forward(q)
    move = plan_lin(k, q, start, start @ matrix_of(pose_mm(0, 0, 0, 0, -16, 0)), limits)
    path = move.sample(np.linspace(0.0, move.duration, 200))
    assert np.abs(path[:, [0, 3, 5]]).max() < 1e-6
    assert path[0, 4] > 0.0 > path[-1, 4]


@pytest.mark.parametrize("turned", [-90, -60, -30, 30, 60, 90])
def test_a_line_that_begins_with_a_straight_wrist_is_told_so(robot, limits, turned):
    """Not that an axis would leave its limits, on a branch on which the arm is not at all."""
    q = np.radians([0, -80, 100, turned, 0, 0])
    fault = fault_of(robot.kinematics, q, pose_mm(0, 0, 10), limits)
    assert fault.kind == "singularity"
    assert "begins in a singularity" in str(fault) and "would have to leap by" in str(fault)
    assert fault.time == 0.0


def test_too_fast_a_line_is_not_called_a_singularity(robot, limits):
    fast = replace(limits, linear_acceleration=100.0, linear_jerk=10000.0)
    fault = fault_of(robot.kinematics, START, pose_mm(200, 0, 0), fast, 6.0)
    assert fault.kind == "axis-speed"
    assert "would have to turn at" in str(fault)


# Executor


def test_commands_end_where_they_were_sent(executor):
    target = pose_mm(5750, 5802.2, 2160.9, -105)
    motion = executor.begin(MoveJoint(target), 10.0)
    assert (motion.kind, motion.began) == ("ptp", 10.0)
    assert motion.ends == 10.0 + motion.duration
    executor.finish()
    reached = executor.robot.T_world_base @ executor.robot.kinematics.forward(executor.q)
    assert max(difference(reached, matrix_of(target))) < NANOMETRE
    motion = executor.begin(MoveLinear(pose_mm(0, 0, 50), "tool"), motion.ends)
    executor.finish()
    goal = matrix_of(target) @ matrix_of(pose_mm(0, 0, 50))
    assert max(difference(matrix_of(executor.pose), goal)) < NANOMETRE
    executor.begin(MoveLinear(target), motion.ends)
    executor.finish()
    executor.begin(MoveHome(), 20.0)
    executor.finish()
    assert executor.q == pytest.approx(executor.robot.home, abs=1e-12)


def test_standing_commands(executor):
    nominal = pose_mm(1, 2, 3, 4, 5, 6)
    for command, kind, seconds in (
        (ToolAction("drill", 3.0), "tool", 3.0),
        (Wait(0.25), "wait", 0.25),
        (Measure(nominal), "measure", 1.0),
    ):
        motion = executor.begin(command, 0.0)
        assert (motion.kind, motion.duration) == (kind, seconds)
        assert np.array_equal(motion.q(0.1), executor.q)
        assert motion.result == (nominal if kind == "measure" else None)
        assert motion.start == motion.target
        executor.finish()


def test_faults_name_robot_and_pose_and_leave_the_robot_standing(executor):
    before = executor.q.copy()
    with pytest.raises(MotionFault) as caught:
        executor.begin(MoveJoint(pose_mm(9000, 0, 500)), 0.0)
    fault = caught.value
    assert (fault.kind, fault.robot) == ("unreachable", "robot1")
    assert str(fault).startswith("robot `robot1`: the pose is out of reach: ")
    assert "at TCP pose (9000.00, 0.00, 500.00 mm; 0.00, 0.00, 0.00 deg)" in str(fault)
    assert executor.motion is None
    assert np.array_equal(executor.q, before)


def test_pose_reachable_only_beyond_the_limits(executor):
    behind = executor.robot.T_world_base @ executor.robot.kinematics.forward(
        np.radians([0, -3, 10, 0, 45, 0])
    )
    from pn2code.robot.transforms import pose_of

    with pytest.raises(MotionFault) as caught:
        executor.begin(MoveJoint(pose_of(behind)), 0.0)
    assert caught.value.kind == "joint-limit"
    assert "axis 2" in str(caught.value)


@pytest.mark.parametrize(
    "command",
    [
        MoveJoint(pose_mm(math.nan, 0, 0)),
        MoveLinear(pose_mm(0, math.inf, 0), "tool"),
        MoveLinear(pose_mm(0, 0, 1), "tool", speed=0.0),
        Wait(-1.0),
        ToolAction("drill", math.nan),
    ],
)
def test_senseless_commands_are_refused(executor, command):
    with pytest.raises(MotionFault) as caught:
        executor.begin(command, 0.0)
    assert caught.value.kind == "bad-command"
    assert caught.value.robot == "robot1"


def test_a_stopped_robot_stands_where_it_was(executor):
    motion = executor.begin(MoveJoint(pose_mm(5750, 5802.2, 2160.9, -105)), 0.0)
    executor.stop(0.4)
    assert np.array_equal(executor.q, motion.q(0.4))
    executor.begin(MoveHome(), 1.0)


def test_one_motion_at_a_time(executor):
    executor.begin(Wait(1.0), 0.0)
    with pytest.raises(RuntimeError):
        executor.begin(Wait(1.0), 0.5)
    executor.finish()
    with pytest.raises(RuntimeError):
        executor.finish()


def test_two_runs_give_the_same_numbers():
    cell = riveting_cell("paper")
    runs = []
    for _ in range(2):
        e = RobotExecutor(cell.robot("robot2"), cell.motion)
        numbers = []
        for _, command in riveting_path(2):
            motion = e.begin(command, 0.0)
            numbers += motion.sample(np.linspace(0, motion.duration, 5)).ravel().tolist()
            e.finish()
        runs.append(numbers)
    assert runs[0] == runs[1]


def test_samples_agree_with_single_questions(executor):
    executor.begin(MoveJoint(pose_mm(5750, 5802.2, 2160.9, -105)), 0.0)
    executor.finish()
    motion = executor.begin(MoveLinear(pose_mm(0, 0, 100), "tool"), 5.0)
    times = np.linspace(4.9, motion.ends + 0.1, 9)
    assert np.allclose(motion.sample(times), [motion.q(t) for t in times], atol=1e-13)
    assert motion.step == pytest.approx(motion.duration / 20)


def test_the_branch_can_be_prescribed():
    from pn2code.robot.kinematics import BRANCH_NAMES

    cell = riveting_cell("good")
    robot = replace(cell.robot("robot1"), branch=BRANCH_NAMES["front/up/minus"])
    e = RobotExecutor(robot, cell.motion)
    e.begin(MoveJoint(pose_mm(5750, 5802.2, 2160.9, -105)), 0.0)
    e.finish()
    assert str(arm_kinematics().branch_of(e.q)) == "front/up/minus"


@pytest.mark.parametrize(
    ("pace", "says"),
    [
        ((1e-9, 1.0, 1.0), "longer than 1 h"),
        ((1.0, 1e-9, 1.0), "longer than 1 h"),
        ((1.0, 1.0, 1e-12), "longer than 1 h"),
        ((1e-300, 1.0, 1.0), "far too small or too large"),
        ((1e300, 1e300, 1e300), "far too small or too large"),
    ],
)
def test_a_move_that_never_ends_is_no_move(pace, says):
    """A line would be planned in samples of 10 ms."""
    with pytest.raises(MotionFault, match=says) as caught:
        Law(*pace)
    assert caught.value.kind == "bad-command"


def test_a_line_that_takes_years_is_refused_before_it_is_planned(executor):
    with pytest.raises(MotionFault, match="longer than 1 h"):
        executor.begin(MoveLinear(pose_mm(0.0, 0.0, -10.0), "tool", 1e-9), 0.0)
