"""Running a whole cell: generate, build, start, supervise, stop, report.

    run_cell(Path("examples/riveting"), RunOptions(out=Path("run")), d, watch)  ->  RunResult

The recipe of `pn2code run`; everything that takes decisions lives in the modules it calls.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import field
from functools import partial
from pathlib import Path, PurePath
from typing import Any

from pn2code import pipeline
from pn2code.base.conditioning import condition_text
from pn2code.base.frozen import frozen
from pn2code.base.how_far import beginning
from pn2code.base.kept_answers import KeptAnswers
from pn2code.base.os_reason import os_reason
from pn2code.cell.codes import INPUT
from pn2code.cell.config import CellConfig
from pn2code.cell.locate import locate
from pn2code.cell.names import counted
from pn2code.channels import GRACE_S, SharedDirectory, specs_of
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.codes import register
from pn2code.emission.output import OutputFile
from pn2code.emission.write import OutputFolderError, expect_writable, write
from pn2code.input_files import CORRECT, begin, folder_of
from pn2code.net.flat import FlatNet
from pn2code.report.messages import messages_tsv
from pn2code.report.rows import rows_tsv
from pn2code.report.summary import summarise
from pn2code.robot import scene
from pn2code.robot.backend import Backend, BackendName
from pn2code.robot.choose_backend import expect_backend, open_backend
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.monitor import Monitor
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.device import DeviceExecutor
from pn2code.run.engine import Engine, Observer
from pn2code.run.files import RobotFiles
from pn2code.run.hand import Hand
from pn2code.run.journals import ROBOTS, SUPERVISOR, RunJournal, say_where
from pn2code.run.late_files import LateFiles
from pn2code.run.punctuality import Punctuality
from pn2code.run.realtime import RealtimeEngine
from pn2code.run.record import RunRecord, RunWarning
from pn2code.run.sensors import Sensors
from pn2code.run.sensors import load as load_sensors
from pn2code.run.stops import Stops
from pn2code.run.supervisor import EXIT_FINISHED, EXIT_USAGE, Exit, SupervisorProcess
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.parse import parse
from pn2code.toolchain import build
from pn2code.trace.growing import GrowingTrace, trace_text

RUN_NO_CELL = register(
    "run-no-cell",
    "there is no cell to run",
    "`pn2code run` needs a folder with a cell.toml: it says which robots stand where. A net alone can be generated, "
    "built and played: `pn2code generate net.cpn`, then `make && ./supervisor` in the output folder.",
)
RUN_START = register(
    "run-start",
    "the supervisor did not start",
    "The compiled supervisor ended before the first step; its own message follows. A shared directory or a trace that "
    "cannot be written is the usual reason.",
)

_POSITION = re.compile(r"(?P<file>[^\n:]+)(?::(?P<line>\d+):(?P<column>\d+))?: (?P<what>.*)")

ROBOT_START_S = 10.0
"""How long a robot waits for the supervisor to announce itself."""


@frozen
class RunOptions:
    """What `pn2code run` was asked for.

    Args:
        out: where the results go.
        layout: of cell.toml; None: its first.
        input: a file instead of the cell's input file, or a folder of them.
        backend: "bullet" or "fake".
        values: `val`s to replace.
        gui: PyBullet's window.
        looks: pictures are wanted, of the run or later.
        seed: of what sensors draw at random; None: that of cell.toml.
        checked: whether the supervisor is checked, as `pipeline.generate` does.
        realtime: on the wall clock instead of in lock-step; speed: how many times faster than that.
        kept: what earlier commands have proved of the supervisor.
    """

    out: Path
    layout: str | None = None
    input: Path | None = None
    backend: BackendName = "bullet"
    values: dict[str, str] = field(default_factory=dict)
    gui: bool = False
    realtime: bool = False
    speed: float = 1.0
    looks: bool = True
    seed: int | None = None
    checked: bool = True
    kept: KeptAnswers | None = None


@frozen
class Prepared:
    """A cell that is generated and built, ready to run."""

    generated: pipeline.Generated
    config: CellConfig
    robot_cell: RobotCell
    scripts: dict[str, tuple[OutputFile, CheckedProgram]]
    program: Path


@frozen
class RunResult:
    """What a run gave; the files are in the output folder."""

    record: RunRecord
    summary: dict[str, Any]
    prepared: Prepared


def prepare(path: Path, options: RunOptions, d: Diagnostics) -> Prepared | None:
    """Generates and builds the programs of a cell, reads its geometry. None when there are errors.

    Raises BackendUnavailableError before anything is written, when the cell cannot be run here.
    """

    def examine(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> None:
        begin(net, config, d, is_started=True, given=options.input)

    found = locate(path, d, layout=options.layout)
    if found is None:
        return None
    if found[1] is None and options.input is None:  # else the command line is wrong, too
        d.error(
            RUN_NO_CELL,
            f"`{path}` has no cell.toml beside it",
            Origin(str(path)),
            hint="give the folder of a cell, e.g. examples/riveting; docs/cell.md describes cell.toml. "
            "A net without a cell is played by `pn2code simulate`",
        )
        return None
    expect_backend(options.backend, gui=options.gui)
    generated = pipeline.generate(
        path,
        d,
        layout=options.layout,
        values=options.values,
        checked=options.checked,
        examine=examine,
        inputs=options.input,
        kept=options.kept,
        stage=beginning,
    )
    if generated is None:
        return None
    config = generated.config
    assert config is not None, "it was found above"
    robot_cell = scene.load(config.geometry, config.folder, config.locator.origin, d)
    scripts = _scripts(generated, config, d)
    if robot_cell is None or scripts is None or d.has_errors:
        return None
    folder = options.out / "program"
    write(folder, generated.files)
    beginning("compiling the supervisor")
    program = build.build(folder, generated.files, d, target="supervisor.traced")
    if program is None:
        return None
    return Prepared(generated, config, robot_cell, scripts, program)


def _scripts(
    generated: pipeline.Generated, config: CellConfig, d: Diagnostics
) -> dict[str, tuple[OutputFile, CheckedProgram]] | None:
    """The robots' scripts, parsed and checked as any script would be: what was generated is not trusted."""
    files = {f.path: f for f in generated.files}
    out = {}
    for robot in config.programs:
        file = files[f"{robot.name}.tdl"]
        tree = parse(SourceText(file.text, Origin(file.path, 1, 1)), d)
        checked = check(tree, d, config.frame_names) if tree is not None else None
        if checked is None:
            return None
        out[robot.name] = (file, checked)
    return out


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
    _warn(record, prepared.config, prepared.robot_cell)
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


def summary_of(record: RunRecord, prepared: Prepared) -> dict[str, Any]:
    """The figures of a run."""
    occurrences = counted(prepared.generated.partition.net, prepared.config)
    return summarise(record, prepared.config.report, _names(prepared), occurrences)


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


def _names(prepared: Prepared) -> tuple[str, ...]:
    return tuple(r.name for r in prepared.config.programs)


def _header(supervisor: dict[str, Any]) -> dict[str, Any]:
    return {**supervisor, "by": "run"}


def _warn(record: RunRecord, config: CellConfig, cell: RobotCell) -> None:
    """Conditioning above the configured bound, in one warning a robot: where it begins and how bad it gets."""
    limit = config.report.warn_condition
    for robot in config.robots:
        values = record.series.get(f"condition.{robot.name}", [])
        above = [i for i, v in enumerate(values) if v > limit]
        if above:
            worst = max(above, key=values.__getitem__)
            elbow = record.series[f"elbow.{robot.name}"][worst]
            wrist = record.series[f"wrist.{robot.name}"][worst]
            straight = cell.robot(robot.name).kinematics.straightness(elbow, wrist)
            record.warnings.append(
                RunWarning(
                    record.sample_t[above[0]],
                    robot.name,
                    "comes close to a singularity for the first time; it is closest at "
                    f"{record.sample_t[worst]:.2f} s: condition number {condition_text(values[worst])}"
                    f"{straight} (warning above {limit:g})",
                )
            )

    for (a, b), (gap, t) in sorted(record.near.items()):
        record.warnings.append(RunWarning(t, a.split("/")[0], _nearness(a, b, 1000 * gap)))


def _nearness(a: str, b: str, gap: float) -> str:
    """Of two parts and their distance in mm, negative where one is in the other."""
    if gap < 0:
        return f"`{a}` is {-gap:.1f} mm deep in `{b}`"
    return f"`{a}` comes within {gap:.1f} mm of `{b}`"


def write_results(
    record: RunRecord, summary: dict[str, Any], prepared: Prepared, out: Path
) -> None:
    """Trace, rows, messages and summary of a run."""
    name = prepared.generated.partition.net.name
    texts = {
        f"{name}.trace.jsonl": trace_text(record.header, record.events),
        "rows.tsv": rows_tsv(record.messages, prepared.config.report.rows),
        "messages.tsv": messages_tsv(prepared.generated.partition, record.traffic),
        "summary.json": json.dumps(summary, indent=1, ensure_ascii=False) + "\n",
    }
    partial = {file: out / f".{file}.tmp" for file in texts}
    try:
        for file, text in texts.items():
            partial[file].write_text(text, encoding="utf-8")
        for file, path in partial.items():
            path.replace(out / file)
    except OSError as problem:
        raise OutputFolderError(
            f"cannot write the results in `{out}`: {os_reason(problem)}"
        ) from problem
    finally:
        for path in partial.values():
            with suppress(OSError):
                path.unlink(missing_ok=True)
