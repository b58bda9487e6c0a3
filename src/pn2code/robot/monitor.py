"""Watching the robots while they move: clearances, joint limits, singularities.

    monitor = Monitor(cell, backend)
    verdict = monitor.check(t, {"robot1": q1, "robot2": q2}, phase="approach")
    if verdict.fault is not None: stop the cell
    monitor.minima("approach")               # the closest everything came, when, and where

`check` puts the robots in place and measures. A fault is a collision (names both parts), a joint
limit or a singularity; everything else is remembered as running minima, in total and per phase.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from typing import Literal

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.active_motion import PATHS, MotionKind
from pn2code.robot.backend import Backend, Clearance, closest
from pn2code.robot.commands import Pose
from pn2code.robot.digits import told_apart
from pn2code.robot.kinematics import Conditioning
from pn2code.robot.led_contacts import EARLY, Led, LedContact, LedContacts, with_move
from pn2code.robot.motion_fault import FaultKind
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.transforms import Array, describe, pose_of

MeasureName = Literal[
    "robots", "scene", "self", "contact", "limit", "condition", "sigma_min", "elbow", "wrist"
]
# Of these the greatest value is the worst, of the others the least.
_GREATEST: frozenset[MeasureName] = frozenset({"condition"})
SEARCHED = 0.5  # m: clearances above this are not measured, only known to be larger
SINGULAR_SIGMA = 1e-3  # smaller, on a linear move: a direction in which the TCP cannot go


@frozen
class Extreme:
    """The worst value of one measure so far.

    Args:
        measure: "robots", "scene", "self": clearance, m (inf: above `SEARCHED`); "contact": overlap of
            parts that may touch, m, negative; "limit": distance to a joint limit, rad; "condition";
            "sigma_min"; "elbow" and "wrist": angle from straight, rad.
        robot: which robot, or "a+b" for clearance between robots.
        value: see above.
        t: when, s.
        phase: the phase it happened in.
        pose: TCP pose of the robot in the world then.
        parts: for clearances, the two parts; for limits, the axis.
    """

    measure: MeasureName
    robot: str
    value: float
    t: float
    phase: str
    pose: Pose
    parts: tuple[str, ...] = ()


@frozen
class Fault:
    """Why the cell must stop: kind, message (robot, parts, pose), time."""

    kind: FaultKind
    robot: str
    message: str
    t: float
    pose: Pose


@frozen(eq=False)
class Sample:
    """One robot at one instant, or a device that moves, which has no arm."""

    robot: str
    q: Array
    pose: Pose
    conditioning: Conditioning
    limit_margin: float
    limit_axis: int
    is_device: bool = False


@frozen(eq=False)
class Verdict:
    """What one check found.

    Args:
        t: time, s.
        samples: of each robot.
        clearances: of each kind and robot the nearest pair of those that must keep apart in what the robots do now
            (`allowed` is None), and the contacts that they may make; None when the backend does not measure.
        fault: the first reason to stop, or None.
        warnings: all that must keep apart and is nearer than the scene's `warning_clearance`.
    """

    t: float
    samples: tuple[Sample, ...]
    clearances: tuple[Clearance, ...] | None
    fault: Fault | None
    warnings: tuple[Clearance, ...]


class Monitor:
    """Checks instants one after the other and keeps the extremes."""

    def __init__(self, cell: RobotCell, backend: Backend, *, searched: float = SEARCHED) -> None:
        self._cell, self._backend, self._searched = cell, backend, searched
        self._near = cell.scene.warning_clearance
        self._worst: dict[tuple[str, MeasureName, str], Extreme] = {}
        self._last: dict[str, Sample] = {}
        self._expected: dict[str, dict[bytes, Sample]] = {}
        self._bases = {r.name: r.T_world_base for r in cell.moving}
        self._devices = frozenset(r.name for r in cell.devices)
        self._tools = {r.name: r.begins_with for r in cell.moving}
        self._led = LedContacts(cell)

    def use(self, robot: str, tool: str) -> None:
        """Which of the tools that it changes a robot has in use from now on ("": none): poses are those of its TCP."""
        self._tools[robot] = tool
        self._last.pop(robot, None)
        self._expected.pop(robot, None)

    def check(
        self,
        t: float,
        joints: Mapping[str, Array],
        phase: str = "",
        kinds: Mapping[str, MotionKind] | None = None,
        calm: Collection[str] = (),
        turning: Collection[str] = (),
        led_to: Callable[[LedContact], Led] = lambda _contact: Led.NEAR,
    ) -> Verdict:
        """Puts the robots where they are at time `t` (s; joint positions in rad) and looks.

        Args:
            kinds: what each robot is doing (absent: standing). On a line or an arc a singularity is a
                fault; a joint move passes through one without noticing (the wrist does so often).
                On a joint move nothing may touch anything: parts that may come together do so only
                on lines and arcs and while the tool works.
            calm: the robots whose turntables stand: what is on these does not go with a joint move. What
                is on others touches no other robot, on lines and arcs neither.
            turning: turntables, belts and other axes that move, as `mill/lift`: what stands on these touches nothing
                of others either.
            led_to: what the line or arc that a robot is on has to do with a contact: of parts that its tool grips, and
                of what the part in its tool can be put on, only those are touched to which it leads, and these only
                near there. The same of what stands on a turntable or belt that moves.
        """
        kinds = kinds or {}
        t = float(t)
        samples = tuple(
            self._sample(r, joints[r.name]) for r in self._cell.moving if r.name in joints
        )
        for s in samples:
            self._backend.set_joints(s.robot, s.q)
        measured = self._backend.clearances(self._searched)
        poses = {s.robot: s.pose for s in samples}
        fault: Fault | None = None
        for s in samples:
            fault = fault or self._own_fault(s, t, kinds.get(s.robot) in PATHS)
            if s.robot in self._devices:
                continue
            c = s.conditioning
            axis = (self._cell.robot(s.robot).arm.axes[s.limit_axis],)
            self._note("limit", s, s.limit_margin, t, phase, axis)
            self._note("condition", s, c.condition, t, phase)
            self._note("sigma_min", s, c.sigma_min, t, phase)
            self._note("elbow", s, c.elbow, t, phase)
            self._note("wrist", s, c.wrist, t, phase)
        gaps, warnings = [], []
        for found in measured or ():
            others = (found.robot, found.second or found.b.split("/")[0])
            free = any(
                kinds.get(name) == "ptp" and not (name in found.rides and name in calm)
                for name in others
            )
            gap = replace(found, allowed=found.permitted(is_free=free))
            moves = any(kinds.get(x, "axis") != "axis" and x not in calm for x in found.rides)
            if found.kind == "robots" and (moves or any(p in turning for p in found.plates)):
                gap = replace(gap, allowed=None)  # a plate turns, under what the other one does
            contact = None if gap.allowed is None else self._contact(gap, kinds, turning)
            moved = turning if gap.kind != "scene" else ()  # the body of a belt stands
            if contact is not None:
                led = Led.ELSEWHERE if contact.other in moved else led_to(contact)
                gap = with_move(gap, led)  # nothing else is gripped, lifted or put down there
            gaps.append(gap)
            fault = fault or self._collision(gap, t, poses[gap.robot])
            if gap.allowed is not None and gap.distance >= 0.0:
                continue
            measure: MeasureName = gap.kind if gap.allowed is None else "contact"
            who = "+".join(others) if gap.kind == "robots" else gap.robot
            parts = (gap.a, gap.b)
            self._keep(Extreme(measure, who, gap.distance, t, phase, poses[gap.robot], parts))
            # A door is always near its frame, and a clamp near what it stands on.
            is_own = gap.robot in self._devices and gap.kind != "robots"
            if gap.allowed is None and not is_own and gap.distance < self._near:
                warnings.append(gap)
        clearances = None if measured is None else tuple(closest(gaps))
        return Verdict(t, samples, clearances, fault, tuple(warnings))

    def _contact(
        self, gap: Clearance, kinds: Mapping[str, MotionKind], turning: Collection[str]
    ) -> LedContact | None:
        """A contact that is permitted only if a move leads to it; None: it is permitted whatever moves."""
        found = self._led.between(gap.a, gap.b)
        if found is not None:
            is_moved = gap.kind != "scene" and found.other in turning
            return found if is_moved or kinds.get(found.robot) in PATHS else None
        is_rider = gap.kind == "scene" and gap.plates and gap.a not in gap.plates
        if not is_rider or gap.plates[0] not in turning or gap.b in turning:
            return None  # it stands, or goes on to a belt that runs as one with its own
        return self._led.of_rider(gap.a, gap.b, gap.plates[0])

    def minima(self, phase: str | None = None) -> tuple[Extreme, ...]:
        """The extremes of a phase (None: of the whole run), sorted by measure and robot."""
        wanted = "\0all" if phase is None else phase
        found = [e for (p, _, _), e in self._worst.items() if p == wanted]
        return tuple(sorted(found, key=lambda e: (e.measure, e.robot)))

    def phases(self) -> tuple[str, ...]:
        """The phases seen, in order."""
        seen = dict.fromkeys(p for p, _, _ in self._worst if p != "\0all")
        return tuple(seen)

    def expect(self, paths: Mapping[str, Array]) -> None:
        """Says which joint positions (n, 6) come next. Not needed; but many at once take less time than one by one."""
        for name, path in paths.items():
            self._expected[name] = {s.q.tobytes(): s for s in self._samples(name, path)}

    def _sample(self, robot: CellRobot, q: Array) -> Sample:
        q = np.asarray(q, float)
        last = self._last.get(robot.name)
        if last is None or not np.array_equal(last.q, q):
            last = self._expected.get(robot.name, {}).get(q.tobytes())
            last = last or next(self._samples(robot.name, q[None]))
            self._last[robot.name] = last
        return last

    def _samples(self, name: str, path: Array) -> Iterator[Sample]:
        robot = self._cell.robot(name)
        path = np.asarray(path, float)
        if len(path) > 1:  # for one, NumPy would load its masked arrays for nothing
            path = np.unique(path, axis=0)
        for q, frame, conditioning in zip(path, *robot.kinematics.states(path), strict=True):
            margin, axis = robot.kinematics.limit_margin(q)
            pose = pose_of(self._bases[name] @ robot.of_tool(self._tools[name], frame))
            yield Sample(name, q, pose, conditioning, margin, axis, name in self._devices)

    def _note(
        self, measure: MeasureName, s: Sample, value: float, t: float, phase: str,
        parts: tuple[str, ...] = (),
    ) -> None:  # fmt: skip
        self._keep(Extreme(measure, s.robot, value, t, phase, s.pose, parts))

    def _keep(self, e: Extreme) -> None:
        for phase in ("\0all", e.phase):
            key = (phase, e.measure, e.robot)
            old = self._worst.get(key)
            worse = old is None or (
                e.value > old.value if e.measure in _GREATEST else e.value < old.value
            )
            if worse:
                self._worst[key] = replace(e)

    def _own_fault(self, s: Sample, t: float, moving: bool) -> Fault | None:
        at = f"at TCP pose {describe(s.pose)}"
        if s.limit_margin < -1e-9:
            arm, i = self._cell.robot(s.robot).arm, s.limit_axis
            message = (
                f"{self._cell.robot(s.robot).words}: {arm.called(i)} is at {arm.shown(i, s.q[i])} {arm.unit(i)}, "
                f"{arm.shown(i, -s.limit_margin)} {arm.unit(i)} outside its limits, {at}"
            )
            return Fault("joint-limit", s.robot, message, t, s.pose)
        if moving and s.conditioning.sigma_min < SINGULAR_SIGMA:
            kinematics = self._cell.robot(s.robot).kinematics
            message = (
                f"robot `{s.robot}` is at a singularity (smallest singular value {s.conditioning.sigma_min:.1e}"
                f"{kinematics.straightness(s.conditioning.elbow, s.conditioning.wrist)}), {at}"
            )
            return Fault("singularity", s.robot, message, t, s.pose)
        return None

    def _collision(self, gap: Clearance, t: float, pose: Pose) -> Fault | None:
        depth = 1000.0 * -gap.distance
        where = ", ".join(f"{1000 * v:.0f}" for v in gap.point)
        if gap.is_early and gap.distance < 0.0:
            what = f"`{gap.a}` and `{gap.b}` collide ({depth:.1f} mm deep at {where} mm){EARLY}"
        elif gap.allowed is None and gap.distance <= 0.0:
            what = f"`{gap.a}` and `{gap.b}` collide ({depth:.1f} mm deep at {where} mm)"
        elif gap.allowed is not None and -gap.distance > gap.allowed:
            deep, most = told_apart(depth, 1000.0 * gap.allowed)
            what = f"`{gap.a}` is {deep} mm deep in `{gap.b}` at {where} mm, but only {most} mm are allowed"
        else:
            return None
        message = f"{self._cell.robot(gap.robot).words}: {what}"
        if gap.robot not in self._devices:
            message += f", at TCP pose {describe(pose)}"
        return Fault("collision", gap.robot, message, t, pose)
