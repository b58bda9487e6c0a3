"""Where the nodes and arcs of a small state space are drawn: layers by depth, the initial marking on top.

How much is written depends on the size: into the nodes their markings, beside the arcs what occurs, or numbers alone.
Labels of arcs stand in layers of their own, between those of the nodes, so that nothing covers them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.drawing import text
from pn2code.drawing.arrange import arrange
from pn2code.drawing.geometry import Box, Point, around
from pn2code.verify.report.graph import Node, StateGraph

MOST_LABELLED = 120
"""Lines between nodes: with more of them, labels would be all that is seen."""
MOST_FULL = 80
"""Nodes with their markings in them."""
_NODE_LINES, _NODE_WIDTH = 6, 42
_LABEL_LINES, _LABEL_WIDTH = 3, 34
_LOOP = 26.0
_PORT = 12.0
_DROP = 3.0

Edge = tuple[int, int]


@frozen
class Placed:
    """A node: its box, the lines in it; the first is its number."""

    node: Node
    box: Box
    lines: tuple[str, ...]


@frozen
class Drawn:
    """Parallel arcs as one line.

    Args:
        arcs: positions in `StateGraph.arcs`.
        points: from the border of one node to that of the other.
        hangs: both nodes are in one layer: the line goes from one to the other below them.
        label, box: what is written on it, and where; None: nothing.
        goes_back: it leads to a layer above or to its own.
    """

    source: int
    target: int
    arcs: tuple[int, ...]
    points: tuple[Point, ...]
    hangs: bool
    label: tuple[str, ...]
    box: Box | None
    goes_back: bool


@frozen
class Layout:
    """Everything with its place."""

    nodes: tuple[Placed, ...]
    edges: tuple[Drawn, ...]
    is_labelled: bool


def lay_out(graph: StateGraph) -> Layout:
    """Positions for all nodes and lines."""
    edges = graph.edges()
    labelled = len(edges) <= MOST_LABELLED
    full = labelled and len(graph.nodes) <= MOST_FULL and _are_short(graph.nodes)
    lines = {n.number: _node_lines(n, full) for n in graph.nodes}
    size = {n: _node_size(own) for n, own in lines.items()}
    labels = {e: _label(graph, own) if labelled else () for e, own in edges.items()}
    loops = {a for a, b in edges if a == b}
    layer = {n.number: n.depth * (2 if labelled else 1) for n in graph.nodes}
    boxes: dict[str, tuple[float, float]] = {}
    layers: dict[str, int] = {}
    for n in graph.nodes:
        w, h = size[n.number]
        if (
            n.number in loops
        ):  # room for the loop and its label, on both sides: the node stays in the middle
            w += 2 * (_LOOP + text.extent(labels[n.number, n.number])[0])
        boxes[f"n{n.number}"] = (w, h)
        layers[f"n{n.number}"] = layer[n.number]
    lines_between: dict[str, tuple[str, str]] = {}
    for (a, b), label in labels.items():
        if a == b:
            continue
        start, end, name = f"n{a}", f"n{b}", f"{a}-{b}"
        if not labelled:
            lines_between[name] = (start, end)
            continue
        w, h = text.extent(label)
        boxes[name] = (w + 4, h)
        layers[name] = layer[a] + (1 if layer[b] >= layer[a] else -1)
        lines_between[f"{name}>"] = (start, name)
        lines_between[f">{name}"] = (name, end)
    found = arrange(boxes, lines_between, layers, _gap(boxes, layers, labelled))
    centre = {n: found.centres[f"n{n}"] for n in size}
    placed = {n: around(*centre[n], *size[n]) for n in size}
    inner: dict[Edge, list[Point]] = {}
    hanging: dict[int, int] = {}  # how many lines hang below a layer: each has a height of its own
    for a, b in edges:
        name = f"{a}-{b}"
        if not labelled:
            inner[a, b] = list(found.bends.get(name, ()))
        elif a != b:
            before = list(found.bends.get(f"{name}>", ()))
            after = list(found.bends.get(f">{name}", ()))
            drop = _DROP * (1 + hanging.get(layer[a], 0) % 5)
            hanging[layer[a]] = hanging.get(layer[a], 0) + (layer[a] == layer[b])
            passed = _through(around(*found.centres[name], *boxes[name]), layer[a], layer[b], drop)
            inner[a, b] = [*before, *passed, *after]
    ends = _ports(inner, placed, layer)
    drawn = []
    for (a, b), own in edges.items():
        label = labels[a, b]
        w, h = text.extent(label)
        if a == b:
            right, y = placed[a].right, centre[a][1]
            loop = ((right, y - 5), (right, y + 5))
            left = right + _LOOP - 4
            beside = Box(left, y - h / 2, left + w, y + h / 2) if label else None
            drawn.append(Drawn(a, b, tuple(own), loop, False, label, beside, True))
            continue
        points = (ends[a, b, 0], *inner[a, b], ends[a, b, 1])
        on = around(*found.centres[f"{a}-{b}"], w + 4, h) if label else None
        hangs = layer[a] == layer[b]
        drawn.append(Drawn(a, b, tuple(own), points, hangs, label, on, layer[b] <= layer[a]))
    nodes = tuple(Placed(n, placed[n.number], lines[n.number]) for n in graph.nodes)
    return Layout(nodes, tuple(drawn), labelled)


def _gap(
    boxes: Mapping[str, tuple[float, float]], layers: Mapping[str, int], labelled: bool
) -> tuple[float, float]:
    """Between nodes and between layers: the wider the picture, the higher, so that lines do not become flat."""
    width: dict[int, float] = {}
    for name, (w, _) in boxes.items():
        width[layers[name]] = width.get(layers[name], 0.0) + w + 24.0
    widest = max(width.values())
    if labelled:
        return 26.0, min(max(30.0, widest / 32), 80.0)
    return 22.0, min(max(46.0, widest / 22), 220.0)


def _through(box: Box, source: int, target: int, drop: float) -> list[Point]:
    """Where a line passes its label: straight from above to below, or the other way."""
    x, _ = _centre(box)
    if source == target:
        return [(x, box.bottom + drop)]  # below the labels of its layer, its own too
    return [(x, box.top), (x, box.bottom)] if source < target else [(x, box.bottom), (x, box.top)]


def _ports(
    inner: Mapping[Edge, Sequence[Point]],
    placed: Mapping[int, Box],
    layer: Mapping[int, int],
) -> dict[tuple[int, int, int], Point]:
    """Where lines touch nodes: side by side on the edge that they come to, in the order of what is behind them."""
    sides: dict[tuple[int, bool], list[tuple[float, tuple[int, int, int]]]] = {}
    for (a, b), between in inner.items():
        if a == b:
            continue
        for end, node, other in ((0, a, b), (1, b, a)):
            away = _centre(placed[other])
            if between:
                away = between[0 if end == 0 else -1]
            below = away[1] > _centre(placed[node])[1]
            if layer[a] == layer[b]:
                below = True
            sides.setdefault((node, below), []).append((away[0], (a, b, end)))
    found: dict[tuple[int, int, int], Point] = {}
    for (node, below), own in sides.items():
        box = placed[node]
        own.sort()
        step = min(_PORT, 0.8 * box.width / len(own))
        left = _centre(box)[0] - step * (len(own) - 1) / 2
        for k, (_, which) in enumerate(own):
            found[which] = (left + k * step, box.bottom if below else box.top)
    return found


def _centre(box: Box) -> Point:
    return (box.left + box.right) / 2, (box.top + box.bottom) / 2


def _are_short(nodes: Sequence[Node]) -> bool:
    """Whether markings are short enough to be read in the nodes."""
    return sum(len(n.text.split("\n")) for n in nodes) <= _NODE_LINES * len(nodes)


def _node_lines(node: Node, full: bool) -> tuple[str, ...]:
    if not full:
        return (str(node.number),)
    shown = text.shorten(node.text, _NODE_LINES + 2, _NODE_WIDTH)
    return (str(node.number), *text.lines(shown))


def _node_size(lines: Sequence[str]) -> tuple[float, float]:
    w, h = text.extent(lines)
    w = max(w, text.width(lines[0], bold=True))
    return max(w + 12, 26.0), h + 6


def _label(graph: StateGraph, arcs: Sequence[int]) -> tuple[str, ...]:
    if len(arcs) == 1:  # in two lines: the narrower the labels, the narrower the picture
        arc = graph.arcs[arcs[0]]
        rows = [arc.transition, " ".join(arc.values.split())] if arc.values else [arc.transition]
    else:
        rows = [" ".join(graph.arcs[i].label.split()) for i in arcs]
    return text.lines(text.shorten("\n".join(rows), _LABEL_LINES, _LABEL_WIDTH))
