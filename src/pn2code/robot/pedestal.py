"""How wide the pedestal of an arm is: somewhat wider than its base link, as its shapes for distances are.

half_width(robot)              # m: 0.17 of a UR5e, 0.46 of a large KUKA arm, which is the most
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import rotation_xyz

WIDEST = 0.46
"""m: half as wide is a pedestal at most, and that of a base link whose extent is not known."""
_MARGIN = 0.1


def half_width(robot: CellRobot) -> float:
    """Half of the side of the square that a robot stands on, m."""
    if robot.base.rx or robot.base.ry:
        return WIDEST  # what is above the pedestal is not the foot of the base link
    link = next(
        (e for e in robot.arm.urdf.xml.findall("link") if e.get("name") == robot.root), None
    )
    shapes = [] if link is None else link.findall("collision")
    try:
        reached = [_reach(shape) for shape in shapes]
    except (AttributeError, TypeError, ValueError):
        return WIDEST  # a shape with something missing: the collision library says so
    # Whole centimetres: nobody should take it for a measure of the arm.
    return min(WIDEST, round(max(reached, default=WIDEST) + _MARGIN, 2))


def _reach(shape: Any) -> float:
    """How far a shape of a link reaches along x or y of its base, m; a mesh is not looked into."""
    (solid,) = shape.find("geometry")
    match solid.tag:
        case "box":
            half = np.array(_numbers(solid.get("size"))) / 2.0
        case "cylinder":
            radius = float(solid.get("radius"))
            half = np.array([radius, radius, float(solid.get("length")) / 2.0])
        case "sphere":
            half = np.full(3, float(solid.get("radius")))
        case "capsule":
            radius = float(solid.get("radius"))
            half = np.array([radius, radius, float(solid.get("length")) / 2.0 + radius])
        case _:
            return WIDEST
    origin = shape.find("origin")
    place, turned = np.zeros(3), np.eye(3)
    if origin is not None:
        place = np.array(_numbers(origin.get("xyz", "0 0 0")))
        roll, pitch, yaw = _numbers(origin.get("rpy", "0 0 0"))
        turned = rotation_xyz(roll, pitch, yaw)
    corners = np.array(list(itertools.product((-1.0, 1.0), repeat=3))) * half
    return float(np.abs(corners @ turned.T + place)[:, :2].max())


def _numbers(text: str) -> tuple[float, float, float]:
    x, y, z = map(float, text.split())
    return x, y, z
