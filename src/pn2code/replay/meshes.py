"""Shapes of robots and scene as triangles, each once.

    store = Meshes(gltf)
    store.file(Path("link_1.obj"))     # the number of a geometry in the glTF; -1: there is nothing to see
    store.box((0.1, 0.1, 0.05))

A shape is points and triangles; normals are computed where it is drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.replay.arrays import Numbers
from pn2code.replay.gltf import Gltf
from pn2code.robot.mesh_files import NoMesh, merged, read
from pn2code.robot.models.shapes import Mesh, block, rod

MOST_TRIANGLES = 150_000
"""Of one mesh; what has more is shown as the box around it."""


class Meshes:
    """Geometries of a glTF by number, each once."""

    def __init__(self, gltf: Gltf) -> None:
        self.gltf = gltf
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

    def capsule(self, radius: float, length: float) -> int:
        """A capsule along z around the origin; `length` is that without its round ends."""
        return self._once(("capsule", radius, length), lambda: _ball(radius, apart=length))

    def mesh(self, mesh: Mesh) -> int:
        """Triangles that are there already."""
        return self._add(*_of(mesh))

    def _read(self, path: Path) -> tuple[Numbers, Numbers]:
        try:
            points, triangles = read(path)
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
        return self.gltf.geometry(points, triangles) if len(triangles) else -1


def _of(mesh: Mesh) -> tuple[Numbers, Numbers]:
    """Points and triangles of a mesh whose triangles have corners of their own."""
    if not mesh.triangles:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    return merged(np.array(mesh.triangles).reshape(-1, 3))


def _ball(radius: float, rings: int = 12, apart: float = 0.0) -> tuple[Numbers, Numbers]:
    """Its two halves may be apart, with a mantle between them."""
    angles = [np.pi * i / rings for i in range(rings + 1)]
    shifts = [0.0] * len(angles)
    if apart:
        half = rings // 2 + 1
        angles[half:half] = [np.pi / 2.0]
        shifts = [apart / 2.0] * half + [-apart / 2.0] * half
    points, triangles = [], []
    for a, shift in zip(angles, shifts, strict=True):
        for k in range(2 * rings):
            b = np.pi * k / rings
            x, y, z = np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)
            points.append((radius * x, radius * y, radius * z + shift))
    for i in range(len(angles) - 1):
        for k in range(2 * rings):
            p, q = i * 2 * rings + k, i * 2 * rings + (k + 1) % (2 * rings)
            triangles += [(p, p + 2 * rings, q), (q, p + 2 * rings, q + 2 * rings)]
    return merged(np.array(points)[np.array(triangles).reshape(-1)])
