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
        mesh: path of an OBJ or STL file; collisions are checked against its convex hull,
            or against `hulls` convex pieces that cover it, at most.
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
    hulls: int = 1


def read_colour(t: Table) -> Colour:
    """Red, green, blue, and how opaque."""
    r, g, b, *opaque = t.numbers("colour")
    return (r, g, b, opaque[0] if opaque else 1.0)


def read_object(t: Table, folder: Path) -> SceneObject | None:
    """An entry of `[scene] objects`; None if its kind is unknown, which is reported."""
    name = t.text("name")
    out = read_shape(t, name, read_pose(t, "pose"), folder)
    if out is not None:
        t.done()
    return out


def read_shape(t: Table, name: str, pose: Pose, folder: Path) -> SceneObject | None:
    """What a table says of shape and colour; None if its kind is unknown, which is reported."""
    kind = t.text("kind")
    if kind != t.data.get("kind", kind):
        return None  # what else there may be is not known
    colour = read_colour(t)
    if kind == "box":
        x, y, z = t.numbers("size")
        return SceneObject(name, "box", pose, colour, size=(x, y, z))
    if kind == "cylinder":
        radius, length = t.number("radius"), t.number("length")
        return SceneObject(name, "cylinder", pose, colour, radius=radius, length=length)
    file = folder / t.text("file")
    if "file" in t.data and not (file.is_file() and file.suffix.lower() in (".obj", ".stl")):
        t.wrong("file", "the path of an OBJ or STL file that exists")
    scale, hulls = t.number("scale"), t.whole("hulls")
    return SceneObject(name, "mesh", pose, colour, mesh=file, scale=scale, hulls=hulls)
