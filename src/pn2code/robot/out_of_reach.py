"""Why no joint position puts the tool where a move leads: out of reach, the branch, or joint limits."""

from __future__ import annotations

import numpy as np

from pn2code.robot.carried import WithAxes
from pn2code.robot.digits import told_apart
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.motion_checks import other_branches
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import Array, inverse

_RAY = 48
"""Poses between the base and one that is out of reach that are looked at, twice."""
_FAR = 4.0
"""How many times as far as a pose that is too near is looked."""


def unreachable(robot: CellRobot, target: Array, q: Array, arm_angle: float | None) -> MotionFault:
    """Why a robot does not reach a pose in the base frame, with the external axes as in `q`."""
    alone = robot.kinematics.alone
    if isinstance(robot.kinematics, WithAxes):
        target = inverse(robot.kinematics.T_base_arm(q)) @ target
    if refused := alone.refused(target):
        return MotionFault("unreachable", refused)
    rows = alone.all_branches(target[None], arm_angle)[0]
    there = rows[~np.isnan(rows[:, 0])]
    if not len(there):
        reach = _reach(alone, target, arm_angle)
        return MotionFault("unreachable", f"the pose is out of reach: {reach}")
    if robot.branch is not None:
        return MotionFault(
            "unreachable",
            f"branch {robot.branch} does not reach the pose inside the joint limits"
            + other_branches(alone, target, robot.branch, arm_angle),
        )
    margins = [alone.limit_margin(row) for row in there]
    margin, axis = max(margins)
    other = alone.arm_angle is not None and arm_angle is None
    return MotionFault(
        "joint-limit",
        "every branch that reaches the pose leaves the joint limits; the nearest puts axis "
        f"{axis + 1} {alone.arm.shown(axis, -margin)} {alone.arm.unit(axis)} outside"
        + ("; another `arm_angle` may do" if other else ""),
    )


def _reach(k: Kinematics, target: Array, arm_angle: float | None) -> str:
    """How far the tool comes from the base in the direction of a pose that it does not reach, turned as it is there."""
    centre = 1000.0 * float(np.linalg.norm(target[:3, 3]))
    says = "{} mm from the base (limit in this direction, with the tool turned so: {})"

    def reached(parts: Array) -> Array:
        poses = np.repeat(target[None], len(parts), axis=0)
        poses[:, :3, 3] *= parts[:, None]
        return np.asarray(~np.isnan(k.all_branches(poses, arm_angle)[:, :, 0]).all(axis=1))

    for end in (0.0, _FAR):
        parts = np.linspace(1.0, end, _RAY + 1)
        there = np.flatnonzero(reached(parts))
        if len(there):
            i = max(int(there[0]), 1)
            parts = np.linspace(parts[i - 1], parts[i], _RAY + 1)  # around the border
            limit = parts[int(np.flatnonzero(reached(parts))[0])] * centre
            far, most = told_apart(centre, limit, digits=0)
            return says.format(far, f"{'at most' if end < 1.0 else 'at least'} {most} mm")
    return says.format(f"{centre:.0f}", "nothing is reached")
