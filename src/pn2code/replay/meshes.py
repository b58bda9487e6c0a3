"""Shapes of robots and scene as compact triangles.

    store = Meshes()
    store.file(Path("link_1.obj"))     # the number of a mesh in `store.described()`
    store.box((0.1, 0.1, 0.05))

A mesh is points and triangles. Points are whole numbers between the corners of the mesh's box (16 bits each, less than
0.05 mm for an arm), triangles the numbers of their points; normals are computed where they are drawn.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.replay.arrays import Numbers, packed
from pn2code.robot.models.shapes import Mesh, block, rod

_STEPS = 65535
_STL_HEAD, _STL_ROW = 84, 50
MOST_TRIANGLES = 150_000
"""Of one mesh; what has more is shown as the box around it."""


class NoMesh(ValueError):  # noqa: N818
    """A file is not a mesh that can be read; the message says why."""


class Meshes:
    """Meshes by number, each once."""

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []
        self.simplified: list[str] = []
        """files that are shown as the boxes around them, with the reason"""
        self._known: dict[Any, int] = {}

    def file(self, path: Path) -> int:
        """An OBJ or STL file; one that cannot be read is nothing to see."""
        return self._once(("file", path), lambda: self._read(path))

    def box(self, size: tuple[float, float, float]) -> int:
        """A box around the origin."""
        x, y, z = (v / 2 for v in size)
        edge = min(0.004, *(v / 4 for v in (x, y, z)))
        return self._once(
            ("box", size), lambda: _of(block((-x, -y, -z), (x, y, z), edge, edge / 2))
        )

    def cylinder(self, radius: float, length: float) -> int:
        """A cylinder along z around the origin."""
        key = ("cylinder", radius, length)
        return self._once(key, lambda: _of(rod("z", -length / 2, length / 2, radius)))

    def sphere(self, radius: float) -> int:
        """A ball around the origin."""
        return self._once(("sphere", radius), lambda: _ball(radius))

    def mesh(self, mesh: Mesh) -> int:
        """Triangles that are there already."""
        return self._add(*_of(mesh))

    def _read(self, path: Path) -> tuple[Numbers, Numbers]:
        try:
            points, triangles = _stl(path) if path.suffix.lower() == ".stl" else _obj(path)
        except (OSError, NoMesh) as problem:
            self.simplified.append(f"{path.name} is not shown: {problem}")
            return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
        if len(triangles) > MOST_TRIANGLES:
            why = f"{len(triangles):,} triangles, at most {MOST_TRIANGLES:,} are shown"
            self.simplified.append(f"{path.name} is shown as a box: {why}")
            low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
            return _of(block(low, high, 0.001, 0.0005))
        return points, triangles

    def _once(self, key: Any, make: Callable[[], tuple[Numbers, Numbers]]) -> int:
        if key not in self._known:
            self._known[key] = self._add(*make())
        return self._known[key]

    def _add(self, points: Numbers, triangles: Numbers) -> int:
        low = points.min(axis=0) if len(points) else np.zeros(3)
        size = points.max(axis=0) - low if len(points) else np.zeros(3)
        whole = np.round((points - low) / np.where(size > 0, size, 1.0) * _STEPS)
        self.rows.append(
            {
                "low": [round(float(v), 6) for v in low],
                "size": [round(float(v), 6) for v in size],
                "points": packed(whole.astype(np.int64).T.reshape(-1)),
                "triangles": packed(triangles.reshape(-1)),
            }
        )
        return len(self.rows) - 1


def _of(mesh: Mesh) -> tuple[Numbers, Numbers]:
    """Points and triangles of a mesh whose triangles have corners of their own."""
    if not mesh.triangles:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    return _merged(np.array(mesh.triangles).reshape(-1, 3))


def _merged(corners: Numbers) -> tuple[Numbers, Numbers]:
    """Corners of triangles, three after each other, with those at the same place made one; flat triangles go."""
    rows, which = np.unique(np.round(corners * 1e5).astype(np.int64), axis=0, return_inverse=True)
    triangles = which.reshape(-1, 3)
    a, b, c = triangles.T
    return rows / 1e5, triangles[(a != b) & (b != c) & (c != a)]


def _ball(radius: float, rings: int = 12) -> tuple[Numbers, Numbers]:
    points, triangles = [], []
    for i in range(rings + 1):
        for k in range(2 * rings):
            a, b = np.pi * i / rings, np.pi * k / rings
            points.append((np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)))
    for i in range(rings):
        for k in range(2 * rings):
            p, q = i * 2 * rings + k, i * 2 * rings + (k + 1) % (2 * rings)
            triangles += [(p, p + 2 * rings, q), (q, p + 2 * rings, q + 2 * rings)]
    corners = np.array(points)[np.array(triangles).reshape(-1)] * radius
    return _merged(corners)


def _obj(path: Path) -> tuple[Numbers, Numbers]:
    """Points and faces of a Wavefront file; all else (normals, textures, materials) is passed over."""
    points: list[list[float]] = []
    triangles: list[tuple[int, int, int]] = []
    with path.open(encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            words = line.split()
            try:
                if words[:1] == ["v"]:
                    points.append([float(w) for w in words[1:4]])
                elif words[:1] == ["f"]:
                    at = [int(w.split("/")[0]) for w in words[1:]]
                    at = [i - 1 if i > 0 else len(points) + i for i in at]
                    triangles += [(at[0], b, c) for b, c in zip(at[1:], at[2:], strict=False)]
            except (ValueError, IndexError):
                raise NoMesh(f"line {number} is not of the OBJ format") from None
    found = np.array(triangles, np.int64).reshape(-1, 3)
    if any(len(p) != 3 for p in points) or (
        found.size and not 0 <= int(found.min()) <= int(found.max()) < len(points)
    ):
        raise NoMesh("its points or faces are incomplete")
    return np.array(points, float).reshape(-1, 3), found


def _stl(path: Path) -> tuple[Numbers, Numbers]:
    """Triangles of an STL file, binary or text."""
    data = path.read_bytes()
    if len(data) >= _STL_HEAD:
        count = struct.unpack_from("<I", data, 80)[0]
        if len(data) == _STL_HEAD + count * _STL_ROW:
            row = np.dtype([("normal", "<f4", 3), ("corners", "<f4", 9), ("more", "<u2")])
            rows = np.frombuffer(data, row, count, _STL_HEAD)
            return _merged(rows["corners"].reshape(-1, 3).astype(float))
    words = data.decode("utf-8", "replace").split()
    at = [i for i, w in enumerate(words) if w.lower() == "vertex"]
    try:
        corners = np.array([[float(w) for w in words[i + 1 : i + 4]] for i in at], float)
    except ValueError:
        raise NoMesh("it is not of the STL format") from None
    if not at or len(at) % 3 or corners.shape != (len(at), 3):
        raise NoMesh("it is not of the STL format")
    return _merged(corners)
