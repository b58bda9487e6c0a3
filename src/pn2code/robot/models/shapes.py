"""Small solids as triangle meshes, written as OBJ: turned parts, bevelled slabs, lofts.

Everything is built from rings of points that are skinned one to the next. Normals are smooth along
a ring and sharp across edges of more than 35 degrees, so castings look cast and plates look cut.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pn2code.base.frozen import record

Array = NDArray[np.float64]
# Points around a circle, by its radius in m: fine where it shows, coarse on screws.
_FINENESS = ((0.02, 10), (0.05, 18), (0.11, 26), (math.inf, 36))
_SHARP = math.cos(math.radians(35.0))


@record
class Mesh:
    """Triangles, each with its three corner points."""

    triangles: list[Array] = field(default_factory=list)

    def __add__(self, other: Mesh) -> Mesh:
        """Both meshes together."""
        return Mesh(self.triangles + other.triangles)

    def moved(self, offset: ArrayLike, rotation: ArrayLike | None = None) -> Mesh:
        """Turned (a 3x3 matrix), then shifted."""
        r = np.eye(3) if rotation is None else np.asarray(rotation, float)
        return Mesh([t @ r.T + np.asarray(offset, float) for t in self.triangles])

    def obj(self) -> str:
        """The mesh in OBJ format, with normals."""
        corners = np.array(self.triangles)
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(flat, axis=1)
        keep = area > 1e-12
        corners, flat, unit = corners[keep], flat[keep], flat[keep] / area[keep, None]
        points, at = _unique(corners.reshape(-1, 3), 5)
        normals, toward = _unique(_smooth(at, flat, unit), 3)
        lines = [f"v {_numbers(p, 5)}" for p in points.tolist()]
        lines += [f"vn {_numbers(n, 3)}" for n in normals.tolist()]
        pairs = [f"{p}//{n}" for p, n in zip((at + 1).tolist(), (toward + 1).tolist(), strict=True)]
        lines += [
            f"f {a} {b} {c}" for a, b, c in zip(pairs[::3], pairs[1::3], pairs[2::3], strict=True)
        ]
        return "\n".join(lines) + "\n"


def _unique(values: Array, digits: int) -> tuple[Array, NDArray[np.int64]]:
    """The different rows after rounding, and for each row which one it is."""
    whole = np.round(values * 10**digits).astype(np.int64)
    rows, which = np.unique(whole, axis=0, return_inverse=True)
    return rows / 10.0**digits, which.reshape(-1)


def _smooth(at: NDArray[np.int64], flat: Array, unit: Array) -> Array:
    """A normal for each corner: over the faces at the same point that are not across a sharp edge."""
    face = np.repeat(np.arange(len(flat)), 3)
    order = np.argsort(at, kind="stable")
    start = np.searchsorted(at[order], np.arange(at.max() + 1))
    size = np.diff(np.append(start, len(at)))
    # All pairs (corner, corner at the same point).
    mine = np.repeat(np.arange(len(at)), size[at])
    first = np.cumsum(size[at]) - size[at]
    theirs = order[start[at[mine]] + np.arange(len(mine)) - first[mine]]
    near = (unit[face[mine]] * unit[face[theirs]]).sum(1) > _SHARP
    out = np.zeros((len(at), 3))
    np.add.at(out, mine[near], flat[face[theirs[near]]])
    return np.asarray(out / np.linalg.norm(out, axis=1, keepdims=True))


def _numbers(values: Sequence[float], digits: int) -> str:
    texts = (f"{v:.{digits}f}".rstrip("0").rstrip(".") for v in values)
    return " ".join("0" if t in ("-0", "") else t for t in texts)


def skin(rings: Sequence[Array], *, caps: bool = True) -> Mesh:
    """The surface through rings of equally many points, counter-clockwise seen from the last ring."""
    out: list[Array] = []
    n = len(rings[0])
    for a, b in zip(rings, rings[1:], strict=False):
        for i in range(n):
            j = (i + 1) % n
            out.append(np.array([a[i], a[j], b[j]]))
            out.append(np.array([a[i], b[j], b[i]]))
    if caps:
        for ring, forward in ((rings[0], False), (rings[-1], True)):
            centre = ring.mean(axis=0)
            for i in range(n):
                j = (i + 1) % n
                out.append(
                    np.array([centre, ring[i], ring[j]] if forward else [centre, ring[j], ring[i]])
                )
    return Mesh(out)


def _around(radius: float) -> int:
    return next(count for limit, count in _FINENESS if radius <= limit)


def _circle(radius: float, count: int) -> Array:
    a = np.arange(count) * (2.0 * math.pi / count)
    return np.stack([np.cos(a), np.sin(a)], axis=1) * radius


_AXES = {
    "x": np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    "y": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    "z": np.eye(3),
}


def lathe(axis: str, profile: Iterable[tuple[float, float]], at: ArrayLike = (0, 0, 0)) -> Mesh:
    """A turned part: (position along the axis, radius) pairs, positions rising."""
    steps = list(profile)
    n = _around(max(r for _, r in steps))
    rings = [np.column_stack([_circle(max(r, 1e-4), n), np.full(n, s)]) for s, r in steps]
    return skin(rings).moved(at, _AXES[axis])


def rod(
    axis: str,
    start: float,
    end: float,
    radius: float,
    at: ArrayLike = (0, 0, 0),
    bevel: float = 0.008,
) -> Mesh:
    """A cylinder with bevelled edges from `start` to `end` along an axis."""
    b = min(bevel, radius / 3.0, (end - start) / 3.0)
    profile = [(start, radius - b), (start + b, radius), (end - b, radius), (end, radius - b)]
    return lathe(axis, profile, at)


def hull_outline(circles: Sequence[tuple[float, float, float]], shrink: float = 0.0) -> Array:
    """Outline of the convex hull of circles (x, y, radius), as support points."""
    n = 4 * max(3, _around(max(r for _, _, r in circles)) // 2)
    a = (np.arange(n) + 0.5) * (2.0 * math.pi / n)
    direction = np.stack([np.cos(a), np.sin(a)], axis=1)
    centres = np.array([[x, y] for x, y, _ in circles])
    radii = np.array([max(r - shrink, 1e-3) for _, _, r in circles])
    best = np.argmax(direction @ centres.T + radii, axis=1)
    return np.asarray(centres[best] + direction * radii[best][:, None])


def slab(
    plane: str,
    circles: Sequence[tuple[float, float, float]],
    start: float,
    end: float,
    bevel: float = 0.02,
) -> Mesh:
    """A plate: the hull of circles in a plane ("xz", "xy" or "yz"), thick from start to end."""
    outer, inner = hull_outline(circles), hull_outline(circles, bevel)
    levels = ((start, inner), (start + bevel, outer), (end - bevel, outer), (end, inner))
    rings = [np.column_stack([outline, np.full(len(outline), s)]) for s, outline in levels]
    turn = {
        "xy": np.eye(3),
        "yz": np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        # x, z, y is left-handed: the outline's second axis is -z there, so it is mirrored first.
        "xz": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    }[plane]
    if plane == "xz":
        rings = [r * np.array([1.0, -1.0, 1.0]) for r in rings]
        rings = [r[::-1] for r in rings]
    return skin(rings).moved((0, 0, 0), turn)


def block(low: ArrayLike, high: ArrayLike, radius: float = 0.03, bevel: float = 0.01) -> Mesh:
    """A box with rounded upright edges and bevelled top and bottom."""
    (x0, y0, z0), (x1, y1, z1) = np.asarray(low, float), np.asarray(high, float)
    r = min(radius, (x1 - x0) / 2.01, (y1 - y0) / 2.01)
    corners = [(x, y, r) for x in (x0 + r, x1 - r) for y in (y0 + r, y1 - r)]
    return slab("xy", corners, float(z0), float(z1), min(bevel, r, (z1 - z0) / 3.0))


def loft(levels: Sequence[tuple[float, Sequence[tuple[float, float, float]]]]) -> Mesh:
    """Upright body through hull outlines of circles at rising heights."""
    rings = []
    for z, circles in levels:
        outline = hull_outline(circles)
        rings.append(np.column_stack([outline, np.full(len(outline), z)]))
    return skin(rings)


def square(half: float, corner: float) -> tuple[tuple[float, float, float], ...]:
    """The circles of a rounded square, for `loft`."""
    c = half - corner
    return tuple((x, y, corner) for x, y in ((-c, -c), (c, -c), (c, c), (-c, c)))


def bolts(
    axis: str,
    at: float,
    circle: float,
    count: int,
    size: float = 0.011,
    centre: ArrayLike = (0, 0, 0),
) -> Mesh:
    """A bolt circle: heads standing out of a face at `at`, along an axis (a negative size: backwards)."""
    out = Mesh()
    for p in _circle(circle, count):
        start, end = sorted((at, at + size))
        head = lathe("z", [(start, abs(size)), (end, abs(size) * 0.9)], (p[0], p[1], 0.0))
        out = out + head.moved(centre, _AXES[axis])
    return out
