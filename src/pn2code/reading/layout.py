"""Layout of net elements: positions, sizes, colours. For drawing only, so nothing here is an error."""

from __future__ import annotations

import math

from pn2code.reading.document import Layout
from pn2code.reading.xml import Node

Point = tuple[float, float]


def number(text: str) -> float:
    """A coordinate; decimal commas (CPN Tools run in such a locale) are accepted, nonsense is 0."""
    try:
        value = float(text)
    except ValueError:
        try:
            value = float(text.strip().replace(",", "."))
        except ValueError:
            return 0.0
    return value if math.isfinite(value) else 0.0


def point(node: Node) -> Point:
    """The `posattr` of an element."""
    position = node.child("posattr")
    return (0.0, 0.0) if position is None else _xy(position)


def _xy(position: Node) -> Point:
    return number(position.get("x")), number(position.get("y"))


def offset(node: Node | None) -> Layout:
    """Layout of a `token` or `marking`, which has its position in attributes."""
    if node is None:
        return Layout()
    return Layout(
        x=number(node.get("x")),
        y=number(node.get("y")),
        hidden=node.get("hidden").lower() == "true",
        known=bool(node.get("x") and node.get("y")),
    )


def layout(node: Node | None, bends: tuple[Point, ...] = ()) -> Layout:
    """Layout of a place, transition, inscription, tag, arc or auxiliary."""
    if node is None:
        return Layout()
    first: dict[str, Node] = {}
    for child in node.children:
        if child.tag not in first:
            first[child.tag] = child
    position = first.get("posattr")
    x, y = (0.0, 0.0) if position is None else _xy(position)
    fill, line, words = first.get("fillattr"), first.get("lineattr"), first.get("textattr")
    shape, width, height = "", 0.0, 0.0
    for tag in ("ellipse", "box", "label"):
        found = first.get(tag)
        if found is not None:
            shape, width, height = tag, number(found.get("w")), number(found.get("h"))
            break
    heads = first.get("arrowattr")
    filled = fill is not None and fill.get("filled").lower() == "true"
    return Layout(
        x=x,
        y=y,
        width=width,
        height=height,
        bends=bends,
        colour=line.get("colour") if line else "",
        fill=fill.get("colour") if fill and filled else "",
        text_colour=words.get("colour") if words else "",
        shape=shape,
        thickness=number(line.get("thick", "1")) if line else 1.0,
        line=line.get("type").lower() if line else "",
        bold=words is not None and words.get("bold").lower() == "true",
        head=number(heads.get("headsize", "1")) if heads else 1.0,
        known=position is not None,
    )


def bends(arc: Node, transition: Point, place: Point) -> tuple[Point, ...]:
    """Bend points of an arc from its transition to its place.

    The file numbers them, but from either end; the shorter way along them is the one drawn.
    """
    nodes = sorted(arc.all("bendpoint"), key=lambda n: number(n.get("serial")))
    points = tuple(point(n) for n in nodes)
    forward = _length((transition, *points, place))
    backward = _length((transition, *reversed(points), place))
    return points if forward <= backward else tuple(reversed(points))


def _length(points: tuple[Point, ...]) -> float:
    return sum(math.dist(a, b) for a, b in zip(points, points[1:], strict=False))
