"""A cell as `check --geometry` goes through it before anything is swept.

graph, arms = graph_of(folder)
found = situations(folder)          # found.why, found.situations, found.doing.activities
"""

from __future__ import annotations

from pathlib import Path

from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.activities import Doing
from pn2code.geometry.check import cells_of
from pn2code.geometry.graph import CellGraph, explore_cell
from pn2code.geometry.legs import Planner
from pn2code.geometry.situations import Situations
from pn2code.robot.robot_cell import RobotCell
from pn2code.verdict.opened import read
from pn2code.verify.exploring.limits import Limits


def graph_of(folder: Path) -> tuple[CellGraph, RobotCell]:
    """A cell as its programs run, and what stands in it."""
    d = Diagnostics()
    opened = read(folder, {}, d)
    assert opened is not None and opened.config is not None, [e.message for e in d.errors]
    partition, cells = divide(opened.flat, opened.config, d), cells_of(opened.config, None, d)
    assert partition is not None and cells is not None, [e.message for e in d.errors]
    ((_, arms),) = cells
    graph = explore_cell(partition, opened.storage, Limits(), d)
    assert graph is not None and not graph.why
    return graph, arms


def situations(folder: Path) -> Situations:
    """All situations of a cell, of which nothing is swept."""
    graph, arms = graph_of(folder)
    found = Situations(graph, Doing(Planner(arms), arms), tuple(r.name for r in arms.moving))
    found.explore()
    return found
