"""Where the nodes of a page stand: as the file says, or arranged where it says nothing useful."""

from __future__ import annotations

from dataclasses import replace

from pn2code.drawing import text
from pn2code.drawing.arrange import Arrangement, arrange
from pn2code.drawing.geometry import Point
from pn2code.reading.document import Document, Layout, RawPage

PLACE_SIZE, TRANSITION_SIZE = (60.0, 40.0), (60.0, 40.0)
"""CPN Tools' own, for nodes without a size."""


_ARRANGED_SHARE = 0.3


def node_size(layout: Layout, default: tuple[float, float]) -> tuple[float, float]:
    """A node's size; the default where the file has none."""
    return (
        layout.width if layout.width > 0 else default[0],
        layout.height if layout.height > 0 else default[1],
    )


def needs_arranging(page: RawPage) -> bool:
    """Whether the positions are missing or useless: many nodes stand on one another."""
    layouts = [n.layout for n in page.nodes]
    if len(layouts) < 2:
        return False
    if not any(at.known for at in layouts):
        return True
    points = {(round(at.x), round(at.y)) for at in layouts}
    return len(layouts) - len(points) > _ARRANGED_SHARE * len(layouts)


def positions(document: Document) -> dict[str, Point]:
    """Where the nodes stand, by id, in the units of the file (y upwards); arranged where the file does not say."""
    found: dict[str, Point] = {}
    for page in document.pages:
        if needs_arranging(page):
            centres = arrangement(page).centres
            found.update({identity: (x, -y) for identity, (x, y) in centres.items()})
        else:
            found.update({n.id: (n.layout.x, n.layout.y) for n in page.nodes})
    return found


def arrangement(page: RawPage) -> Arrangement:
    """Where the nodes of a page stand, and the bends of its arcs, by id, in points; bends from transition to place."""
    nodes = {p.id: node_size(p.layout, PLACE_SIZE) for p in page.places}
    nodes |= {t.id: node_size(t.layout, TRANSITION_SIZE) for t in page.transitions}
    for n in page.nodes:
        w = text.extent(text.lines(n.caption))[0] if n.caption else 0.0
        nodes[n.id] = (max(nodes[n.id][0], w), nodes[n.id][1])
    edges = {}
    for arc in page.arcs:
        if arc.transition in nodes and arc.place in nodes:
            outwards = arc.orientation == "ttop"
            ends = (arc.transition, arc.place) if outwards else (arc.place, arc.transition)
            edges[arc.id] = ends
    found = arrange(nodes, edges)
    # Bends run with the edge; ours from the transition to the place.
    bends = {
        e: b if edges[e][0] in {t.id for t in page.transitions} else b[::-1]
        for e, b in found.bends.items()
    }
    return replace(found, bends=bends)
