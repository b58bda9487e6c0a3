"""What is around the arms while a cell runs: parts, clamps, turntables, belts, zones.

    around = Surroundings(cell, backend, robots)
    around.begin()                                   # the parts of the start
    around.expect_free(robot, motion, line, now)     # a motion begins: nothing that it takes along is held or in use
    around.run_out(robot, motion, now)               # it has ended: where what belts have taken along stands
    around.expect_part(robot, motion, now)           # ... and a clamp that has closed has gripped something
    around.handle(robot, handling, now)              # a tool's action has ended

What must not be raises `CellStoppedError` with the line of the script at which it is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from pn2code.robot.active_motion import Motion, turned, turned_by
from pn2code.robot.backend import Backend
from pn2code.robot.belts import until_stop
from pn2code.robot.clamps import (
    Held,
    closed_on,
    closing,
    holding,
    nearest,
    on_nothing,
    shut,
    taken_along,
)
from pn2code.robot.commands import Command, Handling, Move, MoveExternal
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContact, LedContacts
from pn2code.robot.part import PartChange, PartFault
from pn2code.robot.parts import Parts
from pn2code.robot.parts_table import PartKind
from pn2code.robot.riders import tilted
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, describe, matrix_of, pose_of
from pn2code.robot.zones import TooFast, ZoneWatch
from pn2code.run.handling import PartKeeper
from pn2code.run.runner import CellStoppedError, RobotRunner


@dataclass(slots=True)
class Surroundings:
    """What is around the arms of a run. `robots`: all that run, devices too; the run adds to them before it begins."""

    cell: RobotCell
    backend: Backend
    robots: Sequence[RobotRunner]
    _keeper: PartKeeper = field(init=False)
    _zones: ZoneWatch = field(init=False)
    _led: LedContacts = field(init=False)
    _ends: dict[str, tuple[Motion, MoveEnds]] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        """The parts of the start; nothing is shown yet."""
        self._keeper = PartKeeper(self.cell, self.backend)
        self._zones = ZoneWatch(self.cell)
        self._led = LedContacts(self.cell)

    @property
    def parts(self) -> Parts:
        """All parts that are there."""
        return self._keeper.parts

    def arms(self) -> list[RobotRunner]:
        """Whatever moves."""
        return [r for r in self.robots if r.arm is not None]

    def begin(self) -> None:
        """Shows the parts of the start."""
        try:
            self._keeper.begin()
        except PartFault as fault:
            raise CellStoppedError(str(fault)) from None

    def look(self, now: float) -> dict[str, Array]:
        """Where turntables are now, and which of them turn, counts for what is handled. Joint positions of all arms."""
        stands = {r.name: r.joints(now) for r in self.arms()}
        turning: set[str] = set()
        for other in self.arms():
            assert other.arm is not None
            if other.arm.robot.axes.tables:
                self.parts.stand(other.name, stands[other.name])
                if other.motion is not None and other.is_moving(now):
                    turning |= turned(other.arm.robot, other.motion)
        self.parts.turning = frozenset(turning)
        return stands

    # --- a motion begins -----------------------------------------------------------------------

    def until_stop(self, robot: RobotRunner, command: Command, now: float) -> Command:
        """Belts run until a part comes to their stop."""
        if robot.arm is None or not robot.arm.robot.is_device or not robot.arm.robot.carrying:
            return command
        self.look(now)
        return until_stop(robot.arm.robot, self.parts, command)

    def expect_free(self, robot: RobotRunner, motion: Motion, line: int, now: float) -> None:
        """Nothing that a motion takes along is in a clamp, or slides off a turntable."""
        self._expect_let_go(robot, motion, line, now)
        self._expect_riders_stay(robot, motion, line, now)

    def _expect_let_go(self, robot: RobotRunner, motion: Motion, line: int, now: float) -> None:
        """What an arm, a turntable or a belt takes along is in no clamp that still holds it."""
        if robot.arm is None or not isinstance(motion.command, Move):
            return
        arm, q = robot.arm.robot, robot.arm.q
        present = self.parts.present.values()
        for part, frame in taken_along(arm, q, present, turned(arm, motion)):
            if why := self._held(part.kind, frame, (robot.name, part.name, "pulls"), now):
                at = describe(pose_of(frame))
                raise CellStoppedError(f"{robot.at(line)}: {why}, part at {at}")

    def _expect_riders_stay(
        self, robot: RobotRunner, motion: Motion, line: int, now: float
    ) -> None:
        """What stands on a turntable that begins to turn stays there, or the cell stops."""
        if robot.arm is None:
            return
        belts = turned_by(robot.arm.robot, motion.trajectory, robot.arm.robot.belts)
        for plate in sorted(turned(robot.arm.robot, motion)):
            self.look(now)
            try:
                self.parts.turn(plate, belts if plate in belts else frozenset())
            except PartFault as fault:
                raise CellStoppedError(f"{robot.at(line)}: {fault}") from None

    def led_to(
        self, robot: RobotRunner, contact: LedContact, joints: Mapping[str, Array], now: float
    ) -> Led:
        """What the move that is under way has to do with a contact; `joints`: where all stand."""
        motion, arm = robot.motion, robot.arm
        assert motion is not None and arm is not None, "an arm moves"
        if robot.name not in self._ends or self._ends[robot.name][0] is not motion:
            made = MoveEnds.of(arm.robot, arm.tool, motion.trajectory, motion.kind)
            self._ends[robot.name] = motion, made
        present = self.parts.present
        touching = present.get(contact.part), present.get(contact.other)
        ends = self._ends[robot.name][1]
        at = motion.trajectory.fraction(now - motion.began)
        return self._led.of_move(contact, ends, touching, lambda name: joints[name], (at, at))

    # --- a motion has ended --------------------------------------------------------------------

    def run_out(self, robot: RobotRunner, motion: Motion, now: float) -> tuple[PartChange, ...]:
        """What belts that have come to rest have taken along stands there, or on something else."""
        if robot.arm is None or not robot.arm.robot.is_device:
            return ()
        line = turned_by(robot.arm.robot, motion.trajectory, robot.arm.robot.belts)
        if not line:
            return ()
        self.look(now)
        try:
            return self._keeper.run_out(line)
        except PartFault as fault:
            raise CellStoppedError(f"{robot.at(robot.line)}: {fault}") from None

    def expect_part(self, robot: RobotRunner, motion: Motion, now: float) -> None:
        """A clamp that has closed has a part between its jaws, standing there or in a tool."""
        if robot.arm is None or not isinstance(motion.command, MoveExternal):
            return
        device = robot.arm.robot
        ends = [motion.trajectory.q(t) for t in (0.0, motion.duration)]
        for held in closing(device, ends[0], ends[1]):
            near = nearest(self.cell, held, self.parts.everywhere(self.look(now)))
            if near.off > 0.0:
                raise CellStoppedError(f"{robot.at(robot.line)}: {on_nothing(held, near)}")
        for held in shut(device, ends[0], ends[1]):
            self._expect_at_rest(robot, held, now)

    def _expect_at_rest(self, robot: RobotRunner, held: Held, now: float) -> None:
        """Nobody is on the way with the part on which a clamp has just closed."""
        parts = self.parts.present.values()
        for other in self.arms():
            motion = other.motion
            if other.arm is None or motion is None or not isinstance(motion.command, Move):
                continue
            if not other.is_moving(now):
                continue
            arm = other.arm.robot
            ends = motion.trajectory.q(0.0), motion.q(now)
            why = closed_on(self.cell, held, arm, ends, (parts, turned(arm, motion)))
            if why:
                raise CellStoppedError(f"{robot.at(robot.line)}: {why}")

    def handle(
        self, robot: RobotRunner, handling: Handling, now: float
    ) -> tuple[PartChange, tuple[PartChange, ...]]:
        """What an action that has ended has done to its part, and to those that stood on it."""
        tcp = matrix_of(robot.arm.pose) if robot.arm is not None else None
        self.look(now)
        try:
            change = self._keeper.handle(robot.name, handling, tcp)
        except PartFault as fault:
            raise CellStoppedError(f"{robot.at(robot.line)}: {fault}") from None
        if change.effect == "removes":
            kind, frame = self.cell.parts[handling.part], matrix_of(change.pose)
            if why := self._held(kind, frame, (robot.name, change.part, "removes"), now):
                at = describe(change.pose)
                raise CellStoppedError(f"{robot.at(robot.line)}: {why}, part at {at}")
        return change, tuple(self.parts.settled)

    def _held(
        self, kind: PartKind | ToolKind, frame: Array, does: tuple[str, str, str], now: float
    ) -> str:
        """Which clamp holds a part that somebody takes away, for people; "": none. `does`: who, which part, how."""
        who, part, verb = does
        stands = {r.name: r for r in self.arms()}
        for held in holding(self.cell, kind, frame):
            q = stands[held.device.name].joints(now)
            if held.holds(q):
                return held.words(who, part, q, verb)
        return ""

    # --- while time goes on --------------------------------------------------------------------

    def sees(self, name: str, kind: str, at: float, now: float) -> bool:
        """Whether a part is at a place, an arm in a zone, an axis of a device where it is seen."""
        stands = self.look(now)
        device, dot, axis = name.partition(".")
        if dot:
            return self.cell.robot(device).is_at(axis, stands[device], at)
        if name in self.cell.zones:
            return self._zones.occupied(name, stands, self.parts.present.values())
        return self.parts.is_seen(name, kind)

    def slides_off(self, joints: Mapping[str, Array]) -> str:
        """Why what stands on a part that is carried slides off; "" if nothing does."""
        present = self.parts.present.values()
        if all(p.up is None for p in present):
            return ""
        for name, q in joints.items():
            if why := tilted(self.cell.robot(name), q, present):
                return why
        return ""

    def too_fast(self, t: float, joints: Mapping[str, Array]) -> TooFast | None:
        """What is faster in a zone at a time than may be there."""
        if not self._zones.limited:
            return None
        parts = self.parts.present.values()
        moving = {r.name: r.motion for r in self.arms() if r.motion is not None}
        there = {name: joints[name] for name in moving}
        speeds = {
            name: moving[name].trajectory.qd(t - moving[name].began)
            for name in self._zones.in_limited(there, parts)
        }
        return self._zones.too_fast({n: joints[n] for n in speeds}, speeds, parts)
