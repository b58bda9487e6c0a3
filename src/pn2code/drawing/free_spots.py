"""Where the texts of a page go whose nodes stand where we have put them: beside what they belong to, on nothing else.

Each text has some spots, the usual one first; it takes the one that lies least on other texts, nodes and arcs. Long
texts, such as code segments, choose first, since few spots have room for them. Deterministic.

    spread([label, ...], {"T": box, ...}, lines)
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from pn2code.drawing.geometry import Box, Point, along
from pn2code.drawing.shapes import Corner, Label, Line

_ON_TEXT, _ON_NODE, _ON_LINE = 6.0, 6.0, 1.0
"""How bad it is to lie on a text, a node, an arc."""
_LATER = 2.0
"""How bad each spot is besides, after those before it."""
_CELL = 100.0
_STEP = 6.0
"""Between the points of an arc that texts avoid."""
_PARTS = (0.5, 0.38, 0.62, 0.26, 0.74)
"""Of the length of an arc: where its inscription may stand."""
_MANY = 4000
"""Pages with more texts than that nobody reads: they keep the usual spots."""


def spread(
    labels: Sequence[Label],
    nodes: Mapping[str, Box],
    lines: Sequence[Line],
    others: Iterable[Box] = (),
) -> list[Label]:
    """The texts with their boxes where there is room.

    Args:
        labels: each in its usual spot.
        nodes: boxes of places and transitions, by id.
        lines: the arcs.
        others: boxes that texts do not cover either.
    """
    if len(labels) > _MANY:
        return list(labels)
    taken = _Taken(nodes, lines, others)
    arcs = {line.id: line for line in lines}
    found = list(labels)
    for number in sorted(range(len(found)), key=lambda i: -_area(found[i].box)):
        label = found[number]
        if label.owner in nodes:
            spots = [label.box, *_beside(label, nodes[label.owner])]
        elif label.owner in arcs:
            spots = [label.box, *_at_line(label, arcs[label.owner])]
        else:
            spots = [label.box]
        box = min(enumerate(spots), key=lambda s: (taken.cost(s[1]) + s[0] * _LATER, s[0]))[1]
        taken.add(box, _ON_TEXT)
        found[number] = replace(label, box=box)
    return found


def _area(box: Box) -> float:
    return box.width * box.height


def _beside(label: Label, node: Box) -> Iterator[Box]:
    """Beside a node: its corners, above and below, and its left and right, where a place shows no tokens."""
    w, h = label.box.width, label.box.height
    middle = (node.top + node.bottom) / 2
    is_low = (label.box.top + label.box.bottom) / 2 > middle
    for low in (is_low, not is_low):
        y, dy = (node.bottom + 1, 1) if low else (node.top - 1, -1)
        yield Corner(node.right, y, 1, dy).box(w, h)
        yield Corner(node.left, y, -1, dy).box(w, h)
    if label.kind not in ("colset", "initial"):
        yield Corner(node.right + 4, middle, 1, 0).box(w, h)
    yield Corner(node.left - 4, middle, -1, 0).box(w, h)


def _at_line(label: Label, line: Line) -> Iterator[Box]:
    """Beside an arc: right and left of some of its points."""
    w, h = label.box.width, label.box.height
    for part in _PARTS:
        x, y = along(line.points, part)
        yield Corner(x + 4, y, 1, 0).box(w, h)
        yield Corner(x - 4, y, -1, 0).box(w, h)


class _Taken:
    """What texts do not cover, by the squares of a grid."""

    def __init__(
        self, nodes: Mapping[str, Box], lines: Sequence[Line], others: Iterable[Box]
    ) -> None:
        self._boxes: dict[tuple[int, int], list[tuple[Box, float]]] = {}
        self._points: dict[tuple[int, int], list[Point]] = {}
        for box in nodes.values():
            self.add(box, _ON_NODE)
        for box in others:
            self.add(box, _ON_TEXT)
        for line in lines:
            for x, y in _points(line):
                self._points.setdefault((int(x // _CELL), int(y // _CELL)), []).append((x, y))

    def add(self, box: Box, weight: float) -> None:
        """What lies here is not to be covered."""
        for cell in _cells(box):
            self._boxes.setdefault(cell, []).append((box, weight))

    def cost(self, box: Box) -> float:
        """How much a text covers that lies here: lengths of arcs, and widths of what it lies on."""
        total = 0.0
        seen: set[int] = set()
        for cell in _cells(box):
            for other, weight in self._boxes.get(cell, ()):
                if id(other) not in seen and box.overlaps(other):
                    seen.add(id(other))
                    total += weight * _common(box, other)
            total += sum(_ON_LINE * _STEP for p in self._points.get(cell, ()) if box.holds(p))
        return total


def _common(one: Box, other: Box) -> float:
    """How far two boxes lie on one another."""
    w = min(one.right, other.right) - max(one.left, other.left)
    h = min(one.bottom, other.bottom) - max(one.top, other.top)
    return math.sqrt(max(w, 0.0) * max(h, 0.0))


def _cells(box: Box) -> Iterator[tuple[int, int]]:
    for x in range(int(box.left // _CELL), int(box.right // _CELL) + 1):
        for y in range(int(box.top // _CELL), int(box.bottom // _CELL) + 1):
            yield x, y


def _points(line: Line) -> Iterator[Point]:
    for a, b in zip(line.points, line.points[1:], strict=False):
        steps = max(int(math.dist(a, b) // _STEP), 1)
        for i in range(steps + 1):
            yield a[0] + (b[0] - a[0]) * i / steps, a[1] + (b[1] - a[1]) * i / steps
