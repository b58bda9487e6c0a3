"""Layout of PNML elements in the units of CPN Tools: y grows upwards, nodes have room for their names and inscriptions.

PNML says where things stand, but tools write small nodes close together, with all texts beside them; here names stand
inside the nodes. So positions are stretched until neighbours have room.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.reading.document import Layout
from pn2code.reading.layout import number
from pn2code.reading.xml import Node

Point = tuple[float, float]
_ROOM = 130.0
"""Between the centres of neighbours."""
_MOST_SCALE = 8.0
_MOST_COMPARED = 400
_WIDTH, _HEIGHT, _LETTER, _MARGIN = 60.0, 40.0, 6.5, 14.0


def position(node: Node | None) -> Point | None:
    """The `position` inside the `graphics` of an element."""
    graphics = node.child("graphics") if node else None
    at = graphics.child("position") if graphics else None
    return None if at is None else (number(at.get("x")), number(at.get("y")))


def scale(points: Iterable[Point]) -> float:
    """By how much positions are stretched so that most nodes have room."""
    known = sorted(set(points))[:_MOST_COMPARED]
    if len(known) < 2:
        return 1.0
    nearest = []
    for i, (x, y) in enumerate(known):
        others = ((a - x) ** 2 + (b - y) ** 2 for j, (a, b) in enumerate(known) if j != i)
        nearest.append(min(others) ** 0.5)
    nearest.sort()
    typical = nearest[len(nearest) // 4]
    return min(_MOST_SCALE, max(1.0, _ROOM / typical)) if typical > 0 else _MOST_SCALE


def placed(point: Point | None, by: float, offset: Point, name: str) -> Layout:
    """The layout of a node, as wide as its name."""
    width = max(_WIDTH, _LETTER * len(name) + _MARGIN)
    if point is None:
        return Layout(width=width, height=_HEIGHT)
    return Layout(
        x=point[0] * by + offset[0],
        y=-(point[1] * by) + offset[1],
        width=width,
        height=_HEIGHT,
        known=True,
    )


def bends(arc: Node, by: float, offset: Point, from_place: bool) -> Layout:
    """The layout of an arc; its positions run from the source to the target, ours from the transition on."""
    graphics = arc.child("graphics")
    points = [
        (number(p.get("x")) * by + offset[0], -number(p.get("y")) * by + offset[1])
        for p in (graphics.all("position") if graphics else ())
    ]
    return Layout(bends=tuple(reversed(points) if from_place else points), known=bool(points))
