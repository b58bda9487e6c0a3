"""Whether an arm can make a move: joint limits, axis speeds, singularities, reach all along the path."""

from __future__ import annotations

import math

import numpy as np

from pn2code.base.conditioning import condition_text
from pn2code.robot.kinematics import Branch, Kinematics
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.time_law import MotionLimits
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array, pose_of

# Conditioning (1 m) above this: an axis that is too fast is so because of a singularity.
SINGULAR_CONDITION = 50.0
# rad (of axes that slide: m): how far the closed form may be off where it begins.
_SAME_POSITION = 1e-5


def check_axes(kinematics: Kinematics, q: Array) -> None:
    """Raises MotionFault for a joint position outside the limits."""
    _check_limits(kinematics, q[None])


def check_speed(value: float, most: float, message: str) -> None:
    """Raises MotionFault with the message for a speed that is not above 0, or above the most."""
    if not (0.0 < value <= most and math.isfinite(value)):
        raise MotionFault("bad-command", f"{message}, but it is {value:g}")


def _check_limits(kinematics: Kinematics, path: Array, times: Array | None = None) -> None:
    arm = kinematics.arm
    margins = arm.margins(path)
    low = margins.min(axis=1)
    if (low >= -1e-9).all():
        return
    first = int(np.argmax(low < -1e-9))
    axis = int(np.argmin(margins[first]))
    raise MotionFault(
        "joint-limit",
        f"{arm.called(axis)} would be at {arm.outside(axis, path[first])}",
        pose=pose_of(kinematics.forward(path[first])),
        q=tuple(path[first].tolist()),
        time=None if times is None else float(times[first]),
    )


def check_line(kinematics: Kinematics, lin: LinearTrajectory, limits: MotionLimits) -> None:
    """Raises MotionFault where a move leaves the reach or the joint limits, or an axis would be too fast on it."""
    path, times = lin.grid, lin.times
    missing = np.isnan(path[:, 0])
    if missing.any():
        first = int(np.argmax(missing))
        there = lin.line.at(lin.way(times[first : first + 1]))[0]
        where = pose_of(there)
        if refused := kinematics.refused(there):
            raise MotionFault("unreachable", refused, pose=where, time=float(times[first]))
        others = _other_branches(kinematics, lin, first)
        raise MotionFault(
            "unreachable",
            f"the {lin.line.name} leaves the reach of branch {lin.branch} "
            f"{1000 * lin.line.length * float(lin.way(times[first : first + 1])[0]):.1f} mm after its start"
            + others,
            pose=where,
            time=float(times[first]),
        )
    try:
        _check_limits(kinematics, path, times)
    except MotionFault as fault:
        assert fault.time is not None, "it has the times"
        others = _other_branches(kinematics, lin, int(np.argmax(times >= fault.time)))
        message = (
            f"on branch {lin.branch}, on which the {lin.line.name} begins, {fault.message}{others}"
        )
        raise MotionFault(
            fault.kind, message, pose=fault.pose, q=fault.q, time=fault.time
        ) from None
    # Exact joint speeds, and the real steps: the one sees a singularity nearby, the other a leap over it.
    step = np.zeros_like(path)
    step[1:] = np.abs(np.diff(path, axis=0)) / np.diff(times)[:, None] / limits.axis_velocity
    if (step <= 1.0).all() and lin.is_slower(limits.axis_velocity):
        return
    exact = np.abs(lin.rates(path, lin.speeds, lin.fractions)) / limits.axis_velocity
    load = np.maximum(exact, step)
    if (load <= 1.0).all():
        return
    first = int(np.argmax((load > 1.0).any(axis=1)))
    axis = int(np.argmax(load[first]))
    condition = kinematics.conditioning(path[first])
    # Steps far above the exact speeds: the branch leaps, as over a straight wrist.
    leap = step[first, axis] > 2.0 * exact[first, axis] + 0.5
    singular = leap or condition.condition > SINGULAR_CONDITION
    what = (
        f"the {lin.line.name} passes a singularity (condition number {condition_text(condition.condition)}"
        f"{kinematics.straightness(condition.elbow, condition.wrist)}): "
        if singular
        else ""
    )
    arm, most = kinematics.arm, limits.axis_velocity[axis]
    word = "slide" if arm.slides(axis) else "turn"
    raise MotionFault(
        "singularity" if singular else "axis-speed",
        f"{what}{arm.called(axis)} would have to {word} at {arm.shown(axis, load[first, axis] * most, 0)} "
        f"{arm.unit(axis)}/s, but can do {arm.shown(axis, most, 0)}",
        pose=pose_of(kinematics.forward(path[first])),
        q=tuple(path[first].tolist()),
        time=float(times[first]),
    )


def check_leap(kinematics: Kinematics, lin: LinearTrajectory, start: Array) -> None:
    """In a singularity many joint positions have the same TCP pose; the way must go on from the arm's own.

    What comes after another one says nothing of the arm, so this is looked at first.
    """
    arm, leap, q, time, hint = kinematics.arm, lin.leap, start, 0.0, ""
    if leap is not None:
        assert kinematics.wrist_axes is not None, "it leaps at a straight wrist"
        axis, by, time = kinematics.wrist_axes[0], abs(leap.by), lin.when(leap.s)
        if time > 0.0:
            q = lin.q(time)
        there = leap.at + leap.by
        half = math.pi * round(there / math.pi)
        shown = " or ".join(
            f"{math.degrees(x) + 0.0:.1f}" for x in (there - half, there - half + math.pi)
        )
        hint = f"; on this way it stands at {shown.replace('-0.0 ', '0.0 ')} deg there"
    else:
        off = np.abs(lin.grid[0] - start)
        axis = int(np.argmax(off))
        by = float(off[axis])
        if not by > _SAME_POSITION:  # nan: out of reach, which is told with the rest of the way
            return
    condition = kinematics.conditioning(q)
    raise MotionFault(
        "singularity",
        f"the {lin.line.name} {'passes' if time > 0.0 else 'begins in'} a singularity (condition number "
        f"{condition_text(condition.condition)}{kinematics.straightness(condition.elbow, condition.wrist)}): "
        f"{arm.called(axis)} would have to leap by "
        f"{arm.shown(axis, by, 1)} {arm.unit(axis)}{hint}",
        pose=pose_of(kinematics.forward(q)),
        q=tuple(q.tolist()),
        time=time,
    )


def _other_branches(kinematics: Kinematics, lin: LinearTrajectory, index: int) -> str:
    s = lin.way(lin.times[index : index + 1])
    angles = lin.arm_angles(s)
    angle = None if angles is None else float(angles[0])
    return other_branches(kinematics, lin.line.at(s)[0], lin.branch, angle)


def other_branches(
    kinematics: Kinematics, target: Array, but: Branch, arm_angle: float | None = None
) -> str:
    """Which other branches reach a pose inside the joint limits, and how to choose one; "" if none does."""
    found = kinematics.inverse(target, arm_angle=arm_angle)
    there = [str(s.branch) for s in found if s.branch != but]
    if not there:
        return "; no other branch reaches the pose inside the joint limits"
    return (
        f"; branches that reach the pose inside the joint limits: {', '.join(there)} (`branch` of the robot in "
        "cell.toml chooses the one in which joint moves end)"
    )
