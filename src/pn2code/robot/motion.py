"""Trajectories: joint moves (PTP), linear moves (LIN), standing still.

    limits = MotionLimits.of(arm, config)
    ptp = plan_ptp(kinematics, q_start, q_target, limits)         # jerk-limited, all axes in step
    lin = plan_lin(kinematics, q_start, T_start, T_target, ...)   # exactly on the line
    lin.q(0.25 * lin.duration)

Time laws are `ruckig`'s. A linear move is a one-axis law along the arc, and the closed-form inverse
at every instant asked for, on the branch of the start: no interpolation between solutions, so the TCP
is on the line to 1e-9 mm at any time. What cannot be done is a `MotionFault`, raised while planning.
"""

from __future__ import annotations

import math
from typing import Literal, Protocol

import numpy as np

from pn2code.base.conditioning import condition_text
from pn2code.base.frozen import frozen
from pn2code.robot.commands import Pose
from pn2code.robot.kinematics import Branch, Kinematics
from pn2code.robot.straight import Leap, Straight
from pn2code.robot.transforms import (
    Array,
    pose_of,
    rotation_about,
    rotation_vector,
)

FaultKind = Literal[
    "unreachable",
    "joint-limit",
    "axis-speed",
    "singularity",
    "collision",
    "wrong-tool",
    "bad-command",
]

# Conditioning (1 m) above this: an axis that is too fast is so because of a singularity.
SINGULAR_CONDITION = 50.0
LONGEST = 3600.0
"""s: a move that takes longer is no move."""
# Steps in which a linear move is checked when it is planned, s and m, whichever are more.
_CHECK_TIME = 0.01
_CHECK_LENGTH = 0.002
_CHECK_ANGLE = math.radians(0.5)
_SAME = 1e-12
# rad (of axes that slide: m): how far the closed form may be off where it begins.
_SAME_POSITION = 1e-5
# m: places that are nearer to each other are one; of a chord's length: so flat, an arc is a line.
_NEAR = 1e-6
_FLAT = 1e-5


class MotionFault(Exception):  # noqa: N818
    """A command that cannot be carried out, or a motion that must not go on.

    Args:
        kind: the class of fault.
        message: lower case, no full stop; names robot, axis, pose.
        robot: name in the cell; filled in by the executor.
        pose: the TCP pose (world) it happens at, if any.
        q: the joint position, rad, if any.
        time: seconds from the beginning of the motion, if it was planned that far.
    """

    def __init__(
        self,
        kind: FaultKind,
        message: str,
        *,
        robot: str = "",
        pose: Pose | None = None,
        q: tuple[float, ...] = (),
        time: float | None = None,
    ) -> None:
        super().__init__(message)
        self.kind: FaultKind = kind
        self.message = message
        self.robot = robot
        self.pose = pose
        self.q = q
        self.time = time


@frozen(eq=False)
class MotionLimits:
    """What a robot may do, in SI units; arrays are per axis.

    Args:
        velocity: rad/s, already scaled by the configured fraction.
        acceleration: rad/s2; jerk rad/s3.
        axis_velocity: the axes' own limit, rad/s: what a linear move is checked against.
        linear_*: of the TCP along a line, m/s, m/s2, m/s3.
        angular_velocity: of the TCP's turning on a linear move, rad/s.
    """

    velocity: Array
    acceleration: Array
    jerk: Array
    axis_velocity: Array
    linear_velocity: float
    linear_acceleration: float
    linear_jerk: float
    angular_velocity: float


class Trajectory(Protocol):
    """Joint positions over time, from 0 to `duration` (s); before and after, the ends."""

    @property
    def duration(self) -> float:
        """Seconds."""

    def q(self, t: float) -> Array:
        """Joint position, rad, (6,)."""

    def qd(self, t: float) -> Array:
        """Joint speed, rad/s, (6,)."""

    def sample(self, times: Array) -> Array:
        """Joint positions at many times, (n, 6)."""

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way (n,) from 0 to 1, in order: (n, 6). No time is in it."""


@frozen(eq=False)
class Still:
    """Standing at a position."""

    position: Array
    duration: float

    def q(self, t: float) -> Array:
        """The position."""
        return self.position

    def qd(self, t: float) -> Array:
        """Zero."""
        return np.zeros_like(self.position)

    def sample(self, times: Array) -> Array:
        """The position, repeated."""
        return np.repeat(self.position[None], len(times), axis=0)

    def on_way(self, s: Array) -> Array:
        """The position, repeated."""
        return self.sample(s)


class Law:
    """A jerk-limited law of one parameter from 0 to 1, from rest to rest; `duration` s.

    `uneven`: a bound on how fast its speed changes (1/s2) where it may be greatest at any time; 0: it is so half way.
    """

    uneven = 0.0

    def __init__(self, velocity: float, acceleration: float, jerk: float) -> None:
        # Whoever only looks where arms stand needs no time laws.
        from ruckig import InputParameter, Result, Ruckig, RuckigError, Trajectory

        request = InputParameter(1)
        request.current_position = [0.0]
        request.target_position = [1.0]
        request.max_velocity = [velocity]
        request.max_acceleration = [acceleration]
        request.max_jerk = [jerk]
        self._law = Trajectory(1)
        try:
            result = Ruckig(1).calculate(request, self._law)
        except RuckigError:
            raise MotionFault(
                "bad-command",
                "no time law was found: a speed, acceleration or jerk is far too small or too large",
            ) from None
        if self._law.duration > LONGEST:
            raise MotionFault(
                "bad-command",
                f"the move would take longer than {LONGEST / 3600.0:g} h: its speed, acceleration or jerk is too small",
            )
        # `Working` is what an offline calculation answers when all is well.
        if result not in (Result.Working, Result.Finished):
            raise MotionFault("bad-command", f"no time law was found ({result.name})")
        self.duration = float(self._law.duration)

    def at(self, t: float) -> tuple[float, float]:
        """Parameter and its speed."""
        position, speed, _ = self._law.at_time(min(max(t, 0.0), self.duration))
        return float(position[0]), float(speed[0])


class JointTrajectory:
    """PTP: all axes start and arrive together and are in proportion all the way.

    One law drives all axes (phase synchronisation), as fast as the axis allows that has the most to
    do. So the path in joint space is a straight line: it does not depend on the speed, and it stays
    between the axis positions of its ends, hence inside the limits. (ruckig's own phase
    synchronisation falls back to another path when the slowest axis by speed is not the slowest by
    acceleration or jerk.)
    """

    def __init__(self, start: Array, target: Array, law: Law | None) -> None:
        self._start, self._target, self._law = start, target, law
        self._way = target - start
        self.duration = 0.0 if law is None else law.duration

    @property
    def turns(self) -> Array:
        """How far each axis turns, rad."""
        return self._way

    def q(self, t: float) -> Array:
        """Joint position, rad; exactly the target at the end."""
        if t >= self.duration or self._law is None:
            return self._target
        return np.asarray(self._start + self._law.at(t)[0] * self._way)

    def progress(self, t: float) -> tuple[float, float]:
        """Fraction of the way at a time, and its speed, 1/s."""
        return (1.0, 0.0) if self._law is None else self._law.at(t)

    def qd(self, t: float) -> Array:
        """Joint speed, rad/s."""
        if self._law is None or not 0.0 < t < self.duration:
            return np.zeros_like(self._way)
        return np.asarray(self._law.at(t)[1] * self._way)

    def sample(self, times: Array) -> Array:
        """Joint positions at many times."""
        return np.stack([self.q(float(t)) for t in times])

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way, whenever the arm is there."""
        out = self._start + s[:, None] * self._way
        out[s >= 1.0] = self._target
        return np.asarray(out)


def turning(start: Array, target: Array) -> tuple[Array, float]:
    """Axis (in the start's frame, so that R(s) = R_start * Rot(axis, s * angle)) and angle from one pose to another."""
    turn = rotation_vector(start[:3, :3].T @ target[:3, :3])
    angle = float(np.linalg.norm(turn))
    return (turn / angle if angle > _SAME else np.array([0.0, 0.0, 1.0])), angle


class Way(Protocol):
    """A way of the TCP, by the fraction s of it.

    Attributes:
        start: where it begins; length: m; angle: rad, how far the tool turns; axis: about which, in its own frame.
            For one unit of s neither place nor orientation goes faster anywhere.
        bend: a bound on how fast the twist of the TCP for one unit of s changes, but for what turns with the tool, m.
        name: for messages.
    """

    start: Array
    length: float
    angle: float
    axis: Array
    bend: float
    name: str

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""

    def shifts(self, s: Array) -> Array:
        """Velocity of the TCP's place (m) for one unit of s, (n, 3)."""

    def spins(self, turns: Array, s: Array) -> Array:
        """How the tool turns (rad) for one unit of s, where its rotations are (n, 3, 3): (n, 3)."""


def own_spins(axis: Array, angle: float, turns: Array) -> Array:
    """Of a tool that turns evenly about an axis in its own frame."""
    spin = axis * angle
    return np.stack([r @ spin for r in turns])


class Line:
    """Straight from one pose to another, turning about one axis at constant ratio (slerp)."""

    bend = 0.0
    name = "line"

    def __init__(self, start: Array, target: Array) -> None:
        self.start, self.target = start, target
        self.shift = target[:3, 3] - start[:3, 3]
        self.length = float(np.linalg.norm(self.shift))
        self.axis, self.angle = turning(start, target)

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""
        out = np.repeat(self.start[None], len(s), axis=0)
        out[:, :3, 3] += s[:, None] * self.shift
        if self.angle > _SAME:
            out[:, :3, :3] = self.start[:3, :3] @ rotation_about(self.axis, s * self.angle)
        out[s >= 1.0] = self.target
        return out

    def shifts(self, s: Array) -> Array:
        """The same everywhere."""
        return np.broadcast_to(self.shift, (len(s), 3))

    def spins(self, turns: Array, s: Array) -> Array:
        """About its axis."""
        return own_spins(self.axis, self.angle, turns)


class Arc:
    """A piece of a circle through three places, from one pose to another, turning as a line does.

    Args:
        start: a pose; via: only its place matters; target: a pose.

    Raises:
        MotionFault: no circle, or every one, goes through the places.
    """

    name = "arc"

    def __init__(self, start: Array, via: Array, target: Array) -> None:
        self.start, self.target = start, target
        a, b, c = (pose[:3, 3] for pose in (start, via, target))
        chord = c - a
        long = float(np.linalg.norm(chord))
        if long < _NEAR:
            raise MotionFault(
                "bad-command",
                "a circular move ends where it begins, so that every circle through these places would do; make "
                "two moves of it",
                pose=pose_of(target),
            )
        off = (b - a) - chord * float((b - a) @ chord) / long**2
        bent = float(np.linalg.norm(off))
        if bent < max(_NEAR, _FLAT * long):
            raise MotionFault(
                "bad-command",
                f"the places of a circular move lie on a line (the one on the way is {1000.0 * bent:.4f} mm off it), "
                "so there is no circle through them; move on a line",
                pose=pose_of(via),
            )
        # In the plane with x along the chord and y towards the place on the way.
        x_axis, y_axis = chord / long, off / bent
        x = float((b - a) @ x_axis)
        centre_y = (x * x + bent * bent - x * long) / (2.0 * bent)
        self._centre = a + 0.5 * long * x_axis + centre_y * y_axis
        self.radius = math.hypot(0.5 * long, centre_y)
        self._u = (a - self._centre) / self.radius
        # The arc runs on the side of the chord on which the place on the way is: first along y, then down again.
        self._v = (0.5 * long * y_axis - centre_y * x_axis) / self.radius
        self.sweep = 2.0 * math.atan2(0.5 * long, -centre_y)
        self.length = self.radius * self.sweep
        self.axis, self.angle = turning(start, target)
        self.bend = self.length * self.sweep

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""
        out = np.repeat(self.start[None], len(s), axis=0)
        t = (s * self.sweep)[:, None]
        out[:, :3, 3] = self._centre + self.radius * (np.cos(t) * self._u + np.sin(t) * self._v)
        if self.angle > _SAME:
            out[:, :3, :3] = self.start[:3, :3] @ rotation_about(self.axis, s * self.angle)
        out[s >= 1.0] = self.target
        return out

    def shifts(self, s: Array) -> Array:
        """Along the tangents."""
        t = (s * self.sweep)[:, None]
        return np.asarray(self.length * (np.cos(t) * self._v - np.sin(t) * self._u))

    def spins(self, turns: Array, s: Array) -> Array:
        """About its axis."""
        return own_spins(self.axis, self.angle, turns)


class LinearTrajectory:
    """LIN and CIRC: the TCP on a line or an arc, joints by the closed-form inverse on one branch."""

    def __init__(
        self,
        kinematics: Kinematics,
        line: Way,
        branch: Branch,
        law: Law,
        start: Array,
        swivel: Swivel | None = None,
    ) -> None:
        self._k, self.line, self.branch, self._law = kinematics, line, branch, law
        self._swivel = swivel
        self.swivel = 0.0 if swivel is None else swivel[1]
        """rad: how far the arm angle goes on the way."""
        self.kinematics = kinematics
        self.duration = law.duration
        count = max(
            2,
            math.ceil(law.duration / _CHECK_TIME),
            math.ceil(line.length / _CHECK_LENGTH),
            math.ceil(line.angle / _CHECK_ANGLE),
        )
        # Unwrapped positions close enough that the turns of any instant between are those nearby.
        self.times = np.linspace(0.0, law.duration, count + 1)
        s = self.way(self.times)
        self._straight: Straight | None = None
        self.grid = self._k.follow(self.line.at(s), branch, start, self.arm_angles(s))
        if self._k.wrist_axes is not None:
            self._straight = Straight.of(self._solved, s, self.grid, start, self._k.wrist_axes)
        if self._straight is not None:
            more = [self.when(x) for x in self._straight.near]
            self.times = np.union1d(self.times, np.array(more))
            self.grid = self._continued(self.way(self.times), start)

    def arm_angles(self, s: Array) -> Array | None:
        """The arm angle (rad) at fractions of the way; None: the arm has none."""
        return None if self._swivel is None else self._swivel[0] + s * self._swivel[1]

    @property
    def leap(self) -> Leap | None:
        """What an axis would have to do at once where the wrist is straight."""
        return None if self._straight is None else self._straight.leap

    @property
    def is_straight(self) -> bool:
        """Whether the wrist is straight somewhere on the way."""
        return self._straight is not None and len(self._straight.at) > 0

    def rows(self, s: Array) -> Array:
        """Joint positions at fractions of the way, axes that turn in (-pi, pi].

        They are on the branch of its beginning; behind a straight wrist axis 5 may have the other sign.
        """
        rows = self._solved(s)
        return rows if self._straight is None else self._straight.rows(s, rows)

    def _solved(self, s: Array) -> Array:
        return self._k.on_branch(self.line.at(s), self.branch, self.arm_angles(s))

    def _continued(self, s: Array, start: Array) -> Array:
        return self._k.in_turn(self.rows(s), start)

    def when(self, s: float) -> float:
        """At what time it is at a fraction of the way."""
        if s <= 0.0:
            return 0.0
        low, high = 0.0, self.duration
        for _ in range(60):
            middle = (low + high) / 2.0
            low, high = (middle, high) if self._law.at(middle)[0] < s else (low, middle)
        return high

    def way(self, times: Array) -> Array:
        """Fraction of the way at each time, 0 to 1."""
        out = np.array([self._law.at(float(t))[0] for t in times])
        out[times >= self.duration] = 1.0
        return np.asarray(np.clip(out, 0.0, 1.0))

    def q(self, t: float) -> Array:
        """Joint position, rad."""
        return np.asarray(self.sample(np.array([t]))[0])

    def qd(self, t: float) -> Array:
        """Joint speed, rad/s."""
        if not 0.0 < t < self.duration:
            return np.zeros(self.grid.shape[1])
        now = np.array([t])
        return np.asarray(self.rates(self.q(t)[None], np.array([self.rate(t)]), self.way(now))[0])

    def progress(self, t: float) -> tuple[float, float]:
        """Fraction of the way at a time, and its speed, 1/s."""
        return self._law.at(t)

    @property
    def uneven(self) -> float:
        """As of its law."""
        return self._law.uneven

    def rate(self, t: float) -> float:
        """Speed along the way, 1/s."""
        return self._law.at(t)[1]

    def rates(self, q: Array, rate: Array, s: Array) -> Array:
        """Joint speeds (n, 6) at joint positions (n, 6) for speeds along the way (1/s), at fractions s of it."""
        now = self._k.forward_many(q)
        spins = self.line.spins(now[:, :3, :3], s)
        twist = np.concatenate([self.line.shifts(s), spins], axis=1) * rate[:, None]
        wanted = self._k.led_twist(twist, self.swivel * rate)
        jacobian = self._k.led_jacobian(q)
        if self._straight is not None:
            jacobian = self._straight.held(q, jacobian)
        return np.asarray((np.linalg.pinv(jacobian) @ wanted[..., None])[..., 0])

    def sample(self, times: Array) -> Array:
        """Joint positions at many times."""
        times = np.clip(times, 0.0, self.duration)
        rows = self.rows(self.way(times))
        near = self.grid[np.searchsorted(self.times, times).clip(0, len(self.times) - 1)]
        return self._k.unwound(rows, near)

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way, in order, whenever the arm is there; NaN out of reach."""
        return self._continued(s, self.grid[0])


def plan_ptp(
    kinematics: Kinematics, start: Array, target: Array, limits: MotionLimits, speed: float = 1.0
) -> JointTrajectory:
    """A joint move. `speed`: fraction (0..1] of the configured joint speed. Raises MotionFault."""
    _check_speed(speed, 1.0, "speed must be a fraction above 0 and at most 1")
    _check_limits(kinematics, target[None])
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


Swivel = tuple[float, float]
"""Of a way: the arm angle where it begins, and how far that goes until its end, rad."""


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
    _check_speed(wanted, math.inf, "linear speed must be above 0")
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
    _check_speed(wanted, math.inf, "linear speed must be above 0")
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
    way: Way,
    law: Law,
    start: Array,
    limits: MotionLimits,
    swivel: Swivel | None = None,
) -> LinearTrajectory:
    """The joint positions along a way, checked; `swivel`: of the arm angle, where the arm has one."""
    out = LinearTrajectory(kinematics, way, kinematics.branch_of(start), law, start, swivel)
    _check_leap(kinematics, out, start)
    _check_line(kinematics, out, limits)
    return out


def check_axes(kinematics: Kinematics, q: Array) -> None:
    """Raises MotionFault for a joint position outside the limits."""
    _check_limits(kinematics, q[None])


def _check_speed(value: float, most: float, message: str) -> None:
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


def _check_line(kinematics: Kinematics, lin: LinearTrajectory, limits: MotionLimits) -> None:
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
    rate = np.array([lin.rate(float(t)) for t in times])
    exact = np.abs(lin.rates(path, rate, lin.way(times))) / limits.axis_velocity
    step = np.zeros_like(exact)
    step[1:] = np.abs(np.diff(path, axis=0)) / np.diff(times)[:, None] / limits.axis_velocity
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


def _check_leap(kinematics: Kinematics, lin: LinearTrajectory, start: Array) -> None:
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
