"""Where things can be: upright prisms around all of their places, to tell what has nothing to do with each other.

    prism = Prism.around(corners)               # of a part that stands
    plate = swept(plate, riders, (0.0, 0.7))    # all that a turntable, belt or lift takes along, and itself
    prism.is_near(plate)                        # so near that one could come to stand on the other

A prism is a convex polygon, with a rim around it, between two heights. What is in two prisms that are further apart
than what a part may stand above, neither touches nor carries the other.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot.ground import REST_GAP, Plate
from pn2code.robot.hulls import around, inside, overlap
from pn2code.robot.transforms import Array

_NEAR = REST_GAP + 0.001
"""m: what is further away is neither below a part nor beside it, whatever is rounded."""


@frozen(eq=False)
class Prism:
    """Where something can be.

    Args:
        flat: the polygon, seen from above, (n, 2); rim: m around it.
        low, high: m, between which heights.
    """

    flat: Array
    rim: float
    low: float
    high: float

    @staticmethod
    def around(corners: Array, rim: float = 0.0) -> Prism:
        """Of what has these corners (n, 3)."""
        z = corners[:, 2]
        return Prism(around(corners[:, :2]), rim, float(z.min()) - rim, float(z.max()) + rim)

    def is_near(self, other: Prism) -> bool:
        """Whether what is in one could touch, or stand on, what is in the other."""
        if max(self.low - other.high, other.low - self.high) > _NEAR:
            return False
        return _apart(self.flat, other.flat) <= self.rim + other.rim + _NEAR


def swept(plate: Plate, riders: Sequence[Array], way: tuple[float, float]) -> list[Prism]:
    """All that a plate takes along from one position of its axis to another, and the plate itself if it moves.

    Args:
        riders: the corners of what stands on it, in its frame; way: m or rad.
    """
    axis, frame = plate.axis, plate.T_world_axis
    own = [np.vstack([h.corners for h in plate.hulls])] if plate.hulls else []
    if axis.is_track:
        along = np.asarray(axis.direction, float)
        ends = (min(way), max(way))
        return [
            Prism.around(_placed(frame, np.vstack([corners + s * along for s in ends])))
            for corners in (*own, *riders)
        ]
    return [_turned(plate, corners) for corners in (*own, *riders)]


def whole(plate: Plate) -> tuple[float, float]:
    """From where to where a plate can move."""
    axis = plate.axis
    return (0.0, axis.upper) if axis.belt is not None else (axis.lower, axis.upper)


def surface(plate: Plate) -> list[Prism]:
    """What a belt has on top, which stands whether it runs or not; of other plates nothing."""
    belt = plate.axis.belt
    if belt is None:
        return []
    half = belt.width / 2.0
    corners = [(x, y, 0.0) for x in (0.0, plate.axis.upper) for y in (-half, half)]
    return [Prism.around(_placed(plate.T_world_axis, np.array(corners)))]


@frozen(eq=False)
class PartEvent:
    """Something that a program does to parts, which can depend on where the plates of others are then.

    Args:
        prisms: where; surfaces: of plates, on which only what others take along counts.
        says: what it does, as the beginning of a clause; goes: "on" or "from" a plate.
        plates: on which that surely is: while one of these moves it cannot be done.
        point: m.
    """

    prisms: tuple[Prism, ...]
    says: str
    point: tuple[float, float, float]
    plates: frozenset[str] = frozenset()
    goes: str = "on"
    surfaces: tuple[Prism, ...] = ()


def near(some: Iterable[Prism], others: Sequence[Prism]) -> bool:
    """Whether any of some is near any of others."""
    return any(a.is_near(b) for a in some for b in others)


def _turned(plate: Plate, corners: Array) -> Prism:
    """About its axis, however far."""
    frame, line = plate.T_world_axis, np.asarray(plate.axis.direction, float)
    if not plate.upright:
        far = float(np.linalg.norm(corners, axis=1).max())
        return Prism(frame[None, :2, 3], far, float(frame[2, 3]) - far, float(frame[2, 3]) + far)
    along = corners @ line
    far = float(np.linalg.norm(corners - along[:, None] * line, axis=1).max())
    z = _placed(frame, np.array([along.min() * line, along.max() * line]))[:, 2]
    return Prism(frame[None, :2, 3], far, float(z.min()), float(z.max()))


def _placed(frame: Array, corners: Array) -> Array:
    return np.asarray(corners @ frame[:3, :3].T + frame[:3, 3])


def _apart(a: Array, b: Array) -> float:
    """How far two convex polygons are apart; 0: they have something in common."""
    if len(a) > 2 and len(b) > 2 and len(overlap(a, b)):
        return 0.0
    if (len(a) > 2 and inside(a, b[0]) >= 0.0) or (len(b) > 2 and inside(b, a[0]) >= 0.0):
        return 0.0
    return 0.0 if _cross(a, b) else min(_from_edges(a, b), _from_edges(b, a))


def _cross(a: Array, b: Array) -> bool:
    """Whether edges of two polygons cross."""

    def turn(p: Array, q: Array, r: Array) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    for p, q in _edges(a):
        for r, s in _edges(b):
            if turn(p, q, r) * turn(p, q, s) < 0.0 and turn(r, s, p) * turn(r, s, q) < 0.0:
                return True
    return False


def _edges(polygon: Array) -> list[tuple[Array, Array]]:
    return list(zip(polygon, np.roll(polygon, -1, axis=0), strict=True))


def _from_edges(points: Array, polygon: Array) -> float:
    """The least distance of some places from the edges of a polygon."""
    least = math.inf
    for p, q in _edges(polygon):
        way = q - p
        length = float(way @ way)
        t = (
            np.clip((points - p) @ way / length, 0.0, 1.0)
            if length > 0.0
            else np.zeros(len(points))
        )
        off = points - (p + t[:, None] * way)
        least = min(least, float(np.linalg.norm(off, axis=1).min()))
    return least
