"""`pn2code check --geometry`: the geometry of a cell in all of its layouts, over all states of its net.

found = examine(opened, layout, limits, folder, d)         # Geometry; None after an error that was reported
found.answer                                               # "yes", "no", "unknown"
"""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.base.deadline import OverError
from pn2code.base.frozen import frozen
from pn2code.base.how_far import Say, silent
from pn2code.cell.config import CellConfig
from pn2code.cell.load import load as load_cell
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.geometry import codes
from pn2code.geometry.answers import Layout, Verdict, worst
from pn2code.geometry.graph import CellGraph, explore_cell, explore_wider, most_held
from pn2code.geometry.large import MOST_OF_PART, answer_of, sought_in
from pn2code.geometry.look import Look
from pn2code.geometry.look_options import Options
from pn2code.geometry.progress import LATE
from pn2code.geometry.supervised import Supervised
from pn2code.geometry.words import reason
from pn2code.robot import scene
from pn2code.robot.robot_cell import RobotCell
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.programs import partition_of
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.exploring.limits import Limits, Order


@frozen(eq=False)
class Geometry:
    """What is known of a cell.

    Args:
        layouts: those that were looked at, with the scene of each.
        why: why nothing is known; "": something is.
    """

    layouts: tuple[tuple[Layout, RobotCell], ...]
    why: str = ""

    @property
    def answer(self) -> Verdict:
        """Of all layouts together."""
        return "unknown" if self.why else worst([x.answer for x, _ in self.layouts])

    def row(self) -> dict[str, Any]:
        """For programs (docs/geometry.md)."""
        return {
            "answer": self.answer,
            "why": self.why or None,
            "layouts": [x.row() for x, _ in self.layouts],
        }


def examine(
    opened: OpenNet,
    layout: str | None,
    limits: Limits,
    folder: Path,
    d: Diagnostics,
    stage: Callable[[str], None] = silent,
    say: Say = silent,
    late: Callable[[Geometry], None] = lambda _found: None,
) -> Geometry | None:
    """Looks at everything; None after an error that was reported.

    Args:
        opened: the cell.
        layout: only this one; None: all of them.
        limits: of the exploration.
        folder: of the traces.
        d: gets the errors.
        stage: hears in words what is done; say: and how far it is.
        late: hears what is wrong, if the time is up (an `OverError` leaves this) and something was found until then.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    config = cell_of(opened, d)
    if config is None or not is_there(config, d):
        return None
    partition = partition_of(opened, config, d)
    if partition is None:
        return None
    cells = cells_of(config, layout, d)
    if cells is None:
        return None
    if not any(cell.moving for _, cell in cells):
        return Geometry((), "no robot of the cell has an arm")
    stage("exploring the cell as its programs run ...")
    try:
        graph = explore_cell(partition, opened.storage, limits, d, opened.initial, say=say)
    except NotModelledError as problem:
        return Geometry((), f"the cell as it runs cannot be modelled: {problem}")
    if graph is None:
        return None
    wider = None
    if not graph.arcs:
        if graph.why in ("states", "memory"):
            stage("exploring a net that does more and has fewer states ...")
            wider = explore_wider(partition, opened.storage, limits, Diagnostics())
        is_open = wider is None or not wider.arcs
        if is_open and graph.why == "states" and limits.max_states is None:
            most = most_held()
            stage(f"exploring {most:,} states of the cell ...")
            graph = explore_cell(
                partition, opened.storage, limits, d, opened.initial, most=most, say=say
            )
            if graph is None:
                return None
            wider = None
        if is_open and not graph.arcs and graph.why not in ("states", "memory"):
            return Geometry((), reason(graph.why, graph.raised))

    def part(order: Order, shuffle: int) -> CellGraph | None:
        most = min(limits.max_states or MOST_OF_PART, MOST_OF_PART)
        way = "breadth first" if order is Order.BREADTH else f"depth first, order {shuffle + 1}"
        stage(f"exploring a part of {most:,} states of the cell, {way} ...")
        some = replace(limits, max_states=most, order=order)
        return explore_cell(
            partition,
            opened.storage,
            some,
            Diagnostics(),
            opened.initial,
            part=True,
            shuffle=shuffle,
        )

    def explore(changed: Partition) -> CellGraph | None:
        try:
            return explore_cell(changed, opened.storage, limits, Diagnostics(), opened.initial)
        except NotModelledError:
            return None

    stem = re.sub(r"[^A-Za-z0-9_.-]+", "_", opened.flat.name) or "net"
    folder.mkdir(parents=True, exist_ok=True)
    options = Options(
        folder,
        stem,
        opened.initial,
        explore,
        stage,
        limits.threads,
        say,
        Supervised(partition, config),
    )
    found = []
    for name, cell in cells:
        if len(cells) > 1:
            stage(f"layout `{name}` ...")
        looking = Look(graph, cell, options, name)
        try:
            layout_: Layout | None
            if wider is not None and wider.arcs:
                layout_ = answer_of(looking, wider, part)
            elif graph.arcs:
                layout_ = looking.answer()
            else:
                layout_ = sought_in(looking, reason(graph.why), part)
            if layout_ is None:
                return Geometry((), reason(graph.why))
            found.append((layout_, cell))
        except OverError:
            found.append((looking.so_far(), cell))
            found += [(_untouched(*rest), rest[1]) for rest in cells[len(found) :]]
            if any(x.answer == "no" for x, _ in found):
                late(Geometry(tuple(found)))
            raise
        finally:
            looking.close()
    return Geometry(tuple(found))


def _untouched(name: str, cell: RobotCell) -> Layout:
    """A layout that nobody has looked at."""
    devices = tuple(r.name for r in cell.devices)
    return Layout(name, 0, 0, (), (), 0, 0, 0.0, LATE, devices=devices)


def cell_of(opened: OpenNet, d: Diagnostics) -> CellConfig | None:
    """The cell beside a net; None, which is reported: there is none."""
    if opened.config is None:
        d.error(
            codes.GEOMETRY_NO_CELL,
            "only a cell has a geometry, and there is no cell.toml",
            Origin(opened.flat.file),
            hint="give a cell.toml or its folder",
        )
    return opened.config


def is_there(config: CellConfig, d: Diagnostics) -> bool:
    """Whether the library that measures distances is installed; without it that is reported."""
    if importlib.util.find_spec("pybullet") is not None:
        return True
    d.error(
        codes.GEOMETRY_NO_LIBRARY,
        "distances between arms are measured with PyBullet, which is not installed",
        Origin(str(config.path)),
        hint="`pip install 'pn2code[cell]'` brings it (there are packages for Python 3.11 at the latest; for later "
        "ones it is compiled)",
    )
    return False


def cells_of(
    config: CellConfig, layout: str | None, d: Diagnostics
) -> list[tuple[str, RobotCell]] | None:
    """What stands in each layout, or in one of them; None after an error that was reported."""
    names = list(config.layouts) or [""]
    if layout is not None:
        chosen = load_cell(config.path, d, layout=layout)
        if chosen is None:
            return None
        names = [layout]
    out = []
    for name in names:
        chosen = config if name == config.layout else load_cell(config.path, d, layout=name)
        if chosen is None:
            return None
        cell = scene.load(chosen.geometry, chosen.folder, chosen.locator.origin, d, partial=True)
        if cell is None:
            return None
        out.append((name, cell))
    return out
