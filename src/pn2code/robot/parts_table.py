"""`[parts]` and `[places]` of cell.toml: what is carried, where it is at the start, and poses with a name.

[parts.blank]
kind = "box"
size = [0.10, 0.10, 0.05]
at = [{ x = 1.2, y = 0.0, z = 0.525 }]        # one part for each pose
grips = [{ z = 0.025, roll = 180.0 }]         # where the TCP is in the part's frame when it is gripped
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.cell_file.poses import POSE
from pn2code.cell_file.things import PART
from pn2code.robot import codes
from pn2code.robot.commands import Pose
from pn2code.robot.hulls import Hull
from pn2code.robot.scene_objects import SceneObject, read_shape
from pn2code.robot.solid_objects import expect_body
from pn2code.robot.table import Table
from pn2code.robot.table_poses import NO_POSE, read_own_pose


@frozen
class PartKind:
    """A kind of part.

    Args:
        shape: its geometry, in its own frame.
        at: where the parts are that are there at the start.
        grips: where the TCP may be when it is gripped, in the frame of the part; empty: at its origin, however turned.
        mass: kg; 0: it is not said.
        tolerance: how far the TCP may be from there, m; angle: and how far it may be turned, rad.
        way: m, so far before the end of a line that leads to it, and behind the beginning of one that comes from it, a
            tool may touch it, and it what it is put on.
    """

    name: str
    shape: SceneObject
    at: tuple[Pose, ...] = ()
    grips: tuple[Pose, ...] = ()
    tolerance: float = 0.005
    angle: float = math.radians(5.0)
    mass: float = 0.0
    way: float = math.inf


def read_kinds(t: Table, folder: Path) -> dict[str, PartKind]:
    """The kinds of parts, by name; what is wrong is reported."""
    out = {}
    for name, table in t.named(PART):
        _check_name(t, name)
        shape = read_shape(table, name, NO_POSE, folder)
        at = tuple(map(read_own_pose, table.tables("at")))
        grips = tuple(map(read_own_pose, table.tables("grips")))
        tolerance = table.number("grip_tolerance")
        angle = math.radians(table.number("grip_angle_deg"))
        mass = table.number("mass")
        if shape is not None:
            expect_body(table, shape)  # else nobody could say what it stands on, or is in a zone
            way = table.number("contact_way") if table.has("contact_way") else longest(shape)
            table.done()
            out[name] = PartKind(name, shape, at, grips, tolerance, angle, mass, way)
    return out


def longest(shape: SceneObject) -> float:
    """m: from corner to corner of the box around a shape. No straight line is in it for longer."""
    corners = [hull.corners for hull in Hull.of(shape)]
    return float(np.linalg.norm(np.ptp(np.concatenate(corners), axis=0))) if corners else math.inf


def read_places(t: Table) -> dict[str, Pose]:
    """The poses that have a name, in the world."""
    out = {}
    for name, table in t.named(POSE):
        _check_name(t, name)
        out[name] = read_own_pose(table)
    return out


def _check_name(t: Table, name: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        t.d.error(
            codes.ROBOT_VALUE,
            f"`{name}` is not a name for {t.path[0]}",
            t.at(name),
            hint="a letter, then letters, digits and `_`",
        )
