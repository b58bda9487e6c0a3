"""Where the arms of a cell can go, in each of its layouts, by closed-form inverse kinematics.

arms = Arms.of(config, d)                   # None: there are no arms, or something is wrong with them
arms.why_unreachable("robot", MoveJoint(pose))  # "" or "robot `robot`: the pose is out of reach: 3200 mm from the..."
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from pn2code.cell.config import CellConfig
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.robot import scene
from pn2code.robot.commands import (
    Along,
    Move,
    MoveCircular,
    MoveLinear,
    tcp_of,
    without_pace,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.files_of import files_of
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import RobotCell


class Arms:
    """The arms of a cell.

    Args:
        cells: by the name of the layout ("" where there are none), what stands there.

    Attributes:
        robots: the names of those with an arm.
    """

    def __init__(self, cells: Mapping[str, RobotCell]) -> None:
        self._cells = cells
        self.robots = frozenset(r.name for cell in cells.values() for r in cell.moving)
        self._known: dict[tuple[str, Move], tuple[str, ...]] = {}

    @staticmethod
    def of(config: CellConfig, d: Diagnostics, *, partial: bool = True) -> Arms | None:
        """Those of a cell; `partial`: robots of which nothing is said are left out."""
        cells: dict[str, RobotCell] = {}
        for layout in config.layouts or {"": ""}:
            chosen = config if layout == config.layout else load_cell(config.path, d, layout=layout)
            if chosen is None:
                return None
            at = chosen.locator.origin
            cell = scene.load(chosen.geometry, chosen.folder, at, d, partial=partial)
            if cell is None:
                return None
            cells[layout] = cell
        found = Arms(cells)
        return found if found.robots else None

    @property
    def files(self) -> frozenset[Path]:
        """The files of their models, and of what stands around them."""
        return frozenset[Path]().union(*map(files_of, self._cells.values()))

    def why_unreachable(self, robot: str, command: Move) -> str:
        """Why the arm cannot come to where a command leads, in words that name robot, pose and layout; "": it can.

        Moves relative to the tool are not looked at: where they lead depends on where they begin. Of lines and arcs
        only the end is looked at, on any branch. Of a robot that changes tools: with none of them, and not without.
        """
        ways = self._ways(robot, command)
        return ways[0] if all(ways) else ""

    def depends_on_tool(self, robot: str, command: Move) -> bool:
        """Whether the arm comes there with some of the tools that it changes, or with none, and not with others."""
        ways = self._ways(robot, command)
        return any(ways) and not all(ways)

    def _ways(self, robot: str, command: Move) -> tuple[str, ...]:
        """Why not with each tool that may be in use then."""
        key = (robot, without_pace(command))
        if key not in self._known:
            tools = self._tools(robot)
            wanted = tcp_of(command)
            if wanted:
                tools = (wanted,) if wanted in tools else ("",)
            self._known[key] = tuple(self._looked(robot, command, tool) for tool in tools)
        return self._known[key]

    def _tools(self, robot: str) -> tuple[str, ...]:
        """What a robot may have in use: each tool that it changes, or none; what it begins with comes first."""
        own = [r for cell in self._cells.values() for r in cell.robots if r.name == robot]
        return tuple(dict.fromkeys(x for r in own for x in (r.begins_with, "", *r.tools))) or ("",)

    def undecided(self, robot: str, command: Move) -> frozenset[str]:
        """The external axes on which it depends whether the arm comes there, and which the move does not tell."""
        return frozenset[str]().union(
            *(
                RobotExecutor(r, cell.motion, cell.frames).undecided(command)
                for cell in self._cells.values()
                for r in cell.robots
                if r.name == robot and r.axes
            )
        )

    def external_homes(self, robot: str) -> dict[str, tuple[Along, ...]]:
        """Of each external axis of a robot where it begins, in each layout."""
        out: dict[str, tuple[Along, ...]] = {}
        for cell in self._cells.values():
            for axis in (a for r in cell.robots if r.name == robot for a in r.axes):
                place = Along(axis.name, axis.home, axis.is_track)
                out[axis.name] = (*out.get(axis.name, ()), place)
        return out

    def _looked(self, name: str, command: Move, tool: str) -> str:
        is_free = isinstance(command, MoveLinear | MoveCircular)
        for layout, cell in self._cells.items():
            for robot in cell.moving:
                if robot.name != name or (tool and tool not in robot.tools):
                    continue
                own = replace(robot, begins_with=tool)
                own = replace(own, branch=None) if is_free else own
                try:
                    RobotExecutor(own, cell.motion, cell.frames).reach(command)
                except MotionFault as fault:
                    return f"{fault.message} (layout `{layout}`)" if layout else fault.message
        return ""
