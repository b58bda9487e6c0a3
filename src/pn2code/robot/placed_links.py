"""The links of a robot with its tool: which axis moves each, and where it is in the frame of that axis."""

from __future__ import annotations

import numpy as np

from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import Array
from pn2code.robot.urdf import Joint, Urdf


def placed_links(robot: CellRobot) -> list[tuple[str, int, Array]]:
    """Each link with the axis that moves it last (`Link.joint`), and its frame in that of this axis."""
    arm = robot.arm
    moving = {name: i for i, name in enumerate(arm.axes)}
    out = []
    for link in arm.urdf.links:
        joint, frame = _placed(arm.urdf, link, moving)
        out.append((link, joint, frame))
    if robot.tool is not None:
        for link in robot.tool.urdf.links:
            out.append((f"tool_{link}", len(arm.axes) + 1, _placed(robot.tool.urdf, link, {})[1]))
    return out


def tool_links(robot: CellRobot) -> frozenset[str]:
    """The names that the links of its tool have beside those of the arm."""
    links = () if robot.tool is None else robot.tool.urdf.links
    return frozenset(f"tool_{link}" for link in links)


def _placed(tree: Urdf, link: str, moving: dict[str, int]) -> tuple[int, Array]:
    joint, frame = 0, np.eye(4)
    for step in tree.chain(link):
        if step.name in moving:
            joint, frame = moving[step.name] + 1, np.eye(4)
        else:
            frame = frame @ _at_zero(step)
    return joint, frame


def _at_zero(joint: Joint) -> Array:
    """Joints that are no axes of the arm stand at zero."""
    return joint.T_parent_joint
