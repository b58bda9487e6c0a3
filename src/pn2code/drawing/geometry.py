"""Plane geometry of drawings: boxes, and where lines meet the shapes of places and transitions. y grows downwards."""

from __future__ import annotations

import math
from collections.abc import Iterable

from pn2code.base.frozen import frozen

Point = tuple[float, float]


@frozen
class Box:
    """A rectangle with its sides along the axes."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def width(self) -> float:
        """From left to right."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """From top to bottom."""
        return self.bottom - self.top

    def grown(self, by: float) -> Box:
        """The box with a margin around."""
        return Box(self.left - by, self.top - by, self.right + by, self.bottom + by)

    def overlaps(self, other: Box) -> bool:
        """Whether the insides of two boxes have a point in common."""
        return (
            self.left < other.right
            and other.left < self.right
            and self.top < other.bottom
            and other.top < self.bottom
        )

    def contains(self, other: Box) -> bool:
        """Whether another box lies inside."""
        return self.holds((other.left, other.top)) and self.holds((other.right, other.bottom))

    def holds(self, p: Point) -> bool:
        """Whether a point is inside or on the edge."""
        return self.left <= p[0] <= self.right and self.top <= p[1] <= self.bottom


def around(x: float, y: float, width: float, height: float) -> Box:
    """The box with a centre and a size."""
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def union(boxes: Iterable[Box]) -> Box:
    """The smallest box around all; a box of size 0 at the origin around none."""
    found = list(boxes)
    if not found:
        return Box(0.0, 0.0, 0.0, 0.0)
    return Box(
        min(b.left for b in found),
        min(b.top for b in found),
        max(b.right for b in found),
        max(b.bottom for b in found),
    )


def of_points(points: Iterable[Point]) -> Box:
    """The smallest box around points."""
    return union(Box(x, y, x, y) for x, y in points)


def enter(outside: Point, inside: Point, box: Box, ellipse: bool) -> Point:
    """Where the line from `outside` to `inside` meets a shape first.

    Gives `inside` itself when the line does not cross the edge: when both are inside (overlapping shapes), or none.
    """
    t = _enter_ellipse(outside, inside, box) if ellipse else _enter_box(outside, inside, box)
    if t is None:
        return inside
    return outside[0] + t * (inside[0] - outside[0]), outside[1] + t * (inside[1] - outside[1])


def _enter_box(a: Point, b: Point, box: Box) -> float | None:
    if box.holds(a):
        return None
    first, last = 0.0, 1.0
    for start, step, low, high in (
        (a[0], b[0] - a[0], box.left, box.right),
        (a[1], b[1] - a[1], box.top, box.bottom),
    ):
        if step == 0:
            if not low <= start <= high:
                return None
            continue
        near, far = sorted(((low - start) / step, (high - start) / step))
        first, last = max(first, near), min(last, far)
    return first if first <= last else None


def _enter_ellipse(a: Point, b: Point, box: Box) -> float | None:
    rx, ry = box.width / 2, box.height / 2
    if rx <= 0 or ry <= 0:
        return None
    cx, cy = (box.left + box.right) / 2, (box.top + box.bottom) / 2
    x, y = (a[0] - cx) / rx, (a[1] - cy) / ry
    dx, dy = (b[0] - a[0]) / rx, (b[1] - a[1]) / ry
    # |(x, y) + t (dx, dy)| = 1
    p, q, r = dx * dx + dy * dy, x * dx + y * dy, x * x + y * y - 1
    root = q * q - p * r
    if p == 0 or r <= 0 or root < 0:
        return None
    t = (-q - math.sqrt(root)) / p
    return t if 0 <= t <= 1 else None


def towards(a: Point, b: Point, distance: float) -> Point:
    """The point at a distance from `a` on the way to `b`; `a` itself when they are the same."""
    length = math.dist(a, b)
    if length == 0:
        return a
    t = distance / length
    return a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])


def along(points: tuple[Point, ...], part: float) -> Point:
    """The point at a part (0 to 1) of the length of a line through points."""
    lengths = [math.dist(a, b) for a, b in zip(points, points[1:], strict=False)]
    left = sum(lengths) * part
    for (a, b), length in zip(zip(points, points[1:], strict=False), lengths, strict=True):
        if left <= length and length > 0:
            return towards(a, b, left)
        left -= length
    return points[-1]
