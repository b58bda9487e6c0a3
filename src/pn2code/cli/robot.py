"""`pn2code robot`: one robot's script by itself, against a supervisor that runs on its own."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from pn2code import registers
from pn2code.base.os_reason import os_reason
from pn2code.base.writable import why_file_unwritable
from pn2code.cell.codes import CELL_MISSING
from pn2code.cell.divide import divide
from pn2code.cell.locate import locate
from pn2code.channels import ChannelSpec, SharedDirectory, specs_of
from pn2code.cli.options import Exit, Format, FormatOption, finite, print_diagnostics, stop
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.diagnostics.codes import register
from pn2code.emission.manifest import NAME as MANIFEST
from pn2code.net import front
from pn2code.robot.commands import Command
from pn2code.run.robot import Arm, InstantArm, RobotExit, RobotPlayer, script_specs
from pn2code.run.sensors import Sensors
from pn2code.semantics.evaluation.constants import compute
from pn2code.tdl import tree as t
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.parse import parse

if TYPE_CHECKING:
    from pn2code.robot.executor import RobotExecutor
    from pn2code.run.device import DeviceExecutor

EPILOG = """Examples:

  generated/riveting/supervisor --dir shared --input examples/riveting

  pn2code robot generated/riveting/robot1.tdl --dir shared --cell examples/riveting

  pn2code robot generated/riveting/robot2.tdl --dir shared --cell examples/riveting --speed 10
"""

ROBOT_FILE = register(
    "robot-file",
    "the script's files are not the cell's channels",
    "With `--cell`, each `input` of a script must be a channel to this robot, and each `output` one from it. The "
    "script was probably generated from another state of the cell: generate it again.",
)


def robot(
    script: Annotated[Path, typer.Argument(help="The robot's script (.tdl).")],
    directory: Annotated[
        Path | None,
        typer.Option(
            "--dir",
            help="The shared directory of the supervisor (default: the directory that the supervisor uses by default).",
        ),
    ] = None,
    name: Annotated[
        str | None,
        typer.Option(help="The robot's name (default: the name of the script's program)."),
    ] = None,
    cell: Annotated[
        Path | None,
        typer.Option(
            help="The cell. With it, moves take the time that they need and are checked; without it, they take no time."
        ),
    ] = None,
    layout: Annotated[
        str | None, typer.Option(help="The layout of cell.toml to use (default: the first).")
    ] = None,
    speed: Annotated[
        float,
        typer.Option(
            min=0.01,
            max=1000.0,
            callback=finite,
            help="With --cell, move this many times as fast as a real robot.",
        ),
    ] = 1.0,
    trace: Annotated[
        Path | None,
        typer.Option(
            "--trace",
            metavar="FILE",
            help="Write what the robot does to FILE (*.trace.jsonl) while it does it, for `pn2code watch`.",
        ),
    ] = None,
    wait: Annotated[
        float,
        typer.Option(min=0.0, callback=finite, help="How many seconds to wait for the supervisor."),
    ] = 10.0,
    verbose: Annotated[bool, typer.Option("-v", "--verbose", help="Print each command.")] = False,
    form: FormatOption = Format.FULL,
) -> None:
    """Run one robot's script in real time, as a process of its own.

    A script that uses sensors, or messages that are enumerations, needs --cell.

    The exit code is 0 if the cell has finished, 1 if the script failed, 3 if the supervisor stopped or died, 4 after a
    fault of a channel, and 2 if files cannot be read or written.
    """
    d = Diagnostics()
    program = _load(script, d)
    if program is None:
        stop(d, form)
    name = name or program.tree.name
    arm: Arm = InstantArm()
    specs = script_specs(program, name)
    sensors = Sensors()
    if cell is not None:
        found = _in_cell(cell, layout, name, d)
        if found is None:
            stop(d, form)
        specs, executor, sensors = found
        from pn2code.run.arm import MovingArm  # loads NumPy and the like

        arm = MovingArm(executor, speed)
        _check_files(program, specs, name, d)
    elif asked := program.sensors:
        names = ", ".join(f"`{x}`" for x in asked)
        _usage(
            f"`{script.name}` asks {names}: the values of sensors are given in the cell, so --cell is needed"
        )
    if d.has_errors:
        stop(d, form)
    print_diagnostics(d.sorted(), form)

    lines = script.read_text(encoding="utf-8").split("\n")  # as its parser counts them

    def show(_command: Command, line: int) -> None:
        if verbose:
            typer.echo(f"{script.name}:{line}: {lines[line - 1].strip()}")

    if directory is None:
        directory = _default_directory(script)
    stopping = _signals()
    with SharedDirectory(directory, name, specs) as shared:
        player = RobotPlayer(
            program,
            shared,
            script.name,
            arm,
            on_command=show,
            interrupted=lambda: bool(stopping),
            sense=lambda sensor: sensors.ask(name, sensor),
            wait_s=wait,
        )
        if trace is None:
            ended = player.run()
        else:
            from pn2code.run.journals import journalled

            _expect_writable(trace)
            ended = journalled(player, trace)
    if ended.code:
        typer.echo(f"pn2code: {name} stopped: {ended.reason}", err=True)
        raise typer.Exit(Exit.USAGE if ended.code is RobotExit.SYSTEM else int(ended.code))
    typer.echo(f"{name}: finished")


def _default_directory(script: Path) -> Path:
    """Where the supervisor that was generated with the script has its files, unless it is told otherwise."""
    try:
        text = (script.parent / MANIFEST).read_text(encoding="utf-8")
        source = json.loads(text)["source"]
    except (OSError, ValueError, KeyError):
        _usage(
            f"there is no {MANIFEST} beside `{script}` that says where the supervisor has its files; "
            "give its shared directory with --dir"
        )
    memory = Path("/dev/shm")
    return memory / f"pn2code-{Path(source).stem}" if memory.is_dir() else script.parent / "shared"


def _in_cell(
    cell: Path, layout: str | None, name: str, d: Diagnostics
) -> tuple[tuple[ChannelSpec, ...], RobotExecutor | DeviceExecutor, Sensors] | None:
    """The channels of a cell, what carries out the commands of one of its robots or devices, its sensors."""
    from pn2code.robot import scene
    from pn2code.robot.executor import RobotExecutor
    from pn2code.run.device import DeviceExecutor
    from pn2code.run.sensors import load as load_sensors

    found = locate(cell, d, layout=layout)
    if found is None:
        return None
    path, config = found
    if config is None:
        _usage(f"`{cell}` has no cell.toml beside it; give the folder of a cell")
    if name not in {r.name for r in config.programs}:
        known = ", ".join(f"`{r.name}`" for r in config.programs)
        _usage(f"the cell has no robot `{name}`; choose one of {known} with --name")
    flat = front.load(path, d, config.values, compute=compute)
    flat, config = registers.as_messages(flat, config, d)
    assert config is not None, "it was there"
    partition = divide(flat, config, d) if flat is not None else None
    loaded = scene.load(config.geometry, config.folder, config.locator.origin, d)
    if partition is None or loaded is None or d.has_errors:
        return None
    sensors = load_sensors(config, partition.net, (config.folder,), None, d)
    if sensors is None:
        return None
    if name not in {r.name for r in loaded.moving}:
        return specs_of(partition), DeviceExecutor(name), sensors
    return (
        specs_of(partition),
        RobotExecutor(loaded.robot(name), loaded.motion, loaded.frames),
        sensors,
    )


def _check_files(
    program: CheckedProgram, specs: tuple[ChannelSpec, ...], name: str, d: Diagnostics
) -> None:
    """The script's files must be channels of this robot, in the same direction."""
    channels = {(s.file, s.writer == name) for s in specs if name in (s.writer, s.reader)}
    for file in program.files.values():
        output = file.direction is t.Direction.OUTPUT
        if (file.path, output) not in channels:
            d.error(
                ROBOT_FILE,
                f"{file.direction.value} `{file.path}` of the script is not a channel "
                f"{'from' if output else 'to'} robot `{name}`",
                file.span,
                hint="generate the script from this cell again, or choose the robot with --name",
            )


def _expect_writable(trace: Path) -> None:
    if why := why_file_unwritable(trace, makes_folders=False):
        _usage(f"cannot write `{trace}`: {why}")


def _usage(text: str) -> NoReturn:
    typer.echo(f"pn2code: {text}", err=True)
    raise typer.Exit(Exit.USAGE)


def _load(script: Path, d: Diagnostics) -> CheckedProgram | None:
    try:
        text = script.read_text(encoding="utf-8")
    except OSError as problem:
        d.error(
            CELL_MISSING,
            f"cannot read `{script}`: {os_reason(problem)}",
            Origin(str(script)),
            hint="check the path",
        )
        return None
    except UnicodeDecodeError:
        d.error(CELL_MISSING, f"`{script}` is not UTF-8 text", Origin(str(script)))
        return None
    tree = parse(SourceText(text, Origin(str(script), 1, 1)), d)
    return check(tree, d, None) if tree is not None else None


def _signals() -> list[int]:
    """SIGINT and SIGTERM stop the robot safely; the list fills when one comes."""
    seen: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        seen.append(number)

    signal.signal(signal.SIGINT, note)
    signal.signal(signal.SIGTERM, note)
    return seen
