"""Poses in tables of cell.toml: written in m and degrees, read in SI units."""

from __future__ import annotations

import math

from pn2code.robot.commands import Pose
from pn2code.robot.table import Table

NO_POSE = Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def read_pose(t: Table, key: str) -> Pose:
    """A pose (m, rad) that is written in m and degrees; at the origin where there is none."""
    if not t.has(key):
        return NO_POSE
    return read_own_pose(t.table(key))


def read_own_pose(p: Table) -> Pose:
    """The pose that a table is."""
    x, y, z = (p.number(k) for k in ("x", "y", "z"))
    rx, ry, rz = (math.radians(p.number(k)) for k in ("roll", "pitch", "yaw"))
    p.done()
    return Pose(x, y, z, rx, ry, rz)
