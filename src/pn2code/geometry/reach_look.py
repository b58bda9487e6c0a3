"""`pn2code reach`: the task of each arm from the state space of its cell, and the map of bases for it.

found = look(opened, Wanted(layout=None, robot=None, around=1.0, steps=41), d)
found[0].robot, found[0].map.best
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.geometry import codes
from pn2code.geometry.activities import Doing
from pn2code.geometry.answers import STOPPED
from pn2code.geometry.check import cell_of, cells_of
from pn2code.geometry.graph import CellGraph, explore_cell, most_held
from pn2code.geometry.legs import Planner
from pn2code.geometry.reach_map import Map, Task, grid, reach_map
from pn2code.geometry.situations import Situations
from pn2code.geometry.words import reason
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.verdict.opened import OpenNet
from pn2code.verdict.programs import partition_of
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.exploring.limits import Limits


@frozen
class Wanted:
    """What is asked.

    Args:
        layout: where arms stand; None: the first.
        robot: only this one; None: all.
        around: m, how far from where a robot stands; steps: bases along each side.
    """

    layout: str | None = None
    robot: str | None = None
    around: float = 1.0
    steps: int = 41


@frozen(eq=False)
class Found:
    """The map of one robot.

    Args:
        robot: as it stands; cell: with the others.
        task: what it has to reach; here: how it reaches that from where it stands.
        open: why the task may be larger; "": it is not.
    """

    robot: CellRobot
    cell: RobotCell
    task: Task
    map: Map
    here: Map
    open: str = ""


def look(
    opened: OpenNet,
    wanted: Wanted,
    limits: Limits,
    d: Diagnostics,
    stage: Callable[[str], None] = lambda _text: None,
) -> list[Found] | None:
    """The maps; None after an error that was reported."""
    config = cell_of(opened, d)
    if config is None:
        return None
    cells = cells_of(config, wanted.layout or config.layout or None, d)
    partition = partition_of(opened, config, d)
    if cells is None or partition is None:
        return None
    _, cell = cells[0]
    robots = [r for r in cell.robots if wanted.robot in (None, r.name)]
    if not robots:
        _no_robot(config, wanted.robot, {r.name: r for r in cell.robots}, d)
        return None
    graph = told(opened, config, partition, limits, d, stage)
    if graph is None:
        return None
    stage("looking where arms can be ...")
    situations = Situations(graph, Doing(Planner(cell), cell), tuple(r.name for r in cell.moving))
    situations.explore()
    why = reason(situations.why) or (STOPPED if situations.stopped else "")
    found = []
    for robot in robots:
        task = Task.of(situations, robot)
        if not len(task.poses):
            continue
        stage(f"moving {robot.name} ...")
        bases = grid(robot, wanted.around, wanted.steps)
        here = reach_map(robot, task, grid(robot, 0.0, 1))
        made = reach_map(robot, task, bases)
        found.append(Found(robot, cell, task, made, here, why))
    return found


def told(
    opened: OpenNet,
    config: CellConfig,
    partition: Partition,
    limits: Limits,
    d: Diagnostics,
    stage: Callable[[str], None],
) -> CellGraph | None:
    """The graph of the cell, in which all that arms are told is; None: it is not known, which was reported."""
    stage("exploring the cell as its programs run ...")
    try:
        graph = explore_cell(partition, opened.storage, limits, d, opened.initial, most=most_held())
    except NotModelledError as problem:
        d.error(codes.REACH_UNKNOWN, f"what arms are told is not known: {problem}", _at(config))
        return None
    if graph is not None and not graph.arcs:
        why = f"what arms are told is not known: {reason(graph.why, graph.raised)}"
        d.error(codes.REACH_UNKNOWN, why, _at(config))
        return None
    return graph


def _at(config: CellConfig) -> Origin:
    return Origin(str(config.path))


def _no_robot(
    config: CellConfig, name: str | None, robots: Mapping[str, CellRobot], d: Diagnostics
) -> None:
    if name is None:
        d.error(codes.REACH_UNKNOWN, "no robot of the cell has an arm", _at(config))
        return
    d.error(
        codes.REACH_UNKNOWN,
        f"the cell has no robot `{name}` with an arm",
        _at(config),
        hint=did_you_mean(name, robots, f"known are {', '.join(f'`{r}`' for r in robots)}"),
    )
