"""Tools that lie where the robot that changes them cannot come.

    out_of_reach(cell, config, " in layout `paper`", d)

The coupling has to stand where the tool lies, whatever the net commands; so a run would stop there.
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.diagnostics import Diagnostics
from pn2code.robot import codes
from pn2code.robot.commands import MoveLinear
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.robot_cell import CellRobot, RobotCell


def out_of_reach(cell: RobotCell, config: CellConfig, where: str, d: Diagnostics) -> None:
    """Warns of each of them that a primitive couples or uncouples.

    Args:
        cell: robots, tools and places in a layout.
        config: the cell.
        where: the layout in words.
        d: gets the warnings.
    """
    handled = {
        p.handling.part
        for p in config.primitives.values()
        if p.handling is not None and p.handling.is_of_tool
    }
    for robot in cell.robots:
        if robot.axes.tracks:
            continue  # where the arm stands then is not known here
        for name in robot.tools:
            rack = robot.tools[name].rack
            if rack and name in handled and (why := _why_not(cell, robot, rack)):
                d.warning(
                    codes.ROBOT_REACH,
                    f"tool `{name}` lies{where} at `{rack}`, where robot `{robot.name}` can neither take nor leave "
                    f"it: {why}",
                    config.locator.origin("places", rack),
                    hint="places are in m and degrees; with the tool hanging down, `roll` is 180",
                )


def _why_not(cell: RobotCell, robot: CellRobot, rack: str) -> str:
    """Why the coupling cannot come to a place; "": it can."""
    executor = RobotExecutor(robot, cell.motion, cell.frames)
    executor.stand(executor.q, executor.T_base_tcp, "")
    try:
        executor.reach(MoveLinear(cell.places[rack], "world"))
    except MotionFault as fault:
        return fault.message.removeprefix(f"robot `{robot.name}`: ")
    return ""
