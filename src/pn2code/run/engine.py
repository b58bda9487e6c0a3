"""Lock-step co-simulation: the compiled supervisor, the robots' script interpreters, the arms, on one simulated clock.

Time moves from event to event (a motion ends, a wait ends, the supervisor's net wants to be woken). At each event
everybody who can go on does so, in a fixed order, until nobody can: the supervisor runs one cycle of its execution
scheme, then each robot's interpreter runs until it waits for a file or starts a command. All messages go through the
files of the shared directory, written and read by the code that would do so on a real cell. Between events the arms are
sampled for clearance, limits and singularity.

Nothing here reads the wall clock, so two runs give the same trace, byte for byte.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from pn2code.cell.partition import Partition
from pn2code.emission.output import OutputFile
from pn2code.properties.failing import Failing
from pn2code.robot.active_motion import Motion, turned
from pn2code.robot.backend import Backend
from pn2code.robot.commands import (
    Command,
    Handling,
    MoveCircular,
    MoveJoint,
    MoveLinear,
    Pose,
    ToolAction,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.led_contacts import Led, LedContact
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array, pose_of
from pn2code.run.accuracy import distance, off_line
from pn2code.run.activities import Activities
from pn2code.run.command_words import kind_and_label
from pn2code.run.device import DeviceExecutor
from pn2code.run.doings import doings, repeats_without_time, stuck
from pn2code.run.failing import failed_in
from pn2code.run.files import RobotFiles
from pn2code.run.hand import Said
from pn2code.run.observer import Observer
from pn2code.run.record import ActionRecord, BrokenZone, MessageRecord, PartRecord, RunRecord
from pn2code.run.runner import CellStoppedError, RobotRunner, StoppedByHand
from pn2code.run.sensors import Sensors
from pn2code.run.stops import Stops
from pn2code.run.supervisor import SupervisorProcess
from pn2code.run.surroundings import Surroundings
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


def _nobody() -> str:
    return ""


@dataclass(slots=True)
class Engine:
    """Runs a cell to its end.

    Args:
        record: filled on the way.
        supervisor: started in lock-step mode; supervisor_trace: the trace it writes.
        supervisor_depth: see `Activities`.
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
    activities: Activities = field(init=False)
    around: Surroundings = field(init=False)
    _next_model_time: float | None = None
    _answer_due: float = math.inf
    _steps: Iterator[int] = field(default_factory=lambda: itertools.count(1))
    _finished: bool = False
    _ids: dict[str, str] = field(init=False)

    def __post_init__(self) -> None:
        """What goes with the cell and its net."""
        self.around = Surroundings(self.cell, self.backend, self.robots)
        self.activities = Activities(self.partition, self.supervisor_depth, self.record.activities)
        self._ids = {t.name: t.id for t in self.partition.net.transitions}

    @property
    def activity(self) -> str:
        """The activity of the supervisor that is under way; "": none."""
        return self.activities.now

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
                    raise CellStoppedError(
                        repeats_without_time(self.robots, self.now, MOST_AT_ONCE)
                    )
        except CellStoppedError as why:
            self._stop(why)
        return self._close()

    def _heed(self) -> None:
        """Stops the cell if somebody wants so."""
        if who := self.interrupted():
            raise StoppedByHand(f"stopped by {who}; {doings(self.robots)}")

    def _at_rest(self) -> bool:
        """Whether no arm moves. Devices may go on: they have nothing to bring to rest."""
        return all(r.motion is None for r in self.around.arms())

    def _begin_run(self) -> None:
        self.around.begin()
        self._sample(0.0, {r.name: r.joints(0.0) for r in self.around.arms()})
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
        self.activities.close(self.now)
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
            "passing; they may go on so for ever"
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
        self.activities.fires(event["transition"], self.now)

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
            return self.around.sees(*looks, self.sensors.at.get(request.sensor, 0.0), self.now)
        return self.sensors.ask(robot.name, request.sensor)

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
            motion = robot.executor.begin(
                self.around.until_stop(robot, command, self.now), self.now
            )
        except MotionFault as fault:
            raise CellStoppedError(f"{robot.at(line)}: {fault}") from None
        self.around.expect_free(robot, motion, line, self.now)
        if self.stops is not None:
            motion = self._held_up(robot, motion, self.stops)
        robot.motion, robot.line = motion, line
        robot.activity = self.activities.of(robot.name)
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
            raise CellStoppedError(stuck(self.robots, self.now))
        if not self._finished:
            # The supervisor stops for a late answer as soon as it is late, not when something else happens.
            times.append(math.nextafter(self._answer_due, math.inf))
        return max(self.now, min(times))

    def _advance(self, target: float) -> None:
        """Moves time to `target`, sampling the arms on the way, and ends the commands that end then."""
        times = self._instants(target)
        paths = {r.name: r.path(times) for r in self.around.arms()}
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
        for change in self.around.run_out(robot, motion, self.now):
            self.record.parts.append(PartRecord(self.now, robot.name, change))
        self.around.expect_part(robot, motion, self.now)
        if isinstance(motion.command, ToolAction) and motion.command.handling is not None:
            self._handle(robot, motion.command.handling)
        self._follow(robot, motion.result)

    def _handle(self, robot: RobotRunner, handling: Handling) -> None:
        """What an action that has ended has done to a part."""
        change, settled = self.around.handle(robot, handling, self.now)
        if robot.arm is not None:
            self.monitor.use(robot.name, robot.arm.tool)
        for one in (change, *settled):
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
                self.activities.pass_on(name)
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
        turns = {
            r.name: turned(r.arm.robot, r.motion)
            for r in self.robots
            if r.motion is not None and r.arm is not None
        }
        calm = [name for name, plates in turns.items() if not plates]
        turning = frozenset[str]().union(*turns.values())
        verdict = self.monitor.check(
            t, joints, self.activity, kinds, calm, turning, lambda x: self._led_to(x, joints, t)
        )
        self.record.sample(verdict)
        for robot, seen in zip(self.around.arms(), verdict.samples, strict=True):
            if robot.motion is not None and robot.motion.kind == "lin":
                off = off_line(robot.motion, seen)
                self.record.note_error("off the line on linear moves", off)
        for observer in self.observers:
            observer.sampled(self, t, joints)
        if verdict.fault is not None:
            self.now = t
            raise CellStoppedError(f"{verdict.fault.message}; {doings(self.robots)}")
        if why := self.around.slides_off(joints):
            self.now = t
            raise CellStoppedError(f"{why}; {doings(self.robots)}")
        self._expect_slow(t, joints)

    def _led_to(self, contact: LedContact, joints: Mapping[str, Array], t: float) -> Led:
        """What the line or arc that a robot is on has to do with a contact at time t."""
        runner = next(r for r in self.robots if r.name == contact.robot)
        return self.around.led_to(runner, contact, joints, t)

    def _expect_slow(self, t: float, joints: Mapping[str, Array]) -> None:
        """Nothing is faster in a zone than may be there."""
        found = self.around.too_fast(t, joints)
        if found is None:
            return
        self.now = t
        self.record.too_fast = BrokenZone(found.zone.name, t, found.link, found.speed, found.point)
        self.backend.light_zone(found.zone.name)
        who = self.cell.robot(found.robot).words
        raise CellStoppedError(f"{who}: {found.words()}; {doings(self.robots)}")

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
