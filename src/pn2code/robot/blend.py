"""Linear moves through several poses: lines whose corners are rounded, so that the TCP does not stop at them.

    path = plan_through(kinematics, q_start, T_start, [T_1, T_2], T_target, 0.02, limits)

With x the way along the lines (m), measured from a corner, u and w the directions before and behind it, and d its zone,
the place of the TCP is corner + x u + (w - u) G(x), where G'' is a triangle over [-d, d] of area 1. So

* outside of the zone it is on the lines; the rounded piece begins and ends d from the corner;
* it is never further than |w - u| d / 6 from the lines, which is at most d / 3 (where it turns back);
* its speed is never above that along the lines, its second derivative is at most |w - u| / d, and the third
  |w - u| / d^2, which is all that a limit on acceleration and jerk needs to know.

The orientation is R_0 exp(a_1 f_1) .. exp(a_n f_n), where f_i goes from 0 to 1 on line i, rounded in the same way: on
the lines it turns as any linear move does. Zones overlap nowhere: none is longer than half of a line beside it.

The law passes all corners at one speed, without acceleration, and is as fast as the limits allow between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.motion import led
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.tcp_path import turning
from pn2code.robot.time_law import LONGEST, Law, MotionLimits
from pn2code.robot.trajectories import LinearTrajectory, Swivel
from pn2code.robot.transforms import Array, pose_of, rotation_about

LEAST_LINE = 1e-4
"""m: places on the way that are nearer to each other are refused."""
LEAST_ZONE = 0.999e-4
"""m: 0.1 mm, as scripts and files come to it."""
MOST_OFF = 1.0 / 3.0
"""Of the zone: how far the TCP is off its lines at most."""
_STEADY = 1e-6
"""m: a line that is shorter between two zones is passed at their speed."""
_HALVINGS = 60


@frozen(eq=False)
class Corner:
    """A corner: where it is on the way (m), its zone (m), and bounds on the second and third derivative there."""

    at: float
    zone: float
    bend: float
    snap: float


class Blended:
    """Lines from pose to pose with rounded corners; a `TcpPath`, whose `length` is that of the lines.

    `angle` is a bound here: how far the tool would turn if it turned everywhere as fast as on the line where it turns
    fastest.

    Args:
        poses: where it begins, the poses on the way, and where it ends.
        zone: m, how far before and behind a corner the TCP leaves its lines, unless these are too short.

    Raises:
        MotionFault: a pose is where the one before is, or the zone is too small.
    """

    name = "path"

    def __init__(self, poses: Sequence[Array], zone: float) -> None:
        if not (zone >= LEAST_ZONE and math.isfinite(zone)):
            raise MotionFault(
                "bad-command",
                f"corners are rounded within 0.1 mm at least, but `blend` is {1000.0 * zone:g} mm",
            )
        self.start, self.target = poses[0], poses[-1]
        places = np.stack([p[:3, 3] for p in poses])
        self._shifts = np.diff(places, axis=0)
        self._lengths = np.linalg.norm(self._shifts, axis=1)
        for i, length in enumerate(self._lengths.tolist()):
            if not length >= LEAST_LINE:
                raise MotionFault(
                    "bad-command",
                    f"pose {i + 1} of a move through {len(poses) - 1} poses is {1000.0 * length:.4f} mm from where the "
                    f"TCP is before, but at least {1000.0 * LEAST_LINE:g} mm are needed; leave it out, or turn the "
                    "tool in a move of its own",
                    pose=pose_of(poses[i + 1]),
                )
        self._turns = [turning(a, b) for a, b in zip(poses[:-1], poses[1:], strict=True)]
        self._ends = np.concatenate([[0.0], np.cumsum(self._lengths)])
        self.length = float(self._ends[-1])
        self.turning = max(
            angle / length
            for (_, angle), length in zip(self._turns, self._lengths.tolist(), strict=True)
        )
        """rad/m: how fast the tool turns at most along the way."""
        self.angle = self.turning * self.length
        self.axis = self._turns[0][0]
        self.corners = tuple(self._corner(i, zone) for i in range(1, len(poses) - 1))
        self._zones = np.array([0.0, *(c.zone for c in self.corners), 0.0])
        self.bend = self.length**2 * max((c.bend for c in self.corners), default=0.0)

    def _corner(self, i: int, zone: float) -> Corner:
        """Between line i - 1 and line i; of place and orientation together."""
        before, behind = self._lengths[i - 1 : i + 1].tolist()
        d = min(zone, before / 2.0, behind / 2.0)
        off = float(np.linalg.norm(self._shifts[i] / behind - self._shifts[i - 1] / before))
        one, two = self._turns[i - 1][1] / before, self._turns[i][1] / behind
        # The one turn carries the axis of the other: hence the products.
        both = one * two
        spin = (one + two) / d + both / 4.0
        jolt = (one + two) / d**2 + 2.0 * both / d + both * two / 4.0
        return Corner(
            float(self._ends[i]), d, math.hypot(off / d, spin), math.hypot(off / d**2, jolt)
        )

    def _parts(self, s: Array) -> tuple[Array, Array]:
        """How much of each line is done at fractions of the way, and how fast that changes, 1/m: (n, lines)."""
        x = s[:, None] * self.length - self._ends
        d = self._zones
        wide = np.where(d > 0.0, d, 1.0)
        low, high = np.clip(x + d, 0.0, d), np.clip(d - x, 0.0, d)
        rise = np.where(x < 0.0, low**2, 2.0 * d**2 - high**2) / (2.0 * wide**2)
        round_ = np.where(x < 0.0, low**3, high**3) / (6.0 * wide**2) + np.maximum(x, 0.0)
        is_end = d == 0.0
        rise = np.where(is_end, x >= 0.0, rise)
        rise[:, 0], rise[:, -1] = 1.0, 0.0
        round_ = np.where(is_end, np.maximum(x, 0.0), round_)
        round_[:, -1] = 0.0
        done = (round_[:, :-1] - round_[:, 1:]) / self._lengths
        return np.clip(done, 0.0, 1.0), (rise[:, :-1] - rise[:, 1:]) / self._lengths

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way."""
        done, _ = self._parts(s)
        out = np.repeat(self.start[None], len(s), axis=0)
        out[:, :3, 3] += done @ self._shifts
        for i, (axis, angle) in enumerate(self._turns):
            out[:, :3, :3] = out[:, :3, :3] @ rotation_about(axis, done[:, i] * angle)
        out[s >= 1.0] = self.target
        return out

    def shifts(self, s: Array) -> Array:
        """Along the lines, and from one to the next in the corners."""
        return np.asarray(self._parts(s)[1] @ self._shifts * self.length)

    def spins(self, turns: Array, s: Array) -> Array:
        """About the axis of each line, carried by the turns behind it."""
        done, fast = self._parts(s)
        own = np.zeros((len(s), 3))
        behind = np.repeat(np.eye(3)[None], len(s), axis=0)
        for i in reversed(range(len(self._turns))):
            axis, angle = self._turns[i]
            own += (behind.transpose(0, 2, 1) @ (axis * angle)) * fast[:, i, None]
            behind = rotation_about(axis, done[:, i] * angle) @ behind
        return np.asarray((turns @ own[..., None])[..., 0] * self.length)


@frozen(eq=False)
class _Piece:
    """A piece of a law: from when on, from where on (m), and its profile, or its speed if it has none."""

    begins: float
    first: float
    speed: float
    profile: object = None


class PassingLaw(Law):
    """From rest to rest along lines with corners: through all corners at one speed, between them as fast as may be.

    Args:
        way: whose corners are passed.
        speed, acceleration, jerk: along the lines, m/s, m/s2, m/s3; most, sharp: what the TCP may do in corners.
    """

    def __init__(
        self,
        way: Blended,
        speed: float,
        acceleration: float,
        jerk: float,
        most: float,
        sharp: float,
    ) -> None:
        self._length = way.length
        self.uneven = acceleration / way.length
        straights = _straights(way)
        passing = speed
        for c in way.corners:
            passing = min(passing, math.sqrt(most / c.bend) if c.bend else math.inf)
            passing = min(passing, (sharp / c.snap) ** (1.0 / 3.0) if c.snap else math.inf)
        room = min(straights[0][1], straights[-1][1])
        passing = _slow_enough(passing, room, acceleration, jerk)
        self.passing = passing
        """m/s: in the corners."""
        self._pieces: list[_Piece] = []
        now = 0.0
        for i, (first, length) in enumerate(straights):
            ends = (0.0 if i == 0 else passing, 0.0 if i == len(straights) - 1 else passing)
            if all(ends) and length < _STEADY:
                self._pieces.append(_Piece(now, first, passing))
                now += length / passing
            else:
                profile, duration = _profile(length, *ends, speed, acceleration, jerk)
                self._pieces.append(_Piece(now, first, 0.0, profile))
                now += duration
            if i < len(way.corners):
                zone = way.corners[i].zone
                self._pieces.append(_Piece(now, first + length, passing))
                now += 2.0 * zone / passing
        if not now <= LONGEST:
            raise MotionFault(
                "bad-command",
                f"the move would take longer than {LONGEST / 3600.0:g} h: its speed, acceleration or jerk, or the "
                "zone in which its corners are rounded, is too small",
            )
        self.duration = now
        self._begins = np.array([p.begins for p in self._pieces])

    def at(self, t: float) -> tuple[float, float]:
        """Parameter and its speed."""
        t = min(max(t, 0.0), self.duration)
        piece = self._pieces[max(int(np.searchsorted(self._begins, t, side="right")) - 1, 0)]
        own = t - piece.begins
        if piece.profile is None:
            return (piece.first + own * piece.speed) / self._length, piece.speed / self._length
        position, speed, _ = piece.profile.at_time(own)  # type: ignore[attr-defined]
        return (piece.first + float(position[0])) / self._length, float(speed[0]) / self._length


def _straights(way: Blended) -> list[tuple[float, float]]:
    """Where the pieces between the zones begin, and how long they are, m."""
    out, first = [], 0.0
    for c in way.corners:
        out.append((first, max(c.at - c.zone - first, 0.0)))
        first = c.at + c.zone
    return [*out, (first, way.length - first)]


def _slow_enough(speed: float, room: float, acceleration: float, jerk: float) -> float:
    """The greatest speed, at most this, to which it comes from rest within so many metres."""

    def needs(v: float) -> float:
        if v * jerk < acceleration**2:
            return v * math.sqrt(v / jerk)
        return v * (v / acceleration + acceleration / jerk) / 2.0

    if needs(speed) <= room * (1.0 - 1e-6):
        return speed
    low, high = 0.0, speed
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if needs(middle) <= room * (1.0 - 1e-6) else (low, middle)
    return low


def _profile(
    length: float, v0: float, v1: float, speed: float, acceleration: float, jerk: float
) -> tuple[object, float]:
    """A jerk-limited profile over a piece of the way, and how long it takes."""
    from ruckig import InputParameter, Result, Ruckig, RuckigError, Trajectory

    request = InputParameter(1)
    request.current_position, request.target_position = [0.0], [length]
    request.current_velocity, request.target_velocity = [v0], [v1]
    request.max_velocity, request.max_acceleration = [speed], [acceleration]
    request.max_jerk = [jerk]
    out = Trajectory(1)
    try:
        result = Ruckig(1).calculate(request, out)
    except RuckigError:
        result = None
    if result not in (Result.Working, Result.Finished):
        raise MotionFault(
            "bad-command",
            "no time law was found: a speed, acceleration or jerk is far too small or too large",
        )
    return out, float(out.duration)


def law_through(
    way: Blended, limits: MotionLimits, speed: float | None, swivel: Swivel | None = None
) -> PassingLaw:
    """The law of a way; turns of the tool and of the elbow count as those of lines do (`line_pace`)."""
    wanted = limits.linear_velocity if speed is None else speed
    if not (wanted > 0.0 and math.isfinite(wanted)):
        raise MotionFault("bad-command", f"linear speed must be above 0, but it is {wanted:g}")
    elbow = 0.0 if swivel is None else abs(swivel[1]) / way.length
    turned = max(way.turning, elbow)
    if turned:
        wanted = min(wanted, limits.angular_velocity / turned)
    size = max(1.0, turned)
    return PassingLaw(
        way,
        wanted,
        limits.linear_acceleration / size,
        limits.linear_jerk / size,
        limits.linear_acceleration,
        limits.linear_jerk,
    )


def plan_through(
    kinematics: Kinematics,
    start: Array,
    poses: Sequence[Array],
    zone: float,
    limits: MotionLimits,
    speed: float | None = None,
    swivel: Swivel | None = None,
) -> LinearTrajectory:
    """A linear move from `poses[0]` (the TCP in the base frame, where `start` puts it) through the others to the last.

    Args:
        zone: m, how far before and behind a pose on the way its corner is rounded at most.
        speed: m/s; None: the configured one.

    Raises MotionFault as `plan_lin` does, and where poses are too near to each other.
    """
    way = Blended(poses, zone)
    return led(kinematics, way, law_through(way, limits, speed, swivel), start, limits, swivel)
