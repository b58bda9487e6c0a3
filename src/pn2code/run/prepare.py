"""What has to be there before a cell can run: its programs, generated and built, and its arms."""

from __future__ import annotations

from dataclasses import field
from pathlib import Path

from pn2code import pipeline
from pn2code.base.frozen import frozen
from pn2code.base.how_far import beginning
from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.config import CellConfig
from pn2code.cell.locate import locate
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.emission.output import OutputFile
from pn2code.emission.write import write
from pn2code.input_files import begin
from pn2code.net.flat import FlatNet
from pn2code.robot import scene
from pn2code.robot.backend import BackendName
from pn2code.robot.choose_backend import expect_backend
from pn2code.robot.robot_cell import RobotCell
from pn2code.run.codes import RUN_NO_CELL
from pn2code.tdl.check import CheckedProgram, check
from pn2code.tdl.parse import parse
from pn2code.toolchain import build


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
    scripts = scripts_of(generated, config, d)
    if robot_cell is None or scripts is None or d.has_errors:
        return None
    folder = options.out / "program"
    write(folder, generated.files)
    beginning("compiling the supervisor")
    program = build.build(folder, generated.files, d, target="supervisor.traced")
    if program is None:
        return None
    return Prepared(generated, config, robot_cell, scripts, program)


def scripts_of(
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
