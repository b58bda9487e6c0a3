"""Running a whole cell: generate, build, start, supervise, stop, report.

    run_cell(Path("examples/riveting"), RunOptions(out=Path("run")), d, watch)  ->  RunResult

The recipe of `pn2code run`; everything that takes decisions lives in the modules it calls.
"""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path, PurePath
from typing import Any

from pn2code.cell.codes import INPUT
from pn2code.channels import GRACE_S, SharedDirectory, specs_of
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.emission.write import expect_writable
from pn2code.input_files import CORRECT, folder_of
from pn2code.robot.backend import Backend
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.monitor import Monitor
from pn2code.run.codes import RUN_START
from pn2code.run.device import DeviceExecutor
from pn2code.run.engine import Engine
from pn2code.run.files import RobotFiles
from pn2code.run.hand import Hand
from pn2code.run.journals import ROBOTS, SUPERVISOR, RunJournal, say_where
from pn2code.run.late_files import LateFiles
from pn2code.run.observer import Observer
from pn2code.run.prepare import Prepared, RunOptions, prepare
from pn2code.run.punctuality import Punctuality
from pn2code.run.realtime import RealtimeEngine
from pn2code.run.record import RunRecord, RunWarning
from pn2code.run.results import RunResult, summary_of, write_results
from pn2code.run.run_warnings import warn
from pn2code.run.sensors import Sensors
from pn2code.run.sensors import load as load_sensors
from pn2code.run.stops import Stops
from pn2code.run.supervisor import EXIT_FINISHED, EXIT_USAGE, Exit, SupervisorProcess
from pn2code.trace.growing import GrowingTrace

_POSITION = re.compile(r"(?P<file>[^\n:]+)(?::(?P<line>\d+):(?P<column>\d+))?: (?P<what>.*)")

ROBOT_START_S = 10.0
"""How long a robot waits for the supervisor to announce itself."""


def run_cell(
    path: Path,
    options: RunOptions,
    d: Diagnostics,
    observers: list[Observer] | None = None,
    *,
    ready: Callable[[Prepared], None] | None = None,
    interrupted: Callable[[], str] | None = None,
    hand_of: Callable[[Prepared], Hand] | None = None,
) -> RunResult | None:
    """Runs a cell and writes trace, rows and summary; None when it could not start.

    Args:
        observers: who watches.
        ready: is called with what will run, before anything runs.
        interrupted: see `Engine`.
        hand_of: makes the hand of a person who may decide what sensors say and what fails, on the wall clock.
    """
    started = time.perf_counter()
    expect_writable(options.out)
    prepared = prepare(path, options, d)
    if prepared is None:
        return None
    hand = hand_of(prepared) if hand_of is not None else None
    if ready is not None:
        ready(prepared)
    with ExitStack() as stack:
        inputs = stack.enter_context(folder_of(prepared.config, options.input))
        sensors = sensors_of(prepared, options, inputs, d)
        if sensors is None:
            return None
        record = run_once(
            prepared,
            options,
            inputs,
            sensors,
            d,
            observers or [],
            interrupted=interrupted,
            hand=hand,
        )
        if record is None:
            return None
    record.wall = time.perf_counter() - started
    warn(record, prepared.config, prepared.robot_cell)
    summary = summary_of(record, prepared)
    write_results(record, summary, prepared, options.out)
    return RunResult(record, summary, prepared)


def sensors_of(
    prepared: Prepared, options: RunOptions, inputs: Path, d: Diagnostics
) -> Sensors | None:
    """The sensors of a cell at their start; None after an error that was reported."""
    folders = (inputs, prepared.config.folder)
    net = prepared.generated.partition.net
    return load_sensors(prepared.config, net, folders, options.seed, d)


def run_once(
    prepared: Prepared,
    options: RunOptions,
    inputs: Path,
    sensors: Sensors,
    d: Diagnostics,
    observers: list[Observer],
    stops: Stops | None = None,
    interrupted: Callable[[], str] | None = None,
    hand: Hand | None = None,
) -> RunRecord | None:
    """One run of programs that are built; None when it could not start.

    Args:
        prepared: the programs.
        options: how.
        inputs: the folder of the `[[input]]` files.
        sensors: what they have said before stays said.
        d: gets the errors.
        observers: who watches.
        stops: whose commands are held up, and when; None: nobody's.
        interrupted: see `Engine`.
        hand: see `RealtimeEngine`.
    """
    with ExitStack() as stack:
        engine = _start(prepared, options, inputs, stack, d, observers, hand)
        if engine is None:
            return None
        engine.sensors, engine.stops = sensors, stops
        if interrupted is not None:
            engine.interrupted = interrupted
        record = engine.run()
        for robot in engine.robots:
            if record.verdict == "finished":
                robot.files.finished()
        record.header = _header(engine.supervisor_trace.header)
    return record


def _start(
    prepared: Prepared,
    options: RunOptions,
    inputs: Path,
    stack: ExitStack,
    d: Diagnostics,
    observers: list[Observer],
    hand: Hand | None,
) -> Engine | None:
    partition = prepared.generated.partition
    shared = stack.enter_context(shared_directory(partition.net.name))
    trace_path = options.out / SUPERVISOR
    supervisor = stack.enter_context(
        SupervisorProcess(
            prepared.program,
            shared,
            inputs,
            trace_path,
            lockstep=not options.realtime,
            # Where the arms are faster than the wall clock, so is the time of the net.
            time_scale=options.speed if options.realtime else None,
        )
    )
    cell = prepared.robot_cell
    backend = open_backend(options.backend, cell, gui=options.gui, looks=options.looks)
    stack.callback(backend.close)
    specs = specs_of(partition)
    sides = {
        robot.name: stack.enter_context(SharedDirectory(shared, robot.name, specs))
        for robot in prepared.config.programs
    }
    late: list[str] = []
    for name, side in sides.items():
        if side.await_supervisor(ROBOT_START_S if supervisor.running else 0.0):
            continue
        ended = supervisor.close()
        if ended.code != EXIT_FINISHED:
            _report_start(ended, inputs, options, d)
            return None
        late.append(
            name
        )  # on the wall clock: the supervisor waits for nobody, and has come to its end
    trace = GrowingTrace(trace_path)
    stack.callback(trace.close)
    engine = _engine(prepared, options, supervisor, trace, backend, observers)
    if isinstance(engine, RealtimeEngine):
        engine.hand = hand
    moving = {robot.name for robot in cell.moving}
    for name in late:
        text = "has found no supervisor: it had come to its end before"
        engine.record.warnings.append(RunWarning(0.0, name, text))
    for name, side in sides.items():
        if name in late:
            continue
        script, program = prepared.scripts[name]
        executor = (
            RobotExecutor(cell.robot(name), cell.motion, cell.frames)
            if name in moving
            else DeviceExecutor(name)
        )
        files = _files(engine, side)
        engine.add_robot(name, script, program, files, executor)
    if options.realtime:
        say_where(options.out, prepared.config, options.values, shared)
        first = next(iter(sides.values()), None)
        session, began = (first.session or "", first.began) if first else ("", time.time())
        engine.observers.append(RunJournal(options.out / ROBOTS, session, began))
    return engine


def _files(engine: Engine, side: SharedDirectory) -> RobotFiles:
    """The shared files of a robot or device; in the hand of a person, if there is one."""
    if not isinstance(engine, RealtimeEngine):
        return RobotFiles(side)
    if engine.hand is None:
        return RobotFiles(side, GRACE_S)
    return LateFiles(side, GRACE_S, lambda: engine.now, partial(engine.heard_of, side.side))


def _report_start(ended: Exit, inputs: Path, options: RunOptions, d: Diagnostics) -> None:
    """What the supervisor said when it did not start; mistakes of an input file at their place in the user's file."""
    reason, at = ended.reason, Origin(str(inputs))
    if found := _POSITION.fullmatch(reason):
        file = Path(found["file"])
        if options.input is not None and options.input.is_file() and file.parent == inputs:
            file = options.input  # the supervisor read a copy
        at = Origin(str(file), int(found["line"] or 0), int(found["column"] or 0))
        reason = found["what"]
    others = (line for line in ended.stderr.split("\n") if line and ended.reason not in line)
    usage = ended.code == EXIT_USAGE
    d.error(
        INPUT if usage else RUN_START,
        f"the supervisor did not start: {reason}",
        at,
        notes=list(others)[:8],
        hint=CORRECT
        if usage
        else "`./supervisor --help` in the folder of the program says what it needs",
    )


def _engine(
    prepared: Prepared,
    options: RunOptions,
    supervisor: SupervisorProcess,
    trace: GrowingTrace,
    backend: Backend,
    observers: list[Observer],
) -> Engine:
    partition = prepared.generated.partition
    common: dict[str, Any] = {
        "record": RunRecord(partition.net.name, prepared.config.layout, options.backend),
        "supervisor": supervisor,
        "supervisor_trace": trace,
        "supervisor_depth": partition.owners[0].instance.count("/") + 1,
        "partition": partition,
        "cell": prepared.robot_cell,
        "backend": backend,
        "monitor": Monitor(prepared.robot_cell, backend),
        "observers": list(observers),
        "failing": prepared.generated.failing,
    }
    if options.realtime:
        parties = {
            PurePath(c.file).stem: partition.owners[max(c.writer, c.reader)].name
            for c in partition.channels
        }
        return RealtimeEngine(**common, speed=options.speed, punctuality=Punctuality(parties))
    return Engine(**common)


@contextmanager
def shared_directory(name: str) -> Iterator[Path]:
    """A fresh directory for the channel files: on tmpfs where there is one, which makes files as fast as sockets."""
    memory = Path("/dev/shm")
    parent = memory if memory.is_dir() and os.access(memory, os.W_OK) else None
    folder = Path(tempfile.mkdtemp(prefix=f"pn2code-{name}-", dir=parent))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _header(supervisor: dict[str, Any]) -> dict[str, Any]:
    return {**supervisor, "by": "run"}
