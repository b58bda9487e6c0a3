"""Where an arm or a device stands when a move begins, in words.

stands_at(robot, stand)     # "1000 0 850, 180 0 0", the pose of the TCP in use; of a device "door 0, vice 200"
"""

from __future__ import annotations

import numpy as np

from pn2code.geometry.legs import Stand
from pn2code.geometry.words import numbers, position
from pn2code.robot.external import ExternalAxis
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import CellRobot, RobotCell
from pn2code.robot.transforms import Array, pose_of


def stands_at(robot: CellRobot, stand: Stand) -> str:
    """The TCP pose of an arm; the positions of a device's axes, of a clamp its gap. Belts stand nowhere."""
    if not robot.is_device:
        own = robot.of_tool(stand.tool, stand.T_base_tcp)
        return numbers(pose_of(robot.T_world_base @ own))
    jaws = {jaw for clamp in robot.axes.clamps for jaw in clamp.jaws}
    alone = [a for a in robot.axes if a.name not in jaws and a.belt is None]
    shown = [_axis(a, robot, stand.q, (a.name,)) for a in alone]
    shown += [_axis(c.axis, robot, stand.q, c.jaws) for c in robot.axes.clamps]
    return ", ".join(shown)


def _axis(axis: ExternalAxis, robot: CellRobot, q: Array, moved: tuple[str, ...]) -> str:
    place = float(np.sum(q[[robot.index(name) for name in moved]]))
    return f"{axis.name} {position(place, axis.is_track)}"


def at_rest(cell: RobotCell, part: Part, stand: Stand) -> str:
    """Where a part stands on a plate of an arm or device, in mm: however the plate is turned, its directions."""
    robot = cell.robot(stand.robot)
    frame = robot.T_world_plate(robot.plate(part.plate), stand.q) @ part.frame
    return " ".join(f"{v:.0f}" for v in np.round(1000.0 * frame[:3, 3]) + 0.0)
