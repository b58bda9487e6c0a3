"""Joint positions over time: standing still, joint moves (PTP), moves whose TCP follows a path (LIN, CIRC).

A move along a path is a one-axis law along it, and the closed-form inverse at every instant asked for, on the branch
of the start: no interpolation between solutions, so the TCP is on the path to 1e-9 mm at any time.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.kinematics import Branch, Kinematics
from pn2code.robot.straight import Leap, Straight
from pn2code.robot.tcp_path import TcpPath
from pn2code.robot.time_law import Law
from pn2code.robot.transforms import Array

# Steps in which a linear move is checked when it is planned, s and m, whichever are more.
_CHECK_TIME = 0.01
_CHECK_LENGTH = 0.002
_CHECK_ANGLE = math.radians(0.5)
# Where a matrix and its inverse together are no greater than this, ten digits of the axes' speeds are known: far more
# than the six to which they are compared with what is permitted.
_SOUND = 1e6

Swivel = tuple[float, float]
"""Of a way: the arm angle where it begins, and how far that goes until its end, rad."""


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

    def fraction(self, t: float) -> float:
        """At which fraction of the way it is at a time."""

    @property
    def length(self) -> float:
        """m: of the way on which the TCP is led; 0: it is not led."""


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

    def fraction(self, t: float) -> float:
        """There is no way."""
        return 1.0

    @property
    def length(self) -> float:
        """There is none."""
        return 0.0


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

    def fraction(self, t: float) -> float:
        """Fraction of the way at a time."""
        return self.progress(t)[0]

    @property
    def length(self) -> float:
        """The axes are led, not the TCP."""
        return 0.0

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


class LinearTrajectory:
    """LIN and CIRC: the TCP on a line or an arc, joints by the closed-form inverse on one branch.

    Attributes:
        times: at which it is checked when it is planned, s; grid: the joint positions then; fractions: how far on the
            way it is; speeds: along the way, 1/s.
    """

    def __init__(
        self,
        kinematics: Kinematics,
        line: TcpPath,
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
        s, self.speeds = self._progress(self.times)
        self._straight: Straight | None = None
        self.grid = self._k.follow(self.line.at(s), branch, start, self.arm_angles(s))
        if self._k.wrist_axes is not None:
            self._straight = Straight.of(self._solved, s, self.grid, start, self._k.wrist_axes)
        if self._straight is not None:
            more = [self.when(x) for x in self._straight.near]
            self.times = np.union1d(self.times, np.array(more))
            s, self.speeds = self._progress(self.times)
            self.grid = self._continued(s, start)
        self.fractions = s

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
        return self._progress(times)[0]

    def _progress(self, times: Array) -> tuple[Array, Array]:
        """The same, and the speed along the way (1/s)."""
        out = np.array([self._law.at(t) for t in times.tolist()]).reshape(-1, 2)
        where = out[:, 0].copy()
        where[times >= self.duration] = 1.0
        return np.clip(where, 0.0, 1.0), out[:, 1].copy()

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

    def fraction(self, t: float) -> float:
        """Fraction of the way at a time."""
        return float(self.way(np.array([t]))[0])

    @property
    def length(self) -> float:
        """m: of the way of the TCP."""
        return self.line.length

    @property
    def uneven(self) -> float:
        """As of its law."""
        return self._law.uneven

    def rate(self, t: float) -> float:
        """Speed along the way, 1/s."""
        return self._law.at(t)[1]

    def rates(self, q: Array, rate: Array, s: Array) -> Array:
        """Joint speeds (n, 6) at joint positions (n, 6) for speeds along the way (1/s), at fractions s of it."""
        jacobian, wanted = self._led(q, rate, s)
        return np.asarray((np.linalg.pinv(jacobian) @ wanted[..., None])[..., 0])

    def is_slower(self, most: Array) -> bool:
        """Whether each axis is surely slower than that (rad/s) at all times at which the way is checked.

        False where the arm is so near to a singularity somewhere that only `rates` says what is faster.
        """
        jacobian, wanted = self._led(self.grid, self.speeds, self.fractions)
        try:
            inverse = np.linalg.inv(jacobian)
        except np.linalg.LinAlgError:
            return False
        size = np.linalg.norm(jacobian, axis=(1, 2)) * np.linalg.norm(inverse, axis=(1, 2))
        rates = np.abs((inverse @ wanted[..., None])[..., 0])
        return bool((size < _SOUND).all() and (rates <= (1.0 - 1.0 / _SOUND) * most).all())

    def _led(self, q: Array, rate: Array, s: Array) -> tuple[Array, Array]:
        """What takes axis speeds to what the way is about (n, axes, axes), and that (n, axes)."""
        frames = self._k.link_frames(q)
        now = self._k.tcp_at(frames)
        spins = self.line.spins(now[:, :3, :3], s)
        twist = np.concatenate([self.line.shifts(s), spins], axis=1) * rate[:, None]
        wanted = self._k.led_twist(twist, self.swivel * rate)
        jacobian = self._k.led_jacobian(q, frames)
        if self._straight is not None:
            jacobian = self._straight.held(q, jacobian)
        return jacobian, wanted

    def sample(self, times: Array) -> Array:
        """Joint positions at many times."""
        times = np.clip(times, 0.0, self.duration)
        rows = self.rows(self.way(times))
        near = self.grid[np.searchsorted(self.times, times).clip(0, len(self.times) - 1)]
        return self._k.unwound(rows, near)

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way, in order, whenever the arm is there; NaN out of reach."""
        return self._continued(s, self.grid[0])
