"""A small state space as SVG. Tool tips are `<title>`; same input, same bytes.

picture(graph, "net.cpn")                                   # an SVG document
figure(layout, graph, Links(lambda n: f"#row-{n}"))         # the elements alone, for a page around them
"""

from __future__ import annotations

import math
from collections.abc import Callable

from pn2code.base.frozen import frozen
from pn2code.drawing import text
from pn2code.drawing.geometry import Box, Point, of_points, union
from pn2code.drawing.svg import MARGIN, svg_attributes
from pn2code.verify.report.graph import StateGraph
from pn2code.verify.report.graph_layout import Drawn, Layout, Placed, lay_out

INK, SOFT, BACK = "#1d2330", "#5c6575", "#9aa3b2"
DEAD, DEAD_FILL = "#c00000", "#fbdcdc"
HOME = "#1b7a1b"
PATH = "#d95f02"
GROUPS = (
    "#dbe9f8", "#e8dff4", "#dcf0dd", "#fdf0d0", "#dff2f2", "#f6e3ee", "#ecead8", "#e3e6fa",
)  # fmt: skip
"""Fills of the components that have a cycle, in turn; nodes in no cycle are white."""
_HEAD, _HALF = 8.0, 3.2
_ENTRY = 20.0
_TIP_LINES, _TIP_WIDTH = 40, 200


LARGE = 2_500
"""Nodes and arcs."""


@frozen
class Links:
    """Where a click leads to, and how a node is reached: addresses by number of the node, or position of the arc.

    "" for none.
    """

    node: Callable[[int], str] = lambda number: ""
    arc: Callable[[int], str] = lambda position: ""
    anchor: Callable[[int], str] = lambda number: ""


def picture(graph: StateGraph, title: str) -> str:
    """A state space as an SVG document."""
    body, box = figure(lay_out(graph), graph, Links())
    head, below = _legend(graph, title, box)
    everything = union([box, below]).grown(MARGIN)
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<svg xmlns="http://www.w3.org/2000/svg" {svg_attributes(everything)}>',
            f"<title>{text.escape(title)}: state space</title>",
            f'<rect x="{_n(everything.left)}" y="{_n(everything.top)}" width="{_n(everything.width)}" '
            f'height="{_n(everything.height)}" fill="#ffffff"/>',
            *head,
            *body,
            "</svg>\n",
        ]
    )


def figure(layout: Layout, graph: StateGraph, links: Links) -> tuple[list[str], Box]:
    """All nodes and lines, without the `svg` around them, and the box around them."""
    path = set(graph.path)
    on_path = [e for e in layout.edges if path.intersection(e.arcs)]
    others = [e for e in layout.edges if not path.intersection(e.arcs)]
    others.sort(key=lambda e: not e.goes_back)  # what leads down is above what leads back
    rows: list[str] = []
    boxes: list[Box] = [p.box for p in layout.nodes]
    for edges, shown in ((others, False), (on_path, True)):
        for edge in edges:
            drawn, box = _edge(edge, graph, shown, links)
            rows.append(drawn)
            boxes.append(box)
    # Labels lie above all lines; what is under them is seen through.
    rows += [_label(edge, links) for edge in layout.edges if edge.box is not None]
    rows += [_node(placed, graph, links) for placed in layout.nodes]
    boxes += [edge.box for edge in layout.edges if edge.box is not None]
    first = layout.nodes[0].box
    x = (first.left + first.right) / 2
    rows.append(
        f'<path d="M{_n(x)} {_n(first.top - _ENTRY)}V{_n(first.top - _HEAD)}" fill="none" '
        f'stroke="{INK}" stroke-width="2"/>' + _head((x, first.top), 1, INK)
    )
    boxes.append(Box(x, first.top - _ENTRY, x, first.top))
    return rows, union(boxes)


def _node(placed: Placed, graph: StateGraph, links: Links) -> str:
    node, box = placed.node, placed.box
    kinds = ["node"]
    fill = GROUPS[node.component % len(GROUPS)] if node.component in graph.cyclic else "#ffffff"
    line, thick = INK, 1.0
    said = []
    if node.number == 1:
        thick = 2.5
        said.append("initial marking")
    if node.number in graph.home:
        said.append("home marking")
        if not all_home(graph):
            kinds.append("home")
            line = HOME
    if node.number in graph.dead:
        kinds.append("dead")
        line, fill, thick = DEAD, DEAD_FILL, 2.0
        said.append("dead marking")
    head = f"node {node.number}" + (f" ({', '.join(said)})" if said else "")
    tip = text.shorten(f"{head}\n{node.text}", _TIP_LINES, _TIP_WIDTH)
    rows = [
        f"<title>{text.escape(tip)}</title>",
        f'<rect x="{_n(box.left)}" y="{_n(box.top)}" width="{_n(box.width)}" '
        f'height="{_n(box.height)}" rx="6" fill="{fill}" stroke="{line}" stroke-width="{_n(thick)}"/>',
    ]
    if node.number in graph.home and node.number in graph.dead and not all_home(graph):
        inner = box.grown(-2.5)
        rows.append(
            f'<rect x="{_n(inner.left)}" y="{_n(inner.top)}" width="{_n(inner.width)}" '
            f'height="{_n(inner.height)}" rx="4" fill="none" stroke="{HOME}"/>'
        )
    top = (box.top + box.bottom) / 2 - text.LINE * len(placed.lines) / 2
    for i, shown in enumerate(placed.lines):
        y = top + text.LINE * (i + 0.5) + text.SIZE * 0.35
        x, style = box.left + 6, ""
        if i == 0:
            x, style = (box.left + box.right) / 2, ' text-anchor="middle" font-weight="bold"'
        rows.append(_line(shown, x, y, INK, style))
    anchor = links.anchor(node.number)
    identity = f' id="{text.attribute(anchor)}"' if anchor else ""
    group = f'<g class="{" ".join(kinds)}"{identity}>{"".join(rows)}</g>'
    return _linked(group, links.node(node.number))


def all_home(graph: StateGraph) -> bool:
    """Whether each marking is a home marking; then none needs to be marked as one."""
    return len(graph.home) == len(graph.nodes)


def is_large(graph: StateGraph) -> bool:
    """Whether a page draws it on a canvas, where scripts are permitted."""
    return len(graph.nodes) + len(graph.arcs) > LARGE


def _reach(drawn: str, graph: StateGraph) -> str:
    """A line is hard to point at: a wide one that is not seen helps. Very many would only make the file larger."""
    if is_large(graph):
        return ""
    return f'<path d="{drawn}" fill="none" stroke="#ffffff" stroke-opacity="0" stroke-width="8"/>'


def _edge(edge: Drawn, graph: StateGraph, on_path: bool, links: Links) -> tuple[str, Box]:
    ink = PATH if on_path else BACK if edge.goes_back else SOFT
    thick = 2.2 if on_path else 1.0
    drawn, direction, tip = _course(edge)
    rows = [
        _tip(edge, graph),
        f'<path d="{drawn}" fill="none" stroke="{ink}" stroke-width="{_n(thick)}"/>',
        _reach(drawn, graph),
        _head(tip, direction, ink) if edge.source != edge.target else _side_head(tip, ink),
    ]
    group = f'<g class="arc{" way" if on_path else ""}">{"".join(rows)}</g>'
    box = of_points(edge.points)
    if edge.source == edge.target:
        box = box.grown(26)
    elif edge.hangs:
        box = Box(box.left, box.top, box.right, box.bottom + 40)
    return _linked(group, links.arc(edge.arcs[0])), box


def _tip(edge: Drawn, graph: StateGraph) -> str:
    rows = [f"{edge.source} → {edge.target}", *(graph.arcs[i].label for i in edge.arcs)]
    return f"<title>{text.escape(text.shorten(chr(10).join(rows), _TIP_LINES, _TIP_WIDTH))}</title>"


def _course(edge: Drawn) -> tuple[str, int, Point]:
    """The path, the direction in which it comes (1: downwards), and its end, where the tip of the arrow is."""
    points = list(edge.points)
    if edge.source == edge.target:
        (x, y), (_, below) = points
        far, head = x + 26, x + _HEAD
        return (
            f"M{_n(x)} {_n(y)}C{_n(far)} {_n(y - 12)} {_n(far)} {_n(below + 8)} {_n(head)} {_n(below)}",
            0,
            (x, below),
        )
    start, end = points[0], points[-1]
    direction = -1 if edge.hangs or end[1] < points[-2][1] else 1
    points[-1] = (end[0], end[1] - direction * _HEAD)
    rows = [f"M{_n(start[0])} {_n(start[1])}"]
    if edge.hangs and len(points) == 3:
        x, y = points[1]  # the label is the lowest point
        rows.append(_cubic((start[0], y), ((start[0] + x) / 2, y), points[1]))
        rows.append(_cubic(((end[0] + x) / 2, y), (end[0], y), points[2]))
    elif edge.hangs:
        low = max(start[1], end[1]) + 30 + min(20.0, abs(end[0] - start[0]) / 12)
        rows.append(_cubic((start[0], low), (end[0], low), points[1]))
    else:
        for a, b in zip(points, points[1:], strict=False):
            half = (a[1] + b[1]) / 2
            rows.append(_cubic((a[0], half), (b[0], half), b))
    return "".join(rows), direction, end


def _cubic(a: Point, b: Point, to: Point) -> str:
    return f"C{_n(a[0])} {_n(a[1])} {_n(b[0])} {_n(b[1])} {_n(to[0])} {_n(to[1])}"


def _label(edge: Drawn, links: Links) -> str:
    box = edge.box
    assert box is not None
    rows = [
        f'<rect x="{_n(box.left)}" y="{_n(box.top)}" width="{_n(box.width)}" '
        f'height="{_n(box.height)}" fill="#ffffff" fill-opacity="0.85"/>'
    ]
    for i, shown in enumerate(edge.label):
        y = box.top + text.LINE * (i + 0.5) + text.SIZE * 0.35
        rows.append(_line(shown, box.left + 2, y, SOFT, ""))
    return _linked(f'<g class="label">{"".join(rows)}</g>', links.arc(edge.arcs[0]))


def _line(shown: str, x: float, y: float, ink: str, style: str) -> str:
    bold = "bold" in style
    length = ""
    if len(shown) > 1:  # as wide as it was measured, whatever font there is
        length = f' textLength="{_n(text.width(shown, bold))}" lengthAdjust="spacingAndGlyphs"'
    return (
        f'<text x="{_n(x)}" y="{_n(y)}" fill="{ink}"{style}{length} xml:space="preserve">'
        f"{text.escape(shown)}</text>"
    )


def _linked(group: str, address: str) -> str:
    return f'<a href="{text.attribute(address)}">{group}</a>' if address else group


def _head(tip: Point, direction: int, ink: str) -> str:
    x, y = tip
    back = y - direction * _HEAD
    return f'<path d="M{_n(x)} {_n(y)}L{_n(x - _HALF)} {_n(back)}H{_n(x + _HALF)}z" fill="{ink}"/>'


def _side_head(tip: Point, ink: str) -> str:
    x, y = tip
    return f'<path d="M{_n(x)} {_n(y)}L{_n(x + _HEAD)} {_n(y - _HALF)}V{_n(y + _HALF)}z" fill="{ink}"/>'


@frozen
class Item:
    """A line of the legend: what a node ("" for the fill: a line) of such colours means."""

    fill: str
    ink: str
    thick: float
    text: str


def legend(graph: StateGraph) -> list[Item]:
    """What colours mean; only of what the picture has."""
    found = [Item("#ffffff", INK, 2.5, "initial marking")]
    if graph.dead:
        found.append(Item(DEAD_FILL, DEAD, 2.0, "dead marking"))
    if graph.home and not all_home(graph):
        found.append(Item("#ffffff", HOME, 1.0, "home marking"))
    if graph.cyclic:
        many = len(graph.cyclic) > 1
        said = "components with cycles, each its colour" if many else "in a cycle"
        found.append(Item(GROUPS[min(graph.cyclic) % len(GROUPS)], INK, 1.0, said))
    if graph.path:
        found.append(Item("", PATH, 2.2, "a shortest way to a dead marking"))
    return found


def sample(item: Item) -> str:
    """A small SVG of its own that shows what an item of the legend is about."""
    shape = _sample(item, 2, 9)
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="28" height="18">{shape}</svg>'


def _sample(item: Item, x: float, y: float) -> str:
    style = f'stroke="{item.ink}" stroke-width="{_n(item.thick)}"'
    if not item.fill:
        return f'<path d="M{_n(x)} {_n(y)}h24" {style}/>'
    return (
        f'<rect x="{_n(x)}" y="{_n(y - 7)}" width="24" height="14" rx="4" '
        f'fill="{item.fill}" {style}/>'
    )


def facts(graph: StateGraph) -> str:
    """The size in words."""
    parts = [
        f"{len(graph.nodes):,} nodes",
        f"{len(graph.arcs):,} arcs",
        f"{graph.components:,} strongly connected component{'s' * (graph.components != 1)}",
    ]
    if graph.dead:
        parts.append(f"{len(graph.dead):,} dead")
    if all_home(graph):
        parts.append("all markings are home markings")
    elif graph.home:
        parts.append(f"{len(graph.home):,} home")
    else:
        parts.append("no home markings")
    return ", ".join(parts)


def _legend(graph: StateGraph, title: str, box: Box) -> tuple[list[str], Box]:
    """Heading and legend above the picture."""
    items = legend(graph)
    widths = [text.width(item.text) + 46 for item in items]
    per_row = max(box.width, 420.0)
    left, x, lines = box.left, 0.0, 1
    spots = []
    for w in widths:
        if x and x + w > per_row:
            x, lines = 0.0, lines + 1
        spots.append((left + x, lines))
        x += w
    bottom = box.top - 22
    top = bottom - 22 * lines - 46
    rows = [
        f'<text x="{_n(left)}" y="{_n(top + 16)}" font-size="17" font-weight="bold" fill="{INK}">'
        f"{text.escape(title)}</text>",
        f'<text x="{_n(left)}" y="{_n(top + 36)}" fill="{SOFT}">{text.escape(facts(graph))}</text>',
    ]
    for (x, line), item in zip(spots, items, strict=True):
        y = top + 46 + 22 * (line - 1) + 9
        rows += [_sample(item, x, y), _line(item.text, x + 30, y + 4.5, INK, "")]
    widest = max(
        [text.width(title, bold=True) * 1.35, text.width(facts(graph))]
        + [x - left + w for (x, _), w in zip(spots, widths, strict=True)]
    )
    return rows, Box(left, top, left + widest, bottom)


def _n(value: float) -> str:
    """A number with at most one decimal."""
    if not math.isfinite(value):
        return "0"
    shown = f"{value:.1f}"
    return "0" if shown == "-0.0" else shown.removesuffix(".0")
