"""Lock-step co-simulation: the compiled supervisor, the robots' script interpreters and the arms on
one simulated clock.

Time moves from event to event (a motion ends, a wait ends, the supervisor's net wants to be woken).
At each event everybody who
can go on does so, in a fixed order, until nobody can: the supervisor runs one cycle of its
execution scheme, then each robot's
interpreter runs until it waits for a file or starts a command. All messages go through the files of
the shared directory, written
and read by the code that would do so on a real cell. Between events the arms are sampled for
clearance, limits and singularity.

Nothing here reads the wall clock, so two runs give the same trace, byte for byte.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NoReturn, Protocol

import numpy as np

from pn2code.base.frozen import record
from pn2code.cell.partition import Partition
from pn2code.emission.output import Block, OutputFile
from pn2code.properties.failing import Failing
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
from pn2code.robot.commands import (
    Command,
    Handling,
    Move,
    MoveCircular,
    MoveExternal,
    MoveJoint,
    MoveLinear,
    Pose,
    ToolAction,
)
from pn2code.robot.executor import Motion, RobotExecutor, turned, turned_by
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.parts import PartChange, PartFault
from pn2code.robot.parts_table import PartKind
from pn2code.robot.riders import tilted
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, describe, matrix_of, pose_of
from pn2code.robot.zones import ZoneWatch
from pn2code.run.accuracy import distance, off_line
from pn2code.run.command_words import kind_and_label, words
from pn2code.run.device import DeviceExecutor
from pn2code.run.failing import failed_in
from pn2code.run.files import RobotFiles
from pn2code.run.hand import Said
from pn2code.run.handling import PartKeeper
from pn2code.run.record import (
    ActionRecord,
    ActivityRecord,
    BrokenZone,
    MessageRecord,
    PartRecord,
    RunRecord,
)
from pn2code.run.sensors import Sensors
from pn2code.run.stops import Stops
from pn2code.run.supervisor import SupervisorProcess
from pn2code.tdl.check import CheckedProgram
from pn2code.tdl.interpret import MOST_AT_ONCE, Interpreter
from pn2code.tdl.requests import (
    AwaitFile,
    Event,
    Execute,
    Fault,
    FileError,
    Finished,
    Marked,
    MessageConsumed,
    MessageWritten,
    Request,
    Scalar,
    Sense,
)
from pn2code.trace.growing import GrowingTrace


class Observer(Protocol):
    """Who watches a run: the progress line, the camera."""

    def begun(self, engine: Engine) -> None:
        """The arms stand at HOME, nothing has happened yet."""

    def advanced(self, engine: Engine) -> None:
        """Time has moved to `engine.now`; the commands that end now are finished."""

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this (rad) at time t."""

    def ended(self, engine: Engine) -> None:
        """The run is over; `engine.record` has the verdict."""


@record
class RobotRunner:
    """One robot or device: its script's interpreter, its arm if it has one, and what it is doing.

    Args:
        script: file name, for messages.
        blocks: which lines of the script implement which net element.
    """

    name: str
    script: str
    interpreter: Interpreter
    files: RobotFiles
    executor: RobotExecutor | DeviceExecutor
    blocks: tuple[Block, ...] = ()
    motion: Motion | None = None
    line: int = 0
    activity: str = ""
    waiting: AwaitFile | None = None
    asking: Sense | None = None
    finished: bool = False

    def element_at(self, line: int) -> str:
        """The net transition that a script line implements, "" if none."""
        inside = [b for b in self.blocks if b.kind == "transition" and b.first <= line <= b.last]
        return min(inside, key=lambda b: b.last - b.first).element if inside else ""

    def at(self, line: int) -> str:
        """A line of its script, for messages, with the net transition that it implements."""
        where = self.element_at(line)
        return f"{self.script}:{line}" + (f" (net transition {where})" if where else "")

    def tool_action(self) -> str:
        """The tool action under way, "" if none."""
        command = self.motion.command if self.motion else None
        return command.action if isinstance(command, ToolAction) else ""

    @property
    def arm(self) -> RobotExecutor | None:
        """What moves; None: a device."""
        return self.executor if isinstance(self.executor, RobotExecutor) else None

    def joints(self, t: float) -> Array:
        """Joint position (rad) of an arm at a time not before the last event."""
        assert self.arm is not None
        return self.arm.q if self.motion is None else self.motion.q(t)

    def path(self, times: Array) -> Array:
        """Joint positions (n, 6) of an arm at many times, none before the last event."""
        assert self.arm is not None
        if self.motion is None:
            return np.tile(self.arm.q, (len(times), 1))
        return self.motion.sample(times)


class CellStoppedError(Exception):
    """The cell must stop; the message says why, in full."""


class StoppedByHand(CellStoppedError):  # noqa: N818
    """Somebody wants the cell to stop."""


def _nobody() -> str:
    return ""


@dataclass(slots=True)
class Engine:
    """Runs a cell to its end.

    Args:
        record: filled on the way.
        supervisor: started in lock-step mode; supervisor_trace: the trace it writes.
        supervisor_depth: how many parts of a transition's name stand before the activity: 2 for
        "Cell.Supervisor.Approach.Send".
        robots: in the order of cell.toml; then the devices, which are robots without an arm.
        sensors: what decides what the net leaves open.
        partition: the net and its owners.
        cell, backend: the arms and what shows them.
        monitor: what is checked at each sample.
        interrupted: asked again and again; not "": who wants the cell to stop, and it stops safely.
        stops: whose commands are held up, and when; None: nobody's.
        failing: conditions that mean that the cell has failed.
    """

    record: RunRecord
    supervisor: SupervisorProcess
    supervisor_trace: GrowingTrace
    supervisor_depth: int
    partition: Partition
    cell: RobotCell
    backend: Backend
    monitor: Monitor
    robots: list[RobotRunner] = field(default_factory=list)
    sensors: Sensors = field(default_factory=Sensors)
    observers: list[Observer] = field(default_factory=list)
    interrupted: Callable[[], str] = _nobody
    stops: Stops | None = None
    failing: Failing = field(default_factory=Failing)
    now: float = 0.0
    activity: str = ""
    parts: PartKeeper = field(init=False)
    zones: ZoneWatch = field(init=False)
    _next_model_time: float | None = None
    _answer_due: float = math.inf
    _steps: Iterator[int] = field(default_factory=lambda: itertools.count(1))
    _finished: bool = False
    _activity_start: float = 0.0
    _ids: dict[str, str] = field(init=False)
    _commanded: dict[str, tuple[str, ...]] = field(init=False)
    _owner_of: dict[str, str] = field(init=False)
    _ordered_by: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Of each transition by name: its XML id, and to whom it writes messages."""
        divided = self.partition
        readers = {c.place: divided.owners[c.reader].name for c in divided.channels}
        self.parts = PartKeeper(self.cell, self.backend)
        self.zones = ZoneWatch(self.cell)
        self._ids = {t.name: t.id for t in divided.net.transitions}
        self._owner_of = {
            t.name: divided.owners[o].name
            for t, o in zip(divided.net.transitions, divided.transition_owner, strict=True)
        }
        self._commanded = {
            t.name: tuple({readers[a.place] for a in t.arcs if a.place in readers})
            for t in divided.net.transitions
        }

    def add_robot(
        self,
        name: str,
        script: OutputFile,
        program: CheckedProgram,
        files: RobotFiles,
        executor: RobotExecutor | DeviceExecutor,
    ) -> None:
        """Adds a robot or device; its script begins when the engine runs."""
        interpreter = Interpreter(program, files, self._heard)
        self.robots.append(
            RobotRunner(name, script.path, interpreter, files, executor, script.blocks)
        )

    def run(self) -> RunRecord:
        """Until the supervisor has finished and the robots rest; or until something stops the cell."""
        try:
            self._begin_run()
            without_time = 0
            while True:
                self._heed()
                self._exchange_messages()
                if self._finished and self._at_rest():
                    self.record.verdict = "finished"
                    break
                before = self.now
                self._advance(self._next_event())
                without_time = without_time + 1 if self.now <= before else 0
                if without_time > MOST_AT_ONCE:
                    self._repeats_without_time()
        except CellStoppedError as why:
            self._stop(why)
        return self._close()

    def _heed(self) -> None:
        """Stops the cell if somebody wants so."""
        if who := self.interrupted():
            raise StoppedByHand(f"stopped by {who}; {self._doing()}")

    def _repeats_without_time(self) -> NoReturn:
        busy = [r for r in self.robots if r.waiting is None and not r.finished]
        names = " and ".join(r.name for r in busy) or "a program"
        raise CellStoppedError(
            f"{names} carried out {MOST_AT_ONCE:,} commands at {self.now:.3f} s without time passing: a script repeats "
            "commands that take no time"
        )

    def _at_rest(self) -> bool:
        """Whether no arm moves. Devices may go on: they have nothing to bring to rest."""
        return all(r.motion is None for r in self._arms())

    def _arms(self) -> list[RobotRunner]:
        return [r for r in self.robots if r.arm is not None]

    def _begin_run(self) -> None:
        try:
            self.parts.begin()
        except PartFault as fault:
            raise CellStoppedError(str(fault)) from None
        self._sample(0.0, {r.name: r.joints(0.0) for r in self._arms()})
        for observer in self.observers:
            observer.begun(self)

    def _close(self) -> RunRecord:
        """The last lines of the record."""
        self.record.time = self.now
        if self.record.verdict == "finished":
            self.supervisor.close()  # its trace is complete then
            self.record.final = self._final_places()
            header, events = self.supervisor_trace.header, self.record.events
            self.record.failed = (
                *self.partition.failed(self.record.final),
                *failed_in(self.failing, self.partition, header, events),
            )
        end: dict[str, Any] = {"t": self.now, "event": "end", "why": self.record.verdict}
        if self.record.reason:
            end["reason"] = self.record.reason
        if self.record.final:
            end["final"] = list(self.record.final)
        self.record.events.append(end)
        self._close_activity(self.now)
        for observer in self.observers:
            observer.ended(self)
        return self.record

    def _final_places(self) -> tuple[str, ...]:
        """Where the supervisor has come to its end, as the last line of its trace says."""
        self.supervisor_trace.complete_lines()
        return tuple(self.supervisor_trace.end.get("final", ()))

    # --- one instant -------------------------------------------------------------------------

    def _exchange_messages(self) -> None:
        """Supervisor and robots exchange messages at this instant until nobody can go on."""
        for _ in range(MOST_AT_ONCE):
            moved = self._supervisor_cycle()
            for robot in self.robots:
                moved |= self._robot_turn(robot)
            if not moved:
                return
        raise CellStoppedError(
            f"supervisor and robots exchanged {MOST_AT_ONCE} messages at {self.now:.3f} s without time "
            "passing; one of them answers itself"
        )

    def _supervisor_cycle(self) -> bool:
        if self._finished:
            return False
        result = self.supervisor.step(self.now)
        for _ in range(result.fired):
            self._supervisor_fired()
        if result.stopped is not None:
            self._heed()  # Ctrl-C in a terminal reaches the supervisor as well
            raise CellStoppedError(f"the supervisor stopped: {result.stopped}")
        self._next_model_time = result.next_time
        self._answer_due = result.due
        self._finished = result.finished
        return result.fired > 0

    def _supervisor_fired(self) -> None:
        event = self.supervisor_trace.next_occurrence()
        self._occurrence(event)
        self._enter_activity(event, self.now)

    def _enter_activity(self, event: Mapping[str, Any], t: float) -> None:
        """The pages below the supervisor's own are its activities: a firing on another page ends one."""
        path = event["transition"].split(".")
        depth = self.supervisor_depth
        activity = path[depth] if len(path) > depth + 1 else ""
        if activity != self.activity:
            self._close_activity(t)
            self.activity = activity
            self._activity_start = t
        for reader in self._commanded.get(event["transition"], ()):
            self._ordered_by[reader] = self.activity

    def _pass_on(self, transition: str) -> None:
        """Whom a robot gives an order works for the activity for which the robot does."""
        activity = self._ordered_by.get(self._owner_of[transition])
        if activity is not None:
            self._ordered_by |= dict.fromkeys(self._commanded[transition], activity)

    def _close_activity(self, t: float) -> None:
        if self.activity:
            self.record.activities.append(ActivityRecord(self.activity, self._activity_start, t))
            self.activity = ""

    def _occurrence(self, event: dict[str, Any]) -> None:
        self.record.events.append({**event, "step": next(self._steps)})

    def _robot_turn(self, robot: RobotRunner) -> bool:
        """Runs a robot's script as far as it goes; whether it did anything."""
        if robot.motion is not None or robot.finished:
            return False
        if robot.waiting is not None:
            try:
                if not robot.files.any_holds(robot.waiting.names):
                    return False
            except FileError as problem:
                raise CellStoppedError(
                    f"{robot.script}:{robot.waiting.line}: {robot.name}: {problem}"
                ) from None
        self._follow(robot, None)
        return True

    def _follow(self, robot: RobotRunner, result: Pose | None) -> None:
        """Resumes the interpreter and acts on what it asks for."""
        robot.waiting = None
        self._heed_request(robot, robot.interpreter.resume(result))

    def _heed_request(self, robot: RobotRunner, request: Request) -> None:
        robot.asking = None
        while isinstance(request, Sense):
            said = self._sense(robot, request)
            if said is None:
                robot.asking = request
                return
            request = self._told(robot, request, said)
        if self._finished and isinstance(request, Execute):
            request = Finished()  # it notices that the supervisor has, and begins nothing more (I9)
        match request:
            case AwaitFile():
                robot.waiting = request
            case Execute(command=command, line=line):
                self._begin_command(robot, command, line)
            case Finished():
                robot.finished = True
                try:
                    robot.files.finished()  # the supervisor does not wait for its answers any more
                except FileError as problem:
                    raise CellStoppedError(f"{robot.script}: {robot.name}: {problem}") from None
            case Fault(message=message, line=line):
                raise CellStoppedError(f"{robot.script}:{line}: {robot.name}: {message}")

    def _sense(self, robot: RobotRunner, request: Sense) -> Said | None:
        """What a sensor says; None: that is not known yet."""
        return Said(self._sensor_says(robot, request))

    def _sensor_says(self, robot: RobotRunner, request: Sense) -> Scalar | None:
        looks = self.sensors.seen.get(request.sensor)
        if looks is not None:
            return self._sees(*looks, self.sensors.at.get(request.sensor, 0.0))
        return self.sensors.ask(robot.name, request.sensor)

    def _sees(self, name: str, kind: str, at: float) -> bool:
        """Whether a part is at a place, an arm in a zone, an axis of a device where it is seen."""
        self._look_at_turntables()
        joints = {r.name: r.joints(self.now) for r in self._arms()}
        device, dot, axis = name.partition(".")
        if dot:
            return self.cell.robot(device).is_at(axis, joints[device], at)
        if name in self.cell.zones:
            return self.zones.occupied(name, joints, self.parts.parts.present.values())
        return self.parts.parts.is_seen(name, kind)

    def _told(self, robot: RobotRunner, request: Sense, said: Said) -> Request:
        """A sensor has said something: what the script wants next."""
        note = {
            "t": self.now,
            "event": "sense",
            "robot": robot.name,
            "sensor": request.sensor,
            "value": said.value,
        }
        self.record.events.append({**note, "by": said.by} if said.by else note)
        return robot.interpreter.resume(said.value)

    def _begin_command(self, robot: RobotRunner, command: Command, line: int) -> None:
        try:
            motion = robot.executor.begin(self._stopped(robot, command), self.now)
        except MotionFault as fault:
            raise CellStoppedError(f"{robot.at(line)}: {fault}") from None
        self._expect_let_go(robot, motion, line)
        self._expect_riders_stay(robot, motion, line)
        if self.stops is not None:
            motion = self._held_up(robot, motion, self.stops)
        robot.motion, robot.line = motion, line
        robot.activity = self._ordered_by.get(robot.name, self.activity)
        if isinstance(command, ToolAction):
            self.record.events.append(
                {
                    "t": self.now,
                    "event": "tool",
                    "robot": robot.name,
                    "action": command.action,
                    "duration": command.duration,
                }
            )

    def _stopped(self, robot: RobotRunner, command: Command) -> Command:
        """Belts run until a part comes to their stop."""
        if robot.arm is None or not robot.arm.robot.is_device or not robot.arm.robot.carrying:
            return command
        self._look_at_turntables()
        return until_stop(robot.arm.robot, self.parts.parts, command)

    def _run_out(self, robot: RobotRunner, motion: Motion) -> None:
        """What belts that have come to rest have taken along stands there, or on something else."""
        if robot.arm is None or not robot.arm.robot.is_device:
            return
        line = turned_by(robot.arm.robot, motion.trajectory, robot.arm.robot.belts)
        if not line:
            return
        self._look_at_turntables()
        try:
            settled = self.parts.run_out(line)
        except PartFault as fault:
            raise CellStoppedError(f"{robot.at(robot.line)}: {fault}") from None
        for change in settled:
            self.record.parts.append(PartRecord(self.now, robot.name, change))

    def _expect_part(self, robot: RobotRunner, motion: Motion) -> None:
        """A clamp that has closed has a part between its jaws, standing there or in a tool."""
        if robot.arm is None or not isinstance(motion.command, MoveExternal):
            return
        device = robot.arm.robot
        ends = [motion.trajectory.q(t) for t in (0.0, motion.duration)]
        for held in closing(device, ends[0], ends[1]):
            self._look_at_turntables()
            joints = {r.name: r.joints(self.now) for r in self._arms()}
            there = self.parts.parts.everywhere(joints)
            near = nearest(self.cell, held, there)
            if near.off > 0.0:
                raise CellStoppedError(f"{robot.at(robot.line)}: {on_nothing(held, near)}")
        for held in shut(device, ends[0], ends[1]):
            self._expect_at_rest(robot, held)

    def _expect_at_rest(self, robot: RobotRunner, held: Held) -> None:
        """Nobody is on the way with the part on which a clamp has just closed."""
        parts = self.parts.parts.present.values()
        for other in self._arms():
            motion = other.motion
            if other.arm is None or motion is None or not isinstance(motion.command, Move):
                continue
            if motion.ends <= self.now + 1e-12:
                continue
            arm = other.arm.robot
            way = motion.trajectory.q(0.0), motion.q(self.now)
            why = closed_on(self.cell, held, arm, way, (parts, turned(arm, motion)))
            if why:
                raise CellStoppedError(f"{robot.at(robot.line)}: {why}")

    def _expect_let_go(self, robot: RobotRunner, motion: Motion, line: int) -> None:
        """What an arm, a turntable or a belt takes along is in no clamp that still holds it."""
        if robot.arm is None or not isinstance(motion.command, Move):
            return
        arm, q = robot.arm.robot, robot.arm.q
        present = self.parts.parts.present.values()
        stands = {r.name: r for r in self._arms()}
        for part, frame in taken_along(arm, q, present, turned(arm, motion)):
            for held in holding(self.cell, part.kind, frame):
                own = stands[held.device.name].joints(self.now)
                if held.holds(own):
                    why = held.words(robot.name, part.name, own)
                    raise CellStoppedError(
                        f"{robot.at(line)}: {why}, part at {describe(pose_of(frame))}"
                    )

    def _expect_riders_stay(self, robot: RobotRunner, motion: Motion, line: int) -> None:
        """What stands on a turntable that begins to turn stays there, or the cell stops."""
        if robot.arm is None:
            return
        belts = turned_by(robot.arm.robot, motion.trajectory, robot.arm.robot.belts)
        for plate in sorted(turned(robot.arm.robot, motion)):
            self._look_at_turntables()
            try:
                self.parts.parts.turn(plate, belts if plate in belts else frozenset())
            except PartFault as fault:
                raise CellStoppedError(f"{robot.at(line)}: {fault}") from None

    def _look_at_turntables(self) -> None:
        """Where they are now, and which of them turn, counts for what is handled."""
        parts = self.parts.parts
        turning: set[str] = set()
        for other in self._arms():
            assert other.arm is not None
            if other.arm.robot.axes.tables:
                parts.stand(other.name, other.joints(self.now))
                if other.motion is not None and other.motion.ends > self.now + 1e-12:
                    turning |= turned(other.arm.robot, other.motion)
        parts.turning = frozenset(turning)

    def _held_up(self, robot: RobotRunner, motion: Motion, stops: Stops) -> Motion:
        """The motion with the stops that are drawn for it."""
        held, seconds = stops.held_up(robot.name, motion.trajectory)
        for stop in seconds:
            event = {"t": self.now, "event": "stand", "robot": robot.name, "duration": stop}
            self.record.events.append(event)
        return replace(motion, trajectory=held) if seconds else motion

    # --- from instant to instant ---------------------------------------------------------------

    def _next_event(self) -> float:
        """When something happens next."""
        times = [r.motion.ends for r in self.robots if r.motion is not None]
        if self._next_model_time is not None and not self._finished:
            times.append(self._next_model_time)
        if not times:
            raise CellStoppedError(self._stuck())
        if not self._finished:
            # The supervisor stops for a late answer as soon as it is late, not when something else happens.
            times.append(math.nextafter(self._answer_due, math.inf))
        return max(self.now, min(times))

    def _stuck(self) -> str:
        waits = [
            f"{r.name} waits for {' or '.join(r.waiting.names)} ({r.script}:{r.waiting.line})"
            if r.waiting
            else f"{r.name} has ended"
            for r in self.robots
        ]
        return (
            f"the cell is stuck at {self.now:.3f} s: the supervisor has nothing to do and waits for the robots, "
            + ", ".join(waits)
        )

    def _advance(self, target: float) -> None:
        """Moves time to `target`, sampling the arms on the way, and ends the commands that end then."""
        times = self._instants(target)
        paths = {r.name: r.path(times) for r in self._arms()}
        self.monitor.expect(paths)
        for i, t in enumerate(times):
            self._sample(float(t), {name: path[i] for name, path in paths.items()})
        self.now = target
        for robot in self.robots:
            if robot.motion is not None and robot.motion.ends <= target + 1e-12:
                self._finish(robot)
        for observer in self.observers:
            observer.advanced(self)

    def _instants(self, target: float) -> Array:
        """When to look between now and `target`, which is the last: as often as the most delicate motion wants."""
        steps = [r.motion.step for r in self.robots if r.motion is not None]
        span = target - self.now
        count = max(1, math.ceil(span / min(steps) - 1e-9)) if steps else 1
        times = self.now + span * np.arange(1, count + 1) / count
        times[-1] = target
        return times

    def _finish(self, robot: RobotRunner) -> None:
        """The command is done: the script goes on."""
        motion = robot.motion
        assert motion is not None
        self._note_action(robot, self.now)
        robot.executor.finish()
        robot.motion = None
        if robot.arm is not None and isinstance(
            motion.command, MoveJoint | MoveLinear | MoveCircular
        ):
            arm = robot.arm.robot
            reached = pose_of(arm.T_world_base @ arm.kinematics.forward(robot.arm.q))
            self.record.note_error("TCP off the commanded pose", distance(reached, motion.target))
        self._run_out(robot, motion)
        self._expect_part(robot, motion)
        if isinstance(motion.command, ToolAction) and motion.command.handling is not None:
            self._handle(robot, motion.command.handling)
        self._follow(robot, motion.result)

    def _handle(self, robot: RobotRunner, handling: Handling) -> None:
        """What an action that has ended has done to a part."""
        tcp = matrix_of(robot.arm.pose) if robot.arm is not None else None
        self._look_at_turntables()
        try:
            change = self.parts.handle(robot.name, handling, tcp)
        except PartFault as fault:
            raise CellStoppedError(f"{robot.at(robot.line)}: {fault}") from None
        if change.effect == "removes":
            self._expect_unclamped(robot, self.cell.parts[handling.part], change)
        if robot.arm is not None:
            self.monitor.use(robot.name, robot.arm.tool)
        for one in (change, *self.parts.parts.settled):
            self.record.parts.append(PartRecord(self.now, robot.name, one))
        self.record.events.append(
            {
                "t": self.now,
                "event": "part",
                "robot": robot.name,
                "effect": change.effect,
                "part": change.part,
            }
        )

    def _expect_unclamped(self, robot: RobotRunner, kind: PartKind, change: PartChange) -> None:
        """A part that leaves the cell is in no clamp that holds it."""
        stands = {r.name: r for r in self._arms()}
        for held in holding(self.cell, kind, matrix_of(change.pose)):
            q = stands[held.device.name].joints(self.now)
            if held.holds(q):
                why = held.words(robot.name, change.part, q, "removes")
                raise CellStoppedError(
                    f"{robot.at(robot.line)}: {why}, part at {describe(change.pose)}"
                )

    def _heard(self, event: Event) -> None:
        """Events of an interpreter: occurrences of net transitions, messages consumed and written."""
        match event:
            case Marked(transition=name, binding=binding):
                self._occurrence(
                    {
                        "t": self.now,
                        "transition": name,
                        "binding": binding,
                        "origin": self._ids.get(name, ""),
                    }
                )
                self._pass_on(name)
            case MessageConsumed(file=channel, values=values):
                message = MessageRecord(self.now, channel, values)
                self.record.messages.append(message)
                self.record.traffic.append(("taken", message))
            case MessageWritten(file=channel, values=values):
                written = MessageRecord(self.now, channel, values)
                self.record.traffic.append(("written", written))
            case _:
                pass

    def _note_action(self, robot: RobotRunner, end: float) -> None:
        motion = robot.motion
        assert motion is not None
        kind, label = kind_and_label(motion.command)
        self.record.actions.append(
            ActionRecord(
                robot.name,
                kind,
                label,
                motion.began,
                end,
                robot.line,
                robot.element_at(robot.line),
                robot.activity,
            )
        )

    def _sample(self, t: float, joints: Mapping[str, Array]) -> None:
        """Looks at the arms at time t; a collision, a violated limit or a singularity stops the cell."""
        kinds = {r.name: r.motion.kind for r in self.robots if r.motion is not None}
        calm = [
            r.name
            for r in self.robots
            if r.motion is not None and r.arm is not None and not turned(r.arm.robot, r.motion)
        ]
        turning = frozenset[str]().union(
            *(
                turned(r.arm.robot, r.motion)
                for r in self.robots
                if r.motion is not None and r.arm is not None
            )
        )
        verdict = self.monitor.check(t, joints, self.activity, kinds, calm, turning)
        self.record.sample(verdict)
        for robot, seen in zip(self._arms(), verdict.samples, strict=True):
            if robot.motion is not None and robot.motion.kind == "lin":
                off = off_line(robot.motion, seen)
                self.record.note_error("off the line on linear moves", off)
        for observer in self.observers:
            observer.sampled(self, t, joints)
        if verdict.fault is not None:
            self.now = t
            raise CellStoppedError(f"{verdict.fault.message}; {self._doing()}")
        self._expect_level(t, joints)
        self._expect_slow(t, joints)

    def _expect_level(self, t: float, joints: Mapping[str, Array]) -> None:
        """What stands on a part that is carried does not slide off."""
        present = self.parts.parts.present.values()
        if all(p.up is None for p in present):
            return
        for name, q in joints.items():
            if why := tilted(self.cell.robot(name), q, present):
                self.now = t
                raise CellStoppedError(f"{why}; {self._doing()}")

    def _expect_slow(self, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing is faster in a zone than may be there."""
        if not self.zones.limited:
            return
        parts = self.parts.parts.present.values()
        moving = {r.name: r.motion for r in self._arms() if r.motion is not None}
        there = {name: joints[name] for name in moving}
        speeds = {
            name: moving[name].trajectory.qd(t - moving[name].began)
            for name in self.zones.in_limited(there, parts)
        }
        found = self.zones.too_fast({n: joints[n] for n in speeds}, speeds, parts)
        if found is not None:
            self.now = t
            self.record.too_fast = BrokenZone(
                found.zone.name, t, found.link, found.speed, found.point
            )
            self.backend.light_zone(found.zone.name)
            who = self.cell.robot(found.robot).words
            raise CellStoppedError(f"{who}: {found.words()}; {self._doing()}")

    def _doing(self) -> str:
        """What everybody was doing, for messages: script line, net transition, command."""
        parts = []
        for r in self.robots:
            if r.motion is None:
                parts.append(f"{r.name} at rest")
                continue
            parts.append(f"{r.at(r.line)}: {r.name}: {words(r.motion.command, _slides(r))}")
        return "under way: " + "; ".join(parts)

    def _stop(self, problem: CellStoppedError) -> None:
        """Everybody comes to rest; what was under way is recorded as cut short."""
        why = str(problem)
        self.record.verdict = "stopped" if isinstance(problem, StoppedByHand) else "failed"
        self.record.reason = why
        for robot in self.robots:
            if robot.motion is not None:
                self._note_action(robot, self.now)
                robot.executor.stop(self.now)
                robot.motion = None
            robot.files.stopped(why)
        self.supervisor.stop(why)


def _slides(robot: RobotRunner) -> tuple[bool, ...]:
    """Which axes of an arm slide."""
    return () if robot.arm is None else tuple(robot.arm.robot.kinematics.alone.slides.tolist())
