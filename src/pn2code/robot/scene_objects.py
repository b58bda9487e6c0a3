"""Things in the cell that are no robots: boxes, cylinders, meshes."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pn2code.base.frozen import frozen
from pn2code.robot.commands import Pose
from pn2code.robot.table import Table
from pn2code.robot.table_poses import read_pose

Colour = tuple[float, float, float, float]


@frozen
class SceneObject:
    """A further thing in the cell: a box, a cylinder along its z, or a mesh.

    Args:
        size: of a box: full lengths.
        radius: of a cylinder; length likewise.
        mesh: path of an OBJ or STL file; collisions are checked against its convex hull.
        scale: of a mesh.
    """

    name: str
    kind: Literal["box", "cylinder", "mesh"]
    pose: Pose
    colour: Colour = (0.6, 0.6, 0.62, 1.0)
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    length: float = 0.0
    mesh: Path | None = None
    scale: float = 1.0


def read_colour(t: Table) -> Colour:
    """Red, green, blue, and how opaque."""
    grey = (0.6, 0.6, 0.62)
    found = t.numbers("colour", None, grey)
    if len(found) not in (3, 4) or not all(0.0 <= v <= 1.0 for v in found):
        t.wrong("colour", "a list of three or four numbers from 0 to 1")
        found = grey
    r, g, b = found[:3]
    return (r, g, b, found[3] if len(found) == 4 else 1.0)


def read_object(t: Table, folder: Path) -> SceneObject | None:
    """An entry of `[scene] objects`; None if its kind is unknown, which is reported."""
    name = t.text("name")
    out = read_shape(t, name, read_pose(t, "pose"), folder)
    if out is not None:
        t.done()
    return out


def read_shape(t: Table, name: str, pose: Pose, folder: Path) -> SceneObject | None:
    """What a table says of shape and colour; None if its kind is unknown, which is reported."""
    kind = t.text("kind", "box", "`box`, `cylinder` or `mesh`")
    colour = read_colour(t)
    out: SceneObject | None = None
    if kind == "box":
        t.has("size", True, "three numbers: full lengths, m")
        x, y, z = t.numbers("size", 3, (1.0, 1.0, 1.0))
        if min(x, y, z) <= 0.0:
            t.wrong("size", "three numbers above 0")
        out = SceneObject(name, "box", pose, colour, size=(x, y, z))
    elif kind == "cylinder":
        radius, length = t.positive("radius"), t.positive("length")
        out = SceneObject(name, "cylinder", pose, colour, radius=radius, length=length)
    elif kind == "mesh":
        file = folder / t.text("file", None, "an OBJ or STL file, relative to cell.toml")
        if "file" in t.data and not (file.is_file() and file.suffix.lower() in (".obj", ".stl")):
            t.wrong("file", "the path of an OBJ or STL file that exists")
        scale = t.positive("scale", 1.0)
        out = SceneObject(name, "mesh", pose, colour, mesh=file, scale=scale)
    else:
        t.wrong("kind", "`box`, `cylinder` or `mesh`")
    return out
