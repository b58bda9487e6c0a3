"""Units of coordinates: CPN Tools 1.1 and earlier (file format 2) wrote millimetres, later versions points.

Their texts have the size that they have today, so such a page is drawn with its coordinates turned into points.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.reading.document import (
    Document,
    Inscription,
    Layout,
    RawPage,
    RawPlace,
    RawTransition,
)

POINTS = 2.83
"""Points in a millimetre, as CPN Tools converted them."""
_SMALL = 13.0
"""Nodes lower than a line of text are not drawn in points."""


def in_points(document: Document, page: RawPage) -> RawPage:
    """The page with coordinates in points."""
    if document.format not in ("1", "2"):
        return page
    heights = sorted(n.layout.height for p in document.pages for n in p.nodes)
    if not heights or not 0 < heights[len(heights) // 2] < _SMALL:
        return page
    return replace(
        page,
        places=tuple(map(_place, page.places)),
        transitions=tuple(map(_transition, page.transitions)),
        arcs=tuple(
            replace(a, layout=_layout(a.layout), inscription=_inscription(a.inscription))
            for a in page.arcs
        ),
        undirected=tuple(replace(a, layout=_layout(a.layout)) for a in page.undirected),
        auxiliaries=tuple(replace(a, layout=_layout(a.layout)) for a in page.auxiliaries),
    )


def _layout(at: Layout) -> Layout:
    return replace(
        at,
        x=at.x * POINTS,
        y=at.y * POINTS,
        width=at.width * POINTS,
        height=at.height * POINTS,
        bends=tuple((x * POINTS, y * POINTS) for x, y in at.bends),
    )


def _inscription(i: Inscription | None) -> Inscription | None:
    return replace(i, layout=_layout(i.layout)) if i else None


def _place(p: RawPlace) -> RawPlace:
    return replace(
        p,
        layout=_layout(p.layout),
        type=_inscription(p.type),
        initial=_inscription(p.initial),
        port_layout=_layout(p.port_layout),
        fusion_layout=_layout(p.fusion_layout),
        token=_layout(p.token),
        marking=_layout(p.marking),
    )


def _transition(t: RawTransition) -> RawTransition:
    s = t.substitution
    return replace(
        t,
        layout=_layout(t.layout),
        guard=_inscription(t.guard),
        delay=_inscription(t.delay),
        code=_inscription(t.code),
        priority=_inscription(t.priority),
        channel=_inscription(t.channel),
        substitution=replace(s, layout=_layout(s.layout)) if s else None,
    )
