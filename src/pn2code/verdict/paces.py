"""Lines and arcs with a speed that the TCP never comes to, on any way within its reach: mostly a wrong unit.

    most(cell.robot("arm"), cell.motion, is_arc=False).speed        # m/s

A way of length s from rest to rest with acceleration a has at most the speed sqrt(a s), whatever the jerk.
"""

from __future__ import annotations

import math

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.robot_cell import CellRobot, MotionConfig


@frozen
class Most:
    """The longest way of a TCP, m, and the speed that it comes to there, m/s."""

    way: float
    speed: float


def most(robot: CellRobot, motion: MotionConfig, *, is_arc: bool) -> Most:
    """What no line, or no arc, of an arm exceeds.

    The base can be anywhere on its tracks, and the tool be each of those that it changes.
    """
    tool = max(
        (float(np.linalg.norm(k.tool.T_flange_tcp[:3, 3])) for k in robot.tools.values()),
        default=0.0,
    )
    others = [float(np.linalg.norm(k.T_flange_tcp[:3, 3])) for k in robot.tcps.values()]
    stroke = sum(axis.upper - axis.lower for axis in robot.axes.tracks)
    far = robot.kinematics.alone.longest + max((tool, *others))
    across = 2.0 * far + stroke
    way = math.pi * across if is_arc else across
    return Most(way, math.sqrt(motion.linear_acceleration * way))
