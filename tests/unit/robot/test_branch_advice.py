"""Messages about limits say on which branch they are met, and which other branches reach the pose."""

from __future__ import annotations

import numpy as np
import pytest

from helpers.robot_cells import riveting_cell
from pn2code.robot.commands import MoveJoint
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.kinematics import BRANCHES
from pn2code.robot.motion import plan_lin
from pn2code.robot.motion_checks import other_branches
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import pose_of

START = np.radians([10.0, -100.0, 90.0, 20.0, 40.0, 60.0])


def test_a_line_that_leaves_the_limits() -> None:
    robot, motion = riveting_cell("good").robot("robot1"), riveting_cell("good").motion
    k = robot.kinematics
    begin = np.radians([10.0, -100.0, 90.0, 20.0, 118.0, 60.0])
    branch = k.branch_of(begin)
    end = begin + np.radians([0.0, 0.0, 0.0, 0.0, 10.0, 0.0])  # axis 5: 125 degrees at most
    with pytest.raises(MotionFault) as caught:
        plan_lin(k, begin, k.forward(begin), k.forward(end), robot.limits(motion))
    assert caught.value.kind == "joint-limit"
    text = str(caught.value)
    assert f"on branch {branch}, on which the line begins, axis 5" in text
    assert "branch" in text.split("outside")[1]


def test_a_joint_move_on_a_branch_of_its_own() -> None:
    robot, motion = riveting_cell("good").robot("robot1"), riveting_cell("good").motion
    k = robot.kinematics
    target = k.forward(START)
    reached = {s.branch for s in k.inverse(target)}
    assert 0 < len(reached) < len(BRANCHES)
    missing = next(b for b in BRANCHES if b not in reached)
    executor = RobotExecutor(replace_branch(robot, missing), motion)
    world = pose_of(executor._T_world_base @ target)
    with pytest.raises(MotionFault) as caught:
        executor.begin(MoveJoint(world), 0.0)
    text = str(caught.value)
    assert f"branch {missing} does not reach the pose inside the joint limits" in text
    assert all(str(b) in text for b in reached)
    assert "`branch` of the robot in cell.toml" in text


def replace_branch(robot, branch):  # type: ignore[no-untyped-def]
    return type(robot)(
        robot.name, robot.arm, robot.tool, robot.kinematics, robot.base, robot.home, branch
    )


def test_no_other_branch() -> None:
    k = riveting_cell("good").robot("robot1").kinematics
    target = k.forward(START)
    target[:3, 3] *= 10.0
    assert "no other branch reaches the pose" in other_branches(k, target, BRANCHES[0])
