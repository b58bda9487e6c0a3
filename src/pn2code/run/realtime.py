"""The same cell on the wall clock: the supervisor runs by itself, woken by the files, as on a real cell.

Messages, scripts, arms and checks are those of the lock-step engine; only time is real. A file that
cannot be taken is given
the grace of the protocol (I6), a dead or stopped supervisor stops the robots (I8, I9).
"""

from __future__ import annotations

import itertools
import time
from dataclasses import dataclass, field
from typing import Any

from pn2code.channels import LOOK_S, PeerState
from pn2code.robot.commands import Command
from pn2code.run.engine import CellStoppedError, Engine, RobotRunner
from pn2code.run.punctuality import Punctuality
from pn2code.run.record import RunRecord
from pn2code.tdl.requests import Event, MessageConsumed, MessageWritten
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
    """

    speed: float = 1.0
    punctuality: Punctuality = field(default_factory=Punctuality)
    fired: list[dict[str, Any]] = field(default_factory=list)
    noted: list[dict[str, Any]] = field(default_factory=list)
    _looked: float = 0.0
    _began: float = 0.0
    _sampled: float = 0.0

    def run(self) -> RunRecord:
        """Until the supervisor has finished and the robots rest; or until something stops the cell."""
        self._began = time.perf_counter()
        self.noted = self.record.events
        try:
            self._begin_run()
            while True:
                self._heed()
                self._look_at_the_clock()
                self._end_commands()
                moved = [self._robot_turn(robot) for robot in self.robots]
                if self._look_at_supervisor() and self._at_rest():
                    self.record.verdict = "finished"
                    break
                if self.now - self._sampled >= self.cell.motion.sample:
                    self._sampled = self.now
                    self._sample(self.now, {r.name: r.joints(self.now) for r in self._arms()})
                    for observer in self.observers:
                        observer.advanced(self)
                if not any(moved):
                    time.sleep(PAUSE_S)
        except CellStoppedError as why:
            self._stop(why)
        return self._close()

    def _close(self) -> RunRecord:
        """Waits for the supervisor's last words, then puts both traces into one order."""
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
                self._enter_activity(line, t)

    def _look_at_the_clock(self) -> None:
        self.now = (time.perf_counter() - self._began) * self.speed

    def _begin_command(self, robot: RobotRunner, command: Command, line: int) -> None:
        """A wait is as long as it says after the messages before it, however late this turn is."""
        self._look_at_the_clock()
        Engine._begin_command(self, robot, command, line)

    def _heard(self, event: Event) -> None:
        """A message to the supervisor begins an answer, the next message from it ends it."""
        match event:
            case MessageWritten(file=channel):
                self.punctuality.asked(channel)
            case MessageConsumed(file=channel):
                self.punctuality.answered(channel)
            case _:
                pass
        Engine._heard(self, event)

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
