"""Convex pieces of things: which face is below, which above, and where two of them lie over one another.

    box = Hull.box((0.2, 0.2, 0.1)).at(T_world_box)
    face(box, up=False, steep=0.7, within=0.005)    # Face: what looks down, as seen from above, and its plane

Polygons are corners against the clock, (n, 2), in m.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.convex_pieces import NoPieces, pieces
from pn2code.robot.mesh_files import NoMesh, read
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.transforms import Array

_SIDES = 96
"""Of what stands for a cylinder."""
_FLAT = 1e-12
_IN_PLANE = 1e-6
_LOOKING = 1e-3


@frozen(eq=False)
class Hull:
    """A convex piece.

    Args:
        corners: (n, 3); normals: of its faces, outwards, (m, 3); middle: its centre of mass.
        volume: of a mesh, to weigh its pieces against each other.
    """

    corners: Array
    normals: Array
    middle: Array
    volume: float = 1.0

    @staticmethod
    def box(size: tuple[float, float, float]) -> Hull:
        """Around the origin; full lengths."""
        half = [(-v / 2.0, v / 2.0) for v in size]
        return Hull(
            np.array(list(itertools.product(*half))),
            np.vstack([np.eye(3), -np.eye(3)]),
            np.zeros(3),
        )

    @staticmethod
    def cylinder(radius: float, length: float) -> Hull:
        """Along z around the origin."""
        angles = np.arange(_SIDES) * (2.0 * math.pi / _SIDES)
        round_ = np.stack([np.cos(angles), np.sin(angles), np.zeros(_SIDES)], axis=1)
        up = np.array([0.0, 0.0, length / 2.0])
        half = math.pi / _SIDES
        turned = np.stack([np.cos(angles + half), np.sin(angles + half), np.zeros(_SIDES)], axis=1)
        return Hull(
            np.vstack([radius * round_ + up, radius * round_ - up]),
            np.vstack([turned, [[0.0, 0.0, 1.0]], [[0.0, 0.0, -1.0]]]),
            np.zeros(3),
        )

    @staticmethod
    def of(o: SceneObject) -> tuple[Hull, ...]:
        """A thing in its own frame, wherever it is; none: its file cannot be read, which is told elsewhere."""
        if o.kind == "box":
            return (Hull.box(o.size),)
        if o.kind == "cylinder":
            return (Hull.cylinder(o.radius, o.length),)
        return () if o.mesh is None else Hull.around(o.mesh, o.scale, o.hulls)

    @staticmethod
    def around(path: Path, scale: float, most: int = 1) -> tuple[Hull, ...]:
        """Around the points of a mesh file, or at most so many that cover it; none: it cannot be read, or is flat."""
        return tuple(
            Hull(scale * h.corners, h.normals, scale * h.middle, h.volume)
            for h in _around(path, most)
        )

    def at(self, frame: Array) -> Hull:
        """The same, placed."""
        turn, shift = frame[:3, :3].T, frame[:3, 3]
        return Hull(
            self.corners @ turn + shift,
            self.normals @ turn,
            self.middle @ turn + shift,
            self.volume,
        )

    @property
    def extent(self) -> tuple[Array, Array]:
        """The corners of the box around it."""
        return self.corners.min(axis=0), self.corners.max(axis=0)

    @property
    def radius(self) -> float:
        """Of a ball around its origin."""
        return float(np.linalg.norm(self.corners, axis=1).max())


def middle_of(hulls: Sequence[Hull]) -> Array:
    """The centre of mass of pieces that are one thing."""
    if len(hulls) == 1:
        return hulls[0].middle
    weights = np.array([h.volume for h in hulls])
    return np.asarray(weights @ np.array([h.middle for h in hulls]) / weights.sum())


@lru_cache(maxsize=32)
def _around(path: Path, most: int) -> tuple[Hull, ...]:
    from scipy.spatial import QhullError

    try:
        found = pieces(path, most) if most > 1 else (read(path)[0],)
        return tuple(map(_around_points, found))
    except (OSError, NoMesh, NoPieces, QhullError, ValueError):
        return ()


def _around_points(points: Array) -> Hull:
    from scipy.spatial import ConvexHull  # takes a while, and few cells have meshes

    hull = ConvexHull(points)
    corners = points[hull.vertices]
    inside = corners.mean(axis=0)
    triangles = points[hull.simplices] - inside
    volumes = np.abs(np.linalg.det(triangles))
    middle = inside + (volumes[:, None] * triangles.sum(axis=1)).sum(axis=0) / (4.0 * volumes.sum())
    normals = np.unique(np.round(hull.equations[:, :3], 9), axis=0)
    return Hull(corners, normals, middle, float(volumes.sum()) / 6.0)


@frozen(eq=False)
class Face:
    """What a piece looks like from above or below.

    Args:
        core: of the face, as seen from above; polygon: of all that is nearly in its plane.
        normals, offsets: the planes of all faces that look that way: normal @ x = offset.
    """

    core: Array
    polygon: Array
    normals: Array
    offsets: Array
    up: bool

    def heights(self, points: Array) -> Array:
        """Of the surface over places (n, 2)."""
        off = self.offsets[:, None] - self.normals[:, :2] @ points.T
        rows = off / self.normals[:, 2, None]
        return np.asarray(rows.min(axis=0) if self.up else rows.max(axis=0))


def face(hull: Hull, *, up: bool, steep: float, within: float) -> Face | None:
    """The face that looks up, or down.

    Args:
        steep: the least z of its normal; None where no face is so flat.
        within: m: what is so near to its plane counts as being in it.
    """
    rising = hull.normals[:, 2] if up else -hull.normals[:, 2]
    best = int(np.argmax(rising))
    if rising[best] < steep:
        return None
    off = hull.corners @ hull.normals.T
    offsets = off.max(axis=0)
    near = offsets[best] - off[:, best]
    looking = rising > _LOOKING
    return Face(
        around(hull.corners[near <= _IN_PLANE][:, :2]),
        around(hull.corners[near <= within][:, :2]),
        hull.normals[looking],
        offsets[looking],
        up,
    )


def around(points: Array) -> Array:
    """The convex polygon around places."""
    rows = sorted(set(map(tuple, np.asarray(points).tolist())))
    if len(rows) < 3:
        return np.array(rows).reshape(-1, 2)

    def half(way: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
        out: list[tuple[float, ...]] = []
        for p in way:
            while len(out) > 1 and _turn(out[-2], out[-1], p) <= _FLAT:
                out.pop()
            out.append(p)
        return out[:-1]

    return np.array(half(rows) + half(rows[::-1])).reshape(-1, 2)


def _turn(a: tuple[float, ...], b: tuple[float, ...], c: tuple[float, ...]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def inwards(polygon: Array, points: Array) -> Array:
    """How far places (n, 2) are inside of each edge of a polygon, (edges, n); negative: outside of it."""
    along = _along(polygon)
    off = points[None] - polygon[:, None]
    return np.asarray(along[:, 0, None] * off[..., 1] - along[:, 1, None] * off[..., 0])


def _along(polygon: Array) -> Array:
    """The directions of the edges of a polygon, (edges, 2)."""
    along = np.concatenate([polygon[1:], polygon[:1]]) - polygon
    return np.asarray(along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300))


def part_below(polygon: Array, values: Array, most: float) -> Array:
    """Of a polygon with a value at each corner, linear in between, the part where it is at most so much."""
    return np.array(_below(polygon.tolist(), values.tolist(), most)).reshape(-1, 2)


def _below(polygon: list[list[float]], values: list[float], most: float) -> list[list[float]]:
    """The same of lists: a few numbers are worked out sooner one by one."""
    out = []
    for i, p in enumerate(polygon):
        j = (i + 1) % len(polygon)
        a, b = values[i] - most, values[j] - most
        if a <= 0.0:
            out.append(p)
        if (a < 0.0 < b) or (b < 0.0 < a):
            part, q = a / (a - b), polygon[j]
            out.append([p[0] + (q[0] - p[0]) * part, p[1] + (q[1] - p[1]) * part])
    return out


def _cut(polygon: Array, edges: Array, by: float) -> list[list[float]]:
    """What of a polygon is inside of all edges of another one, by so much (m)."""
    out: list[list[float]] = polygon.tolist()
    for (x, y), (u, v) in zip(edges.tolist(), _along(edges).tolist(), strict=True):
        if len(out) < 3:
            break
        out = _below(out, [-(u * (q - y) - v * (p - x)) for p, q in out], -by)
    return out


def shrunk(polygon: Array, by: float) -> Array:
    """The polygon without all that is so near to its edges (m)."""
    return np.array(_cut(polygon, polygon, by)).reshape(-1, 2)


def overlap(a: Array, b: Array) -> Array:
    """What two polygons have in common."""
    out = _cut(a, b, 0.0)
    return np.array(out) if len(out) >= 3 else np.zeros((0, 2))


def inside(polygon: Array, point: Array) -> float:
    """How far a place is inside of a polygon, m; negative: outside."""
    if len(polygon) < 3:
        return -math.inf
    return float(inwards(polygon, point[None]).min())
