"""Planning moves of one arm: joint moves (PTP), linear and circular moves (LIN, CIRC).

    limits = MotionLimits.of(arm, config)
    ptp = plan_ptp(kinematics, q_start, q_target, limits)         # jerk-limited, all axes in step
    lin = plan_lin(kinematics, q_start, T_start, T_target, ...)   # exactly on the line
    lin.q(0.25 * lin.duration)

What cannot be done is a `MotionFault`, raised while planning.
"""

from __future__ import annotations

import math

import numpy as np

from pn2code.robot.kinematics import Kinematics
from pn2code.robot.motion_checks import check_axes, check_leap, check_line, check_speed
from pn2code.robot.tcp_path import Arc, Line, TcpPath
from pn2code.robot.time_law import Law, MotionLimits
from pn2code.robot.trajectories import JointTrajectory, LinearTrajectory, Still, Swivel
from pn2code.robot.transforms import Array

_SAME = 1e-12


def plan_ptp(
    kinematics: Kinematics, start: Array, target: Array, limits: MotionLimits, speed: float = 1.0
) -> JointTrajectory:
    """A joint move. `speed`: fraction (0..1] of the configured joint speed. Raises MotionFault."""
    check_speed(speed, 1.0, "speed must be a fraction above 0 and at most 1")
    check_axes(kinematics, target)
    way = np.abs(target - start)
    if way.max() < _SAME:
        return JointTrajectory(start, target, None)
    far = way > _SAME
    law = Law(
        float((limits.velocity[far] * speed / way[far]).min()),
        float((limits.acceleration[far] / way[far]).min()),
        float((limits.jerk[far] / way[far]).min()),
    )
    return JointTrajectory(start, target, law)


def swivel_of(
    kinematics: Kinematics, start: Array, arm_angle: float | None, keeps: bool
) -> Swivel | None:
    """From the arm angle of a joint position to another one, the shorter way; None: the arm has no arm angle.

    Args:
        arm_angle: None: that of the arm, or, if it `keeps` what it has, the same.
    """
    here = kinematics.arm_angle_of(start)
    if here is None:
        return None
    if arm_angle is None:
        arm_angle = here if keeps else kinematics.arm_angle
    assert arm_angle is not None, "the arm has one"
    turn = 2.0 * math.pi
    away = arm_angle - here
    away -= turn * round(away / turn)
    return here, away if abs(away) > _SAME else 0.0


def plan_lin(
    kinematics: Kinematics,
    start: Array,
    T_start: Array,
    T_target: Array,
    limits: MotionLimits,
    speed: float | None = None,
    swivel: Swivel | None = None,
) -> LinearTrajectory | Still:
    """A linear move from `T_start` (the TCP in the base frame, where `start` puts it) to `T_target`.

    Args:
        speed: m/s; None: the configured one.

    Raises MotionFault: a pose on the way is out of reach or of the limits, or an axis would have to
    turn faster than it can (a singularity, where the conditioning says so).
    """
    line = Line(T_start, T_target)
    pace = line_pace(line, limits, speed, swivel)
    if pace is None:
        return Still(start, 0.0)
    return led(kinematics, line, Law(*pace), start, limits, swivel)


Pace = tuple[float, float, float]
"""Greatest speed, acceleration and jerk of the fraction of a way, 1/s, 1/s2, 1/s3."""


def line_pace(
    line: Line, limits: MotionLimits, speed: float | None, swivel: Swivel | None = None
) -> Pace | None:
    """Of a line; None: it has no length, and turns nothing. The elbow turns no faster than the tool may."""
    wanted = limits.linear_velocity if speed is None else speed
    check_speed(wanted, math.inf, "linear speed must be above 0")
    elbow = 0.0 if swivel is None else abs(swivel[1])
    if line.length < _SAME and line.angle < _SAME and elbow < _SAME:
        return None
    # One unit of the law is the whole way; pure turns are limited by the angular speed alone.
    fast = min(
        wanted / line.length if line.length > _SAME else math.inf,
        limits.angular_velocity / line.angle if line.angle > _SAME else math.inf,
        limits.angular_velocity / elbow if elbow > _SAME else math.inf,
    )
    size = max(line.length, line.angle, elbow)
    return fast, limits.linear_acceleration / size, limits.linear_jerk / size


def plan_circ(
    kinematics: Kinematics,
    start: Array,
    T_start: Array,
    T_via: Array,
    T_target: Array,
    limits: MotionLimits,
    speed: float | None = None,
    swivel: Swivel | None = None,
) -> LinearTrajectory:
    """A circular move from `T_start`, where `start` puts the TCP, through the place of `T_via` to `T_target`.

    The TCP's acceleration and jerk towards the centre count as well: with the speed v, the radius r and the law's own
    acceleration a and jerk j, the former are v^2/r and (v^3/r^2, 3 v a/r), so that each gets a part of what is allowed.

    Args:
        speed: m/s, as fast as the limits allow on this radius; None: the configured one.

    Raises MotionFault as `plan_lin` does, and where there is no arc.
    """
    arc = Arc(T_start, T_via, T_target)
    return led(kinematics, arc, Law(*arc_pace(arc, limits, speed, swivel)), start, limits, swivel)


def arc_pace(
    arc: Arc, limits: MotionLimits, speed: float | None, swivel: Swivel | None = None
) -> Pace:
    """Of an arc, as `plan_circ` says."""
    elbow = 0.0 if swivel is None else abs(swivel[1])
    wanted = limits.linear_velocity if speed is None else speed
    check_speed(wanted, math.inf, "linear speed must be above 0")
    most, jerk, r = limits.linear_acceleration, limits.linear_jerk, arc.radius
    v = min(wanted, math.sqrt(most * r / math.sqrt(2.0)), (jerk * r * r / 4.0) ** (1.0 / 3.0))
    turned = max(arc.angle, elbow)
    turning = limits.angular_velocity / turned if turned > _SAME else math.inf
    fast = min(v / arc.length, turning)
    v = fast * arc.length
    a = min(most / math.sqrt(2.0), jerk * r / (6.0 * v))
    size = max(arc.length, turned)
    return fast, a / size, 0.5 * jerk / size


def led(
    kinematics: Kinematics,
    way: TcpPath,
    law: Law,
    start: Array,
    limits: MotionLimits,
    swivel: Swivel | None = None,
) -> LinearTrajectory:
    """The joint positions along a way, checked; `swivel`: of the arm angle, where the arm has one."""
    out = LinearTrajectory(kinematics, way, kinematics.branch_of(start), law, start, swivel)
    check_leap(kinematics, out, start)
    check_line(kinematics, out, limits)
    return out
