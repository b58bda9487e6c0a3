"""A robot whose base is elsewhere: its tracks go with it, its turntables stay where they are in the world.

there = standing_at(robot, base)
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.robot.carried import WithAxes, joined
from pn2code.robot.commands import Pose
from pn2code.robot.external import Externals
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import inverse, matrix_of


def standing_at(robot: CellRobot, base: Pose) -> CellRobot:
    """The robot as cell.toml would have it with this base."""
    if not robot.axes.tables:
        return replace(robot, base=base)
    back = inverse(matrix_of(base)) @ robot.T_world_base
    tables = tuple(replace(a, T_base_axis=back @ a.T_base_axis) for a in robot.axes.tables)
    axes = Externals(robot.axes.tracks, tables)
    whole = joined(robot.kinematics.alone.arm, axes)
    return replace(
        robot,
        base=base,
        axes=axes,
        arm=whole,
        kinematics=WithAxes(robot.kinematics.alone, axes, whole),
        tcps={name: WithAxes(k.alone, axes, whole) for name, k in robot.tcps.items()},
    )
