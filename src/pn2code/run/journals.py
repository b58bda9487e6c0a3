"""Journals of the robots of a run on the wall clock, and of a robot that runs by itself."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.robot.active_motion import Motion
from pn2code.robot.commands import Command, Pose
from pn2code.robot.transforms import Array
from pn2code.run.arm import MovingArm
from pn2code.run.command_words import kind_and_label
from pn2code.run.engine import Engine
from pn2code.run.journal import Journal
from pn2code.run.robot import Arm, Ended, RobotExit, RobotPlayer
from pn2code.run.runner import RobotRunner
from pn2code.tdl.requests import Event, Marked
from pn2code.tdl.requests import Scalar as SensedValue

RUNNING = "running.json"
"""In the folder of a run on the wall clock: where its shared files are."""
ROBOTS = "robots.trace.jsonl"
SUPERVISOR = "supervisor.trace.jsonl"


def say_where(out: Path, config: CellConfig, values: Mapping[str, str], shared: Path) -> None:
    """Writes for `pn2code watch` where the shared files of a run are."""
    told = {
        "running": 1,
        "cell": str(config.path.resolve()),
        "layout": config.layout,
        "values": dict(values),
        "shared": str(shared),
        "traces": [SUPERVISOR, ROBOTS],
        "pid": os.getpid(),
    }
    partial = out / f".{RUNNING}.tmp"
    partial.write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    partial.replace(out / RUNNING)


class RunJournal:
    """An observer (`run.observer.Observer`) that writes the journal of all robots and devices of a run."""

    def __init__(self, path: Path, session: str, began: float) -> None:
        self._journal = Journal(path, "robots", session=session, began=began)
        self._noted = 0
        self._events: list[dict[str, Any]] = []
        self._under_way: dict[str, tuple[Motion | None, float]] = {}

    def begun(self, engine: Engine) -> None:
        """The run begins."""
        self._events = engine.record.events  # at its end the run puts another list there
        self.advanced(engine)

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        """The arms stood like this."""
        for name, q in joints.items():
            self._journal.arm(name, q.tolist())

    def advanced(self, engine: Engine) -> None:
        """What has come since."""
        for line in self._events[self._noted :]:
            if "transition" in line:
                self._journal.mark(line["transition"], line["binding"], line["origin"])
            elif line.get("event") == "sense":
                self._journal.sensed(
                    line["robot"], line["sensor"], line["value"], line.get("by", "")
                )
        self._noted = len(self._events)
        for robot in engine.robots:
            self._look(robot)

    def ended(self, engine: Engine) -> None:
        """The run is over: the traces have been merged by now."""
        record = engine.record
        self.advanced(engine)
        if (broken := record.too_fast) is not None:
            self._journal.zone(broken.zone, broken.link, broken.speed, broken.point)
        for robot in engine.robots:
            self._journal.end(robot.name, record.verdict, record.reason)
        self._journal.close()

    def _look(self, robot: RobotRunner) -> None:
        motion = robot.motion
        known, began = self._under_way.get(robot.name, (None, 0.0))
        if motion is known or (motion and known and motion.command is known.command):
            return  # also one that stands for a while
        if known is not None:
            kind, label = kind_and_label(known.command)
            self._journal.did(robot.name, kind, label, robot.line, began)
        self._under_way[robot.name] = (motion, self._journal.now)
        if motion is not None:
            kind, label = kind_and_label(motion.command)
            self._journal.command(robot.name, kind, label, robot.line, motion.duration)


class RobotJournal:
    """The journal of a robot that runs by itself: an arm (`run.robot.Arm`) around its own.

    Args:
        name: of the robot.
        path: of the file, which begins when the robot has joined.
        arm: what carries out the commands.
    """

    def __init__(self, name: str, path: Path, arm: Arm) -> None:
        self._name, self._path, self._arm = name, path, arm
        self._journal: Journal | None = None
        self._command: tuple[str, str, int, float] | None = None
        self._line = 0

    def joined(self, session: str, began: float) -> None:
        """The robot has found its supervisor."""
        self._journal = Journal(self._path, self._name, session=session, began=began)
        self.turn()

    def heard(self, event: Event) -> None:
        """Marks go into the journal."""
        if self._journal is not None and isinstance(event, Marked):
            self._journal.mark(event.transition, event.binding, "")

    def sensed(self, sensor: str, value: Any) -> None:
        """What a sensor has said."""
        if self._journal is not None:
            self._journal.sensed(self._name, sensor, value)

    def told(self, line: int) -> None:
        """A command of this line comes next."""
        self._line = line

    def turn(self) -> None:
        """Again and again: how the arm stands."""
        if self._journal is not None and isinstance(self._arm, MovingArm):
            q = self._arm.joints()
            if q is not None:
                self._journal.arm(self._name, q)

    def begin(self, command: Command) -> tuple[float, Pose | None]:
        """As the arm."""
        lasts, result = self._arm.begin(command)
        if self._journal is not None:
            kind, label = kind_and_label(command)
            self._command = (kind, label, self._line, self._journal.now)
            self._journal.command(self._name, kind, label, self._line, lasts)
        return lasts, result

    def finish(self) -> None:
        """As the arm."""
        self._arm.finish()
        self._did()
        self.turn()

    def stop(self) -> str:
        """As the arm."""
        where = self._arm.stop()
        self._did()
        self.turn()
        return where

    def ended(self, why: str, reason: str) -> None:
        """The robot has ended."""
        if self._journal is not None:
            with suppress(OSError):
                self._journal.end(self._name, why, reason)
            self._journal.close()

    def _did(self) -> None:
        if self._journal is not None and self._command is not None:
            kind, label, line, began = self._command
            self._journal.did(self._name, kind, label, line, began)
            self._command = None


def journalled(player: RobotPlayer, path: Path) -> Ended:
    """Runs a robot with a journal."""
    journal = RobotJournal(player.shared.side, path, player.arm)
    told, interrupted, sense = player.on_command, player.interrupted, player.sense

    def telling(command: Command, line: int) -> None:
        journal.told(line)
        told(command, line)

    def turning() -> bool:
        journal.turn()
        return interrupted()

    def sensing(sensor: str) -> SensedValue | None:
        value = sense(sensor)
        journal.sensed(sensor, value)
        return value

    player.arm, player.joined, player.on_event = journal, journal.joined, journal.heard
    player.on_command, player.interrupted, player.sense = telling, turning, sensing
    ended = player.run()
    why = "finished" if ended.code is RobotExit.FINISHED else "stopped"
    journal.ended(why, ended.reason)
    return ended
