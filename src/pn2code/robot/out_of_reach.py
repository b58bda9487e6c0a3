"""Why no joint position puts the tool where a move leads: out of reach, the branch, or joint limits."""

from __future__ import annotations

import math

import numpy as np

from pn2code.robot.carried import WithAxes
from pn2code.robot.commands import Pose
from pn2code.robot.digits import told_apart
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.motion_checks import other_branches
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import Array, inverse, matrix_of, pose_of, rotation_about

_RAY = 48
"""Poses between the base and one that is out of reach that are looked at, twice."""
_FAR = 4.0
"""How many times as far as a pose that is too near is looked."""


_STEP = 5
"""deg: by multiples of these a pose is turned about the axis of the tool."""
_ROOM = math.radians(10.0)
"""From the joint limits: a turn with so much is proposed before a smaller one with less."""


def unreachable(
    robot: CellRobot,
    target: Array,
    q: Array,
    arm_angle: float | None,
    pose: Pose,
    tip: Array | None = None,
) -> MotionFault:
    """Why a robot does not reach a pose in the base frame, with the external axes as in `q`.

    Args:
        pose: as the move tells it, in its own frame.
        tip: where the TCP is that the move refers to, seen from the TCP of the tool; None: it is that one.
    """
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
        + ("; another `arm_angle` may do" if other else "")
        + _turned(alone, target, arm_angle, pose, np.eye(4) if tip is None else tip),
    )


def _turned(k: Kinematics, target: Array, arm_angle: float | None, pose: Pose, tip: Array) -> str:
    """By how much the tool may be turned about its axis so that the pose is inside the joint limits; "": by nothing."""
    degrees = np.array(sorted(range(_STEP - 180, 181, _STEP), key=lambda a: (abs(a), -a)))
    turns = np.repeat(np.eye(4)[None], len(degrees), axis=0)
    turns[:, :3, :3] = rotation_about((0.0, 0.0, 1.0), np.radians(degrees))
    rows = k.all_branches(target @ tip @ turns @ inverse(tip), arm_angle)
    margins = k.arm.margins(rows)
    for axis in range(rows.shape[2]):
        if k.arm.slides(axis):  # by m, not by rad: inside is enough
            margins[..., axis] = np.where(margins[..., axis] < 0.0, margins[..., axis], np.inf)
    least = margins.min(axis=2)
    room = np.where(np.isnan(least), -np.inf, least).max(axis=1)
    enough = np.flatnonzero(room >= _ROOM)
    best = int(enough[0]) if len(enough) else int(np.argmax(room))
    if room[best] < 0.0:
        return ""
    way = pose_of(matrix_of(pose) @ turns[best])
    told = (("rx", pose.rx, way.rx), ("ry", pose.ry, way.ry), ("rz", math.inf, way.rz))
    angles = ", ".join(f"{name} = {_degrees(new)}" for name, old, new in told if _differ(old, new))
    return (
        f"; with the tool turned by {abs(degrees[best])} deg about its axis ({angles}) "
        "the pose is inside the limits"
    )


def _differ(old: float, new: float) -> bool:
    """Whether two angles are not the same; inf is no angle."""
    return math.isinf(old) or abs(math.remainder(new - old, math.tau)) > 1e-9


def _degrees(value: float) -> str:
    """A multiple of 360 less, and 180 for -180."""
    shown = f"{math.degrees(value) + 0.0:.6g}"
    return {"-180": "180", "-0": "0"}.get(shown, shown)


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
