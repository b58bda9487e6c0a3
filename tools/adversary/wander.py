"""Lock-step runs in which parties come late and work takes any time: what a real cell may do, drawn at random."""

from __future__ import annotations

import math
import os
import signal
from contextlib import ExitStack
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

from pn2code import pipeline
from pn2code.channels import SharedDirectory, specs_of
from pn2code.diagnostics import Diagnostics
from pn2code.emission.write import write
from pn2code.robot import scene
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.commands import Command, Wait
from pn2code.robot.monitor import Monitor
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.trajectories import Still
from pn2code.run.cell import shared_directory
from pn2code.run.device import DeviceExecutor
from pn2code.run.doings import stuck
from pn2code.run.engine import Engine
from pn2code.run.files import RobotFiles
from pn2code.run.prepare import scripts_of
from pn2code.run.record import RunRecord
from pn2code.run.runner import CellStoppedError, RobotRunner
from pn2code.run.sensors import load as load_sensors
from pn2code.run.supervisor import SupervisorProcess
from pn2code.toolchain import build
from pn2code.trace.growing import GrowingTrace

MOST_EVENTS = 400
"""Occurrences after which a run is given up."""
MANY_EVENTS = 12_000
"""The same of a cell that may repeat its work hundreds of times."""
SUPERVISOR = "supervisor"


@dataclass(frozen=True)
class Built:
    """The programs of a cell, ready to run."""

    generated: pipeline.Generated
    scripts: dict[str, Any]
    program: Path
    cell: RobotCell
    folder: Path
    most_events: int = MOST_EVENTS


@dataclass(frozen=True)
class Run:
    """A run: how it ended (`finished`, `stuck`, `stopped`, `endless`), why, and the most firings in a cycle."""

    end: str
    why: str
    record: RunRecord
    most_firings: int


def prepare(folder: Path, d: Diagnostics, *, checked: bool = False) -> Built | None:
    """Generates and builds; None after an error.

    Args:
        folder: of the cell.
        d: gets what is wrong.
        checked: whether a cell that fails a check is refused, and arrays and memory are as large as was proven to be
            enough, and no larger: what is deployed. Else all is built, with room for more.
    """
    generated = pipeline.generate(folder, d, checked=checked)
    if generated is None or generated.config is None:
        return None
    config = generated.config
    robot_cell = scene.load(config.geometry, config.folder, config.locator.origin, d)
    scripts = scripts_of(generated, config, d)
    if robot_cell is None or scripts is None:
        return None
    out = folder / "program"
    write(out, generated.files)
    program = build.build(out, generated.files, d, target="supervisor.traced")
    return None if program is None else Built(generated, scripts, program, robot_cell, folder)


@dataclass(frozen=True)
class Crash:
    """A side dies without a word after so many events: `who` is the supervisor, or a device by name."""

    who: str
    after: int


class Pace(Enum):
    """How long things take in a run."""

    ANY = "any"
    """whatever"""
    PLANNED = "planned"
    """commands what they say, all else nothing: an ordinary run"""
    LATE = "late"
    """commands at least what they say; everybody may come late"""
    EARLY = "early"
    """commands at most what they say, all else nothing"""


_FACTORS = {
    Pace.ANY: [0.2, 1.0, 1.0, 3.0],
    Pace.PLANNED: [1.0],
    Pace.LATE: [1.0, 1.0, 1.5, 3.0],
    Pace.EARLY: [0.0, 0.2, 0.7, 1.0, 1.0],
}


class _Endless(Exception):
    """There have been enough events."""


class _Wanderer(Engine):
    """An engine whose parties are held up at random after they have moved; commands take a random time."""

    random: Random
    held: dict[str, float]
    most_firings: int
    most_events: int
    crash: Crash | None
    has_crashed: bool
    pace: Pace

    def _supervisor_cycle(self) -> bool:
        self._perhaps_crash()
        if self._is_held(SUPERVISOR):
            return False
        before = len(self.record.events)
        moved = super()._supervisor_cycle()
        self.most_firings = max(self.most_firings, len(self.record.events) - before)
        self._hold(SUPERVISOR, moved)
        return moved

    def _robot_turn(self, robot: RobotRunner) -> bool:
        if self._is_held(robot.name) or (self.has_crashed and self._is_dead(robot.name)):
            return False
        moved = super()._robot_turn(robot)
        self._hold(robot.name, moved)
        return moved

    def _begin_command(self, robot: RobotRunner, command: Command, line: int) -> None:
        super()._begin_command(robot, command, line)
        assert robot.motion is not None
        # A wait is what the net asks for; what else takes time may take less than it says.
        is_wait = isinstance(command, Wait) and self.pace is Pace.ANY
        factors = [1.0, 1.0, 1.5, 3.0] if is_wait else _FACTORS[self.pace]
        seconds = robot.motion.duration * self.random.choice(factors)
        robot.motion = replace(robot.motion, trajectory=Still(np.zeros(0), seconds))

    def _is_dead(self, who: str) -> bool:
        return self.crash is not None and self.crash.who == who

    def _perhaps_crash(self) -> None:
        if self.crash is None or self.has_crashed or len(self.record.events) < self.crash.after:
            return
        self.has_crashed = True
        if self.crash.who == SUPERVISOR:
            os.kill(self.supervisor.pid, signal.SIGKILL)
            return
        (dead,) = (r for r in self.robots if r.name == self.crash.who)
        dead.motion = None
        dead.files.shared.close()  # as the system does for a process that has died

    def _is_held(self, who: str) -> bool:
        return self.held.get(who, 0.0) > self.now

    def _hold(self, who: str, moved: bool) -> None:
        if len(self.record.events) > self.most_events:
            raise _Endless
        may_be_held = self.pace in (Pace.ANY, Pace.LATE)
        if moved and may_be_held and self.random.random() < 0.5:
            self.held[who] = self.now + self.random.choice([0.1, 0.6, 1.0, 2.5])

    def _next_event(self) -> float:
        times = [r.motion.ends for r in self.robots if r.motion is not None]
        times += [t for t in self.held.values() if t > self.now]
        wake = self._next_model_time
        if wake is not None and not self._finished and not self._is_held(SUPERVISOR):
            times.append(wake)
        if not times:
            raise CellStoppedError(stuck(self.robots, self.now))
        # The supervisor stops for a late answer as soon as it is late, if it looks then.
        late = math.nextafter(self._answer_due, math.inf)
        if late > self.now and not self._finished and not self._is_held(SUPERVISOR):
            times.append(late)
        return max(self.now, min(times))


def run(
    built: Built,
    seed: int,
    shared: Path | None = None,
    crash: Crash | None = None,
    pace: Pace = Pace.ANY,
) -> Run:
    """One run; the same seed gives the same.

    Args:
        built: the programs.
        seed: of all that is drawn.
        shared: the shared directory, with whatever an earlier run has left there; None: a fresh one.
        crash: who dies, and when.
        pace: how long things take.
    """
    generated = built.generated
    config, partition = generated.config, generated.partition
    assert config is not None
    d = Diagnostics()
    with ExitStack() as stack:
        shared = shared or stack.enter_context(shared_directory(partition.net.name))
        trace_path = built.folder / "supervisor.trace.jsonl"
        supervisor = stack.enter_context(
            SupervisorProcess(built.program, shared, built.folder, trace_path, lockstep=True)
        )
        backend = open_backend("fake", built.cell, gui=False, looks=False)
        stack.callback(backend.close)
        sides = {
            r.name: stack.enter_context(SharedDirectory(shared, r.name, specs_of(partition)))
            for r in config.programs
        }
        for side in sides.values():
            assert side.await_supervisor(10.0), "the supervisor does not come"
        trace = GrowingTrace(trace_path)
        stack.callback(trace.close)
        record = RunRecord(partition.net.name, "", "fake")
        engine = _Wanderer(
            record=record,
            supervisor=supervisor,
            supervisor_trace=trace,
            supervisor_depth=2,
            partition=partition,
            cell=built.cell,
            backend=backend,
            monitor=Monitor(built.cell, backend),
        )
        engine.random, engine.held, engine.most_firings = Random(seed), {}, 0
        engine.most_events = built.most_events
        engine.crash, engine.has_crashed = crash, False
        engine.pace = pace
        sensors = load_sensors(config, partition.net, (built.folder,), seed, d)
        assert sensors is not None
        engine.sensors = sensors
        for name, side in sides.items():
            script, program = built.scripts[name]
            engine.add_robot(name, script, program, RobotFiles(side, 0.0), DeviceExecutor(name))
        try:
            engine.run()
        except _Endless:
            supervisor.stop("enough")
            return Run(
                "endless", f"more than {built.most_events} events", record, engine.most_firings
            )
        # The supervisor may have come to its end before it looked at the others again.
        is_broken = engine.has_crashed and record.verdict != "finished"
        end = "crashed" if is_broken else _end(record)
    return Run(end, record.reason, record, engine.most_firings)


def run_again(built: Built, seed: int, crash: Crash) -> tuple[Run, Run]:
    """A run in which a side dies, and the run of a new session in the same directory."""
    with shared_directory(built.generated.partition.net.name) as shared:
        return run(built, seed, shared, crash), run(built, seed + 1, shared)


def _end(record: RunRecord) -> str:
    if record.verdict == "finished":
        return "finished"
    return "stuck" if "the cell is stuck" in record.reason else "stopped"
