"""The same cell on the wall clock: the supervisor runs by itself, woken by the files, as on a real cell.

Messages, scripts, arms and checks are those of the lock-step engine; only time is real. A file that cannot be taken is
given the grace of the protocol (I6), a dead or stopped supervisor stops the robots (I8, I9).
"""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from pn2code.channels import LOOK_S, PeerState
from pn2code.robot.active_motion import Motion
from pn2code.robot.commands import Command
from pn2code.run.choices import permitted
from pn2code.run.command_words import kind_and_label
from pn2code.run.engine import Engine
from pn2code.run.hand import BY, Hand, Said
from pn2code.run.late_files import Fate, LateFiles
from pn2code.run.punctuality import Punctuality
from pn2code.run.record import Interference, RunRecord
from pn2code.run.runner import CellStoppedError, RobotRunner
from pn2code.run.stops import paused, resumed
from pn2code.tdl.requests import Event, FileError, MessageConsumed, MessageWritten, Request, Sense
from pn2code.trace.merge import merge

PAUSE_S = 0.001
"""Between two looks at the files: the cycle time of a robot controller's background task."""


@dataclass(slots=True)
class RealtimeEngine(Engine):
    """Runs a cell in real time. `supervisor` was started without lock-step.

    Args:
        speed: seconds of the arms, and of model time, per second of the wall clock.
        punctuality: how long the supervisor took for its answers, and how late ends of commands were noticed.
        fired: what the supervisor has done so far, as lines of a trace.
        noted: what robots and devices have done so far, in the same form.
        hand: of a person who may decide what sensors say, and make things fail; None: nobody does.
    """

    speed: float = 1.0
    punctuality: Punctuality = field(default_factory=Punctuality)
    fired: list[dict[str, Any]] = field(default_factory=list)
    noted: list[dict[str, Any]] = field(default_factory=list)
    hand: Hand | None = None
    _looked: float = 0.0
    _began: float = 0.0
    _sampled: float = 0.0
    _lost: set[str] = field(default_factory=set)

    def run(self) -> RunRecord:
        """Until the supervisor has finished and the robots rest; or until something stops the cell."""
        self._began = time.perf_counter()
        self.noted = self.record.events
        try:
            self._begin_run()
            while True:
                self._heed()
                self._look_at_the_clock()
                if self.hand is not None:
                    self.hand.look(self)
                    self._deliver()
                self._end_commands()
                moved = [self._robot_turn(robot) for robot in self.robots]
                if self._look_at_supervisor() and self._at_rest():
                    self.record.verdict = "finished"
                    break
                if self.now - self._sampled >= self.cell.motion.sample:
                    self._sampled = self.now
                    self._sample(self.now, {r.name: r.joints(self.now) for r in self.around.arms()})
                    for observer in self.observers:
                        observer.advanced(self)
                if not any(moved):
                    time.sleep(PAUSE_S)
        except CellStoppedError as why:
            self._stop(why)
        return self._close()

    def _close(self) -> RunRecord:
        """Waits for the supervisor's last words, then puts both traces into one order."""
        if self.hand is not None:
            self.hand.ended(self)
        self.supervisor.close()
        self._read_trace()
        merged = merge(self.partition, (self.fired, self.noted))
        occurrences = itertools.count(1)
        self.record.events = [
            {**line, "step": next(occurrences)} if "transition" in line else line for line in merged
        ]
        return Engine._close(self)

    def _read_trace(self) -> None:
        for line in self.supervisor_trace.complete_lines():
            if "transition" in line:
                t = float(line["t"]) * self.speed
                self.fired.append({**line, "t": t})
                self.activities.fires(line["transition"], t)

    def _look_at_the_clock(self) -> None:
        self.now = (time.perf_counter() - self._began) * self.speed

    def _begin_command(self, robot: RobotRunner, command: Command, line: int) -> None:
        """A wait is as long as it says after the messages before it, however late this turn is."""
        self._read_trace()  # who has ordered it
        self._look_at_the_clock()
        Engine._begin_command(self, robot, command, line)

    def _heard(self, event: Event) -> None:
        """A message to the supervisor begins an answer, the next message from it ends it."""
        match event:
            case MessageWritten(file=channel) if channel in self._lost:
                self._lost.discard(channel)
            case MessageWritten(file=channel):
                self.punctuality.asked(channel)
            case MessageConsumed(file=channel):
                self.punctuality.answered(channel)
            case _:
                pass
        Engine._heard(self, event)

    # --- a person's hand ---------------------------------------------------------------------------

    def _robot_turn(self, robot: RobotRunner) -> bool:
        """Who is held does nothing; who has asked a person waits for the answer."""
        if self.hand is None:
            return Engine._robot_turn(self, robot)
        if self.hand.holds(robot.name):
            return False
        if robot.asking is None:
            return Engine._robot_turn(self, robot)
        is_seen = robot.asking.sensor in self.sensors.seen
        sees = partial(self._sensor_says, robot, robot.asking) if is_seen else None
        said = self.hand.answer(robot.name, sees)
        if said is None:
            return False
        self._heed_request(robot, self._told(robot, robot.asking, said))
        return True

    def _sense(self, robot: RobotRunner, request: Sense) -> Said | None:
        own = self._sensor_says(robot, request)
        if self.hand is None:
            return Said(own)
        return self.hand.asked(
            robot.name,
            request.sensor,
            own,
            partial(permitted, robot.interpreter, robot.files),
            request.line,
        )

    def _told(self, robot: RobotRunner, request: Sense, said: Said) -> Request:
        if said.by or said.why:
            text = said.why or f"sensor {request.sensor}: {said.value}, chosen by a person"
            self._interfered(robot.name, text)
        return Engine._told(self, robot, request, said)

    def _interfered(self, party: str, text: str) -> None:
        self.record.by_hand.append(Interference(self.now, party, text))

    def _named(self, party: str) -> RobotRunner | None:
        return next((r for r in self.robots if r.name == party), None)

    def stand(self, party: str) -> None:
        """A robot or device stands still, in the middle of what it does."""
        robot = self._named(party)
        if robot is None:
            return
        if robot.motion is not None:
            self._put(robot, paused(robot.motion, self.now))
        self.record.events.append({"t": self.now, "event": "hold", "robot": party, "by": BY})
        self._interfered(party, "held from here on")

    def go_on(self, party: str, seconds: float) -> None:
        """It goes on where it was; it has stood so long (s of the wall clock)."""
        robot = self._named(party)
        if robot is None:
            return
        if robot.motion is not None:
            self._put(robot, resumed(robot.motion, self.now))
        self._has_stood(party, seconds)

    def stood(self, party: str, seconds: float) -> None:
        """It still stands at the end of the run."""
        self._has_stood(party, seconds, ", until the run ended")

    def _has_stood(self, party: str, seconds: float, until: str = "") -> None:
        lasted = seconds * self.speed
        self.record.events.append(
            {"t": self.now, "event": "stand", "robot": party, "duration": lasted, "by": BY}
        )
        self._interfered(party, f"held for {lasted:.2f} s{until}")

    def _put(self, robot: RobotRunner, motion: Motion) -> None:
        robot.motion = robot.executor.motion = motion

    def fail(self, party: str) -> None:
        """What a robot or device is doing fails: its program stops, and so does the cell."""
        robot = self._named(party)
        if robot is None:
            return
        if robot.asking is not None:
            doing, line = f"its question to sensor {robot.asking.sensor}", robot.asking.line
        else:
            doing = kind_and_label(robot.motion.command)[1] if robot.motion else "its program"
            line = robot.waiting.line if robot.waiting else robot.line
        self._interfered(party, f"{doing} was made to fail")
        raise CellStoppedError(
            f"{robot.at(line)}: {party}: {doing} fails, as a person at the live page wanted"
        )

    def promise(self, party: str, channel: str, fate: Fate | None) -> None:
        """What becomes of the next message of a robot or device."""
        robot = self._named(party)
        if robot is None or not isinstance(robot.files, LateFiles):
            return
        robot.files.fates.pop(channel, None)
        if fate is not None:
            # Seconds of the wall clock, as all that a person says.
            late = None if fate.late is None else fate.late * self.speed
            robot.files.fates[channel] = Fate(late)

    def heard_of(self, party: str, channel: str, fate: Fate) -> None:
        """A message does not go out at once."""
        assert self.hand is not None
        self.hand.fulfilled(party, channel)
        if fate.late is None:
            self._lost.add(channel)  # nobody answers it
        note = {"t": self.now, "event": "message", "robot": party, "channel": channel}
        how = {"fate": "lost"} if fate.late is None else {"fate": "late", "seconds": fate.late}
        self.record.events.append({**note, **how, "by": BY})
        words = "lost" if fate.late is None else f"{fate.late:g} s late"
        self._interfered(party, f"message {channel}: {words}")

    def _deliver(self) -> None:
        """Publishes messages that were late."""
        for robot in self.robots:
            if not isinstance(robot.files, LateFiles):
                continue
            try:
                for channel in robot.files.deliver(self.now):
                    self.punctuality.asked(channel)
            except FileError as problem:
                raise CellStoppedError(f"{robot.script}: {robot.name}: {problem}") from None

    def _end_commands(self) -> None:
        for robot in self.robots:
            if robot.motion is not None and robot.motion.ends <= self.now:
                self.punctuality.noticed((self.now - robot.motion.ends) / self.speed)
                self._finish(robot)

    def _look_at_supervisor(self) -> bool:
        """Whether it has finished; a stop or its death stops the robots."""
        if self._finished:
            return True
        if (now := time.monotonic()) - self._looked < LOOK_S:
            return False
        self._looked = now
        self._read_trace()
        if not self.robots:
            self._finished = not self.supervisor.running
            return self._finished
        peer = self.robots[0].files.shared.peer()
        if peer.state is PeerState.FINISHED:
            self._finished = True
        elif peer.state is not PeerState.RUNNING:
            self._heed()  # Ctrl-C in a terminal reaches the supervisor as well
            ended = self.supervisor.close()
            words = {PeerState.STOPPED: "has stopped", PeerState.DEAD: "has died"}
            why = peer.reason or ended.reason
            raise CellStoppedError(f"the supervisor {words.get(peer.state, 'has gone')}: {why}")
        return self._finished
