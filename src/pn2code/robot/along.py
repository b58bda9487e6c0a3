"""Lines and arcs on which external axes move as well, in step with the arm: one law leads them all.

path = plan_led(kinematics, Led(q, end, T_base_tcp, table, target, via), limits, speed)

The TCP is led in the world, or, in a frame of a turntable, on the plate: its speed is that relative to the work piece.
The joints of the arm follow from its inverse at every instant, from where its tracks have carried it by then.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.blend import Blended, law_through
from pn2code.robot.carried import WithAxes
from pn2code.robot.motion import Pace, arc_pace, led, line_pace
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.tcp_path import Arc, Line, TcpPath
from pn2code.robot.time_law import Law, MotionLimits
from pn2code.robot.trajectories import LinearTrajectory, Still, Swivel
from pn2code.robot.transforms import Array, inverse, matrix_of, pose_of, rotation_about

_SAME = 1e-12


@frozen(eq=False)
class Led:
    """What is wanted.

    Args:
        start: joint position; end: where external axes are at its end (the joints of the arm do not matter).
        T_base_tcp: where the TCP is.
        table: the turntable on whose plate it is led, by its index among the axes; None: in the world.
        target: where it goes, on the plate or in the base frame; via: of an arc.
        swivel: of the arm angle, where the arm has one.
        through: poses on the way of lines whose corners are rounded within `zone` (m).
    """

    start: Array
    end: Array
    T_base_tcp: Array
    table: int | None
    target: Array
    via: Array | None = None
    swivel: Swivel | None = None
    through: tuple[Array, ...] = ()
    zone: float = 0.0


class Coordinated:
    """A way on a plate that turns meanwhile, seen from an arm that tracks carry meanwhile.

    As of any way `at` gives poses; `length`, `angle` and `bend` are bounds here.

    Args:
        inner: the way, in the frame of the plate, or in the base frame.
        place: of the plate at zero in the base frame, about z of which it turns; begin, turn: rad, from where, how far.
        shift: where the arm's base is at the beginning, in the base frame; carry: how far it goes.
    """

    def __init__(
        self, inner: TcpPath, place: Array, begin: float, turn: float, shift: Array, carry: Array
    ) -> None:
        self.inner, self.name = inner, inner.name
        self._place, self._begin, self._turn = place, begin, turn
        self._shift, self._carry = shift, carry
        self._spin = place[:3, 2] * turn
        self.axis = inner.axis
        rate, way = abs(turn), inner.length
        far = float(np.hypot(*inner.start[:2, 3])) + way
        self.length = way + rate * far + float(np.linalg.norm(carry))
        self.angle = inner.angle + rate
        self.bend = inner.bend + rate * (2.0 * way + rate * far)
        self.start = self.at(np.zeros(1))[0]

    def at(self, s: Array) -> Array:
        """Poses (n, 4, 4) at fractions s of the way, from the arm's own base."""
        out = self._on_plate(s) @ self.inner.at(s)
        out[:, :3, 3] -= self.carried(s)
        return out

    def carried(self, s: Array) -> Array:
        """Where the arm's base is, (n, 3)."""
        return np.asarray(self._shift + s[:, None] * self._carry)

    def _on_plate(self, s: Array) -> Array:
        turn = np.repeat(np.eye(4)[None], len(s), axis=0)
        turn[:, :3, :3] = rotation_about((0.0, 0.0, 1.0), self._begin + s * self._turn)
        return np.asarray(self._place @ turn)

    def shifts(self, s: Array) -> Array:
        """Velocity of the TCP's place for one unit of s, seen from the arm's base."""
        plate = self._on_plate(s)
        own = (plate[:, :3, :3] @ self.inner.shifts(s)[..., None])[..., 0]
        places = (plate @ self.inner.at(s))[:, :3, 3]
        arms = places - self._place[:3, 3]
        return np.asarray(own + np.cross(self._spin, arms) - self._carry)

    def spins(self, turns: Array, s: Array) -> Array:
        """How the tool turns for one unit of s."""
        return np.asarray(self.inner.spins(turns, s) + self._spin)


class AlongTrajectory:
    """The arm on its way, and its external axes in step with it; joint positions have them all."""

    def __init__(
        self,
        path: LinearTrajectory,
        k: WithAxes,
        wanted: Led,
        way: Coordinated,
    ) -> None:
        start, end = wanted.start, wanted.end
        self.led, self.joints = path, k.joints
        self.way, self._k, self._table = way, k, wanted.table
        self._start, self._end = start, end
        self.delta = np.array(end - start)
        self.delta[k.joints] = 0.0
        self.duration = path.duration
        self.line = path.line
        self.grid = self.whole(path.grid, path.fractions)

    def whole(self, joints: Array, s: Array) -> Array:
        """Joint positions with these of the arm, (n, joints), at fractions of the way."""
        out = self._start + s[:, None] * self.delta
        out[s >= 1.0] = self._end
        out[:, self.joints] = joints
        return np.asarray(out)

    def on_plate(self, q: Array) -> Array:
        """Where the TCP is at a joint position, on the plate on which it is led, or in the base frame."""
        tcp = self._k.forward(q)
        if self._table is None:
            return tcp
        return np.asarray(inverse(self._k.T_base_table(self._table, float(q[self._table]))) @ tcp)

    def q(self, t: float) -> Array:
        """Joint position."""
        return np.asarray(self.sample(np.array([t]))[0])

    def qd(self, t: float) -> Array:
        """Joint speed."""
        if not 0.0 < t < self.duration:
            return np.zeros(len(self._start))
        out = self.led.rate(t) * self.delta
        out[self.joints] = self.led.qd(t)
        return np.asarray(out)

    def fraction(self, t: float) -> float:
        """Fraction of the way at a time."""
        return self.led.fraction(t)

    @property
    def length(self) -> float:
        """m: of the way of the TCP, on the plate if it is led there."""
        return self.way.inner.length

    @property
    def uneven(self) -> float:
        """As of its law."""
        return self.led.uneven

    def progress(self, t: float) -> tuple[float, float]:
        """Fraction of the way at a time, and its speed, 1/s."""
        return self.led.progress(t)

    def sample(self, times: Array) -> Array:
        """Joint positions at many times."""
        times = np.clip(times, 0.0, self.duration)
        return self.whole(self.led.sample(times), self.led.way(times))

    def on_way(self, s: Array) -> Array:
        """Joint positions at fractions of the way."""
        return self.whole(self.led.on_way(s), s)


def plan_led(
    k: WithAxes, wanted: Led, limits: MotionLimits, speed: float | None
) -> AlongTrajectory | Still:
    """A line, or an arc; MotionFault as of `plan_lin` and `plan_circ`, with the pose in the base frame."""
    place, begin, turn = np.eye(4), 0.0, 0.0
    if wanted.table is not None:
        place = k.T_base_table(wanted.table, 0.0)
        begin, to = (float(q[wanted.table]) for q in (wanted.start, wanted.end))
        turn = to - begin
        plate = k.T_base_table(wanted.table, begin)
        first = inverse(plate) @ wanted.T_base_tcp
    else:
        first = wanted.T_base_tcp
    delta = np.abs(wanted.end - wanted.start)
    delta[k.joints] = 0.0
    inner: Line | Arc | Blended
    pace: Pace | None
    if wanted.through:
        if delta.max() > _SAME:
            raise MotionFault(
                "bad-command",
                "external axes stand still on a linear move through several poses; move them before, or after",
            )
        inner = Blended([first, *wanted.through, wanted.target], wanted.zone)
        pace, passing = None, law_through(inner, limits, speed, wanted.swivel)
    elif wanted.via is None:
        inner = Line(first, wanted.target)
        pace = line_pace(inner, limits, speed, wanted.swivel)
    else:
        inner = Arc(first, wanted.via, wanted.target)
        pace = arc_pace(inner, limits, speed, wanted.swivel)
    law: Law
    if wanted.through:
        law = passing
    else:
        pace = _with(pace, delta, limits)
        if pace is None:
            return Still(wanted.start, 0.0)
        law = Law(*pace)
    shift, end = k.shifts(np.stack([wanted.start, wanted.end]))
    way = Coordinated(inner, place, begin, turn, shift, end - shift)
    own = replace(limits, axis_velocity=limits.axis_velocity[k.joints])
    try:
        path = led(k.alone, way, law, wanted.start[k.joints], own, wanted.swivel)
    except MotionFault as fault:
        raise _in_base(fault, way, law) from None
    return AlongTrajectory(path, k, wanted, way)


def _with(pace: Pace | None, delta: Array, limits: MotionLimits) -> Pace | None:
    """The same, with external axes that go so far."""
    own = [
        (float(v), float(a), float(j))
        for v, a, j in zip(
            *(
                x[delta > _SAME] / delta[delta > _SAME]
                for x in (limits.velocity, limits.acceleration, limits.jerk)
            ),
            strict=True,
        )
    ]
    every = [*([pace] if pace is not None else []), *own]
    if not every:
        return None
    speed, acceleration, jerk = (min(x) for x in zip(*every, strict=True))
    return speed, acceleration, jerk


def _in_base(fault: MotionFault, way: Coordinated, law: Law) -> MotionFault:
    """A fault of the arm, whose pose is seen from its own base."""
    if fault.pose is None:
        return fault
    s = 0.0 if fault.time is None else law.at(fault.time)[0]
    frame = matrix_of(fault.pose)
    frame[:3, 3] += way.carried(np.array([s]))[0]
    return MotionFault(fault.kind, fault.message, pose=pose_of(frame), time=fault.time)
