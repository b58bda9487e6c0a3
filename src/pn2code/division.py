"""The net and its owners, and whether everything that cell.toml says fits them.

This is the part of the pipeline that `check` shares with `generate`; it loads nothing that lowers or emits.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from pn2code.base.kept_answers import KeptAnswers
from pn2code.cell.config import CellConfig
from pn2code.cell.divide import divide
from pn2code.cell.load import load as load_cell
from pn2code.cell.names import check_names
from pn2code.cell.partition import Partition
from pn2code.cell.primitives import check_primitives
from pn2code.cell.taken import kinds_taken
from pn2code.diagnostics import Diagnostics, Span
from pn2code.net.flat import FlatNet

if TYPE_CHECKING:
    from pn2code.robot.robot_cell import RobotCell

Taken = Mapping[str, Mapping[str, Span]]
FINE = "fine"
"""What is kept of a question about which there is nothing to report."""


def divided(
    net: FlatNet,
    config: CellConfig | None,
    d: Diagnostics,
    *,
    to_run: bool = False,
    kept: KeptAnswers | None = None,
) -> Partition | None:
    """The net and its owners, with everything that cell.toml says compared with it; None after an error.

    This takes no time, so it comes before anything is explored.

    Args:
        net: the net.
        config: the cell; None: a net that is one program.
        d: gets the errors.
        to_run: whether each robot must say where it stands; without, a robot that says nothing of its arm is left out.
        kept: what earlier commands have found of robots and scenes.
    """
    before = len(d.errors)
    partition = divide(net, config, d)
    if config is None:
        return partition
    if partition is not None:
        check_primitives(partition, config, d)
    check_names(net, config, d)
    taken = kinds_taken(partition, config) if partition is not None else None
    check_geometry(config, d, to_run=to_run, taken=taken, kept=kept)
    return partition if len(d.errors) == before else None


def check_geometry(
    config: CellConfig,
    d: Diagnostics,
    *,
    to_run: bool,
    taken: Taken | None = None,
    kept: KeptAnswers | None = None,
) -> None:
    """Reports what is wrong with the robots and the scene, in all layouts.

    Args:
        config: the cell.
        d: gets the errors.
        to_run: whether each robot must say where it stands.
        taken: the kinds of parts that each robot takes; None: that is not known, and no load is looked at.
        kept: what earlier commands have found; of a cell with which nothing was wrong nothing is loaded.
    """
    question = None
    if kept is not None and kept.is_settled(config.path):
        kinds = None if taken is None else [(robot, tuple(own)) for robot, own in taken.items()]
        question = kept.question("scene", *said_of_space(config), to_run, kinds)
        if question.answer() == FINE:
            return
    from pn2code.robot import scene  # loads NumPy, which nets without a cell do not need
    from pn2code.robot.files_of import files_of

    before, files = d.reported, set[Path]()
    for layout in config.layouts or {"": ""}:
        cell = config if layout == config.layout else load_cell(config.path, d, layout=layout)
        if cell is None:
            continue
        at = cell.locator.origin
        stands = scene.load(cell.geometry, cell.folder, at, d, partial=not to_run)
        if stands is not None:
            files |= files_of(stands)
            if taken is not None:
                _check_loads(stands, cell, taken, f" in layout `{layout}`" if layout else "", d)
    if question is not None and d.reported == before:
        question.keep(FINE, files)


def said_of_space(config: CellConfig) -> tuple[object, ...]:
    """All that cell.toml says of space, in all layouts."""
    return str(config.path.absolute()), config.path.read_bytes(), config.layout


def _check_loads(
    stands: RobotCell, config: CellConfig, taken: Taken, where: str, d: Diagnostics
) -> None:
    """What each robot carries, with all that its pages take, is not too much."""
    from pn2code.robot import codes

    for robot in stands.robots:
        own = taken.get(robot.name, {})
        for kind, span in own.items():
            if kind not in robot.carries:
                d.error(
                    codes.ROBOT_PAYLOAD,
                    f"robot `{robot.name}` takes a part `{kind}`, which `carries` of it does not name",
                    span,
                    hint=f'add "{kind}" to `carries` of robot `{robot.name}` in cell.toml',
                )
        if problem := robot.overload(stands.parts, own):
            d.error(
                codes.ROBOT_PAYLOAD,
                problem + where,
                config.locator.origin("robots", robot.name, "model"),
                hint="choose another arm, or a lighter tool or part (`mass` of the kind of parts, kg)",
            )
