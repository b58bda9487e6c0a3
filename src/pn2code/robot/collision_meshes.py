"""Meshes as collision shapes: that they can be read, and files of them that PyBullet reads as they are.

trouble(path)                       # why it would touch nothing; "": it is a mesh
for_bullet(path, 1, folder)         # the file itself, or one in the folder; 8: one for each of its convex pieces

PyBullet reads of STL only the binary kind, and of OBJ only points that faces name; of other files it makes no shape, or
a smaller one, and says nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path

from pn2code.robot.convex_pieces import NoPieces, pieces
from pn2code.robot.mesh_files import NoMesh, is_binary_stl, read
from pn2code.robot.transforms import Array
from pn2code.robot.urdf import Urdf, hulls_of, mesh_file


@lru_cache(maxsize=256)
def trouble(path: Path, most: int = 1) -> str:
    """Why a file is no mesh, or not of at most so many convex pieces; "": it is one."""
    if path.suffix.lower() not in (".obj", ".stl"):
        return "it is no OBJ or STL file"
    try:
        _, triangles = read(path)
    except (OSError, NoMesh) as problem:
        return str(getattr(problem, "strerror", None) or problem)
    if not len(triangles):
        return "it has no triangles"
    try:
        if most > 1:
            pieces(path, most)
    except NoPieces as problem:
        return f"it cannot be divided into convex pieces (`hulls`): {problem}"
    return ""


def unread_meshes(trees: Iterable[Urdf]) -> Iterator[tuple[Path, str]]:
    """The collision meshes of arms and tools that cannot be read: in which URDF file, and what is wrong."""
    for path, tree in {tree.path: tree for tree in trees}.items():
        for link in tree.xml.findall("link"):
            for collision in link.findall("collision"):
                for mesh in collision.iter("mesh"):
                    why = trouble(mesh_file(mesh, path.parent), hulls_of(mesh))
                    if why:
                        what = f"the collision mesh `{mesh.get('filename')}` of link `{link.get('name')}`"
                        yield path, f"{what} cannot be read, so that it would touch nothing: {why}"


def for_bullet(path: Path, most: int, folder: Path) -> tuple[Path, ...]:
    """The files of which PyBullet makes the convex pieces of a mesh."""
    if most == 1:
        return (_whole(path, folder),)
    return tuple(_hull(points, folder) for points in pieces(path, most))


def _hull(points: Array, folder: Path) -> Path:
    from scipy.spatial import ConvexHull  # takes a while

    return _written(points, ConvexHull(points).simplices.tolist(), folder)


def _whole(path: Path, folder: Path) -> Path:
    """A file of which PyBullet makes the convex hull of all points."""
    try:
        if path.suffix.lower() == ".stl" and is_binary_stl(path):
            return path
        points, triangles = read(path)
    except (OSError, NoMesh):
        return path
    loose = sorted({*range(len(points))} - set(triangles.ravel().tolist()))
    if path.suffix.lower() == ".obj" and not loose:
        return path
    return _written(points, [*triangles.tolist(), *([i, i, i] for i in loose)], folder)


def _written(points: Array, triangles: Iterable[Iterable[int]], folder: Path) -> Path:
    """An OBJ file with all these points."""
    lines = [f"v {' '.join(map(repr, point))}" for point in points.tolist()]
    lines += [f"f {' '.join(str(i + 1) for i in three)}" for three in triangles]
    made = folder / f"mesh_{len([*folder.iterdir()])}.obj"
    made.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return made
