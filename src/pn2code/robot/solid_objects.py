"""Objects on which parts can stand: what a mesh file holds must be a body that can be read.

objects = read_solids(t.tables("objects"), folder)

Otherwise nobody could say what stands on it, and a part on it would be said to be in the air.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pn2code.robot.collision_meshes import trouble
from pn2code.robot.convex_pieces import NoPieces, pieces
from pn2code.robot.hulls import Hull
from pn2code.robot.scene_objects import SceneObject, read_object
from pn2code.robot.table import Table


def read_solids(
    tables: Iterable[Table], folder: Path, *, solid: bool = True
) -> tuple[SceneObject, ...]:
    """The objects of tables; what is wrong is reported.

    Args:
        solid: whether they must be bodies; of a cell without parts nothing stands on them.
    """
    out = []
    for table in tables:
        thing = read_object(table, folder)
        if thing is None:
            continue
        out.append(thing)
        if solid:
            expect_body(table, thing)
        elif thing.mesh is not None and thing.mesh.is_file() and trouble(thing.mesh):
            table.wrong("file", "an OBJ or STL file that can be read")
        else:
            _expect_pieces(table, thing)
    return tuple(out)


def expect_body(table: Table, thing: SceneObject) -> None:
    """Reports a mesh file, if it is there, of which no body can be read."""
    if thing.mesh is None or not thing.mesh.is_file():
        return
    if not Hull.around(thing.mesh, 1.0):
        table.wrong("file", "an OBJ or STL file that can be read, of a body that is not flat")
    else:
        _expect_pieces(table, thing)


def _expect_pieces(table: Table, thing: SceneObject) -> None:
    """Reports a mesh that cannot be divided into convex pieces that cover it."""
    if thing.mesh is None or not thing.mesh.is_file() or thing.hulls == 1:
        return
    try:
        pieces(thing.mesh, thing.hulls)
    except NoPieces as problem:
        table.wrong(
            "hulls",
            "a mesh that can be divided into convex pieces",
            f"of `{thing.mesh.name}`: {problem}",
        )
