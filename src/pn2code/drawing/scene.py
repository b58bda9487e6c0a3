"""A page as shapes and texts with positions: what there is to draw, before it is SVG. y grows downwards.

How CPN Tools places things, as found in its source and in many files: positions are centres, of inscriptions and
tags too, but a free text begins at its position with the base line of its first line; y grows upwards; arcs end
where they meet the shape's edge, arcs between the same two nodes run side by side in the order of their `order`;
an arc whose bend lies beside a node meets it at a right angle; texts in their default state (`[]`, `@+`) are hidden.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field

from pn2code.base.frozen import record
from pn2code.drawing import text
from pn2code.drawing.arrange import Arrangement
from pn2code.drawing.free_spots import spread
from pn2code.drawing.geometry import Box, Point, along, around, enter, of_points, union
from pn2code.drawing.positions import (
    PLACE_SIZE,
    TRANSITION_SIZE,
    arrangement,
    needs_arranging,
    node_size,
)
from pn2code.drawing.shapes import Corner, Label, Line, Scene, Shape, Tag, text_box
from pn2code.drawing.titles import HIDDEN, PORTS, arc_title, place_title, transition_title
from pn2code.drawing.units import in_points
from pn2code.reading.document import (
    Document,
    Inscription,
    Layout,
    RawArc,
    RawAux,
    RawPage,
    RawPlace,
    RawTransition,
)

SIBLING_DISTANCE = 10.0
"""Between arcs that run side by side."""
DEFAULT_TOKEN = -10.0
"""CPN Tools' usual distance of the number of tokens from its place beside the place."""
_FAR = 10.0
_STEP = 14.0


def build(document: Document, page: RawPage) -> Scene:
    """The scene of a page."""
    return _Builder(document, in_points(document, page)).scene()


@record
class _Builder:
    document: Document
    page: RawPage
    arranged: Arrangement | None = None
    nodes: dict[str, Shape] = field(default_factory=dict)
    labels: list[Label] = field(default_factory=list)
    tags: list[Tag] = field(default_factory=list)
    nowhere: bool = False

    def scene(self) -> Scene:
        """Everything, in the order of the file."""
        page = self.page
        if needs_arranging(page):
            self.arranged = arrangement(page)
        self.nowhere = self.labels_lack_positions()
        for place in page.places:
            self.nodes[place.id] = self.node(place, "place", PLACE_SIZE, place_title(place))
        for t in page.transitions:
            kind = "substitution" if t.substitution else "transition"
            link = t.substitution.subpage if t.substitution else ""
            self.nodes[t.id] = self.node(
                t, kind, TRANSITION_SIZE, transition_title(t, self.page_name(link)), link
            )
        for place in page.places:
            self.place(place)
        for t in page.transitions:
            self.transition(t)
        lines = [self.line(*incidence) for incidence in self.incidences()]
        if self.arranged:
            boxes = {identity: shape.box for identity, shape in self.nodes.items()}
            self.labels = spread(self.labels, boxes, lines, [tag.box for tag in self.tags])
        extra = [] if self.arranged else [self.auxiliary(aux) for aux in page.auxiliaries]
        if self.arranged and page.auxiliaries:
            self.notes(page.auxiliaries, lines)
        tokens, markings = {}, {}
        for place in page.places:
            tokens[place.id], markings[place.id] = self.token(place)
        return Scene(
            page=page.id,
            name=page.name,
            shapes=(*(s for s in extra if s is not None), *self.nodes.values()),
            lines=tuple(lines),
            labels=tuple(self.labels),
            tags=tuple(self.tags),
            arranged=self.arranged is not None,
            tokens=tokens,
            markings=markings,
            hidden=frozenset(p.id for p in page.places if p.marking.hidden),
        )

    def page_name(self, identity: str) -> str:
        """The name of a page; its id when there is no such page."""
        return next((p.name for p in self.document.pages if p.id == identity), identity)

    def labels_lack_positions(self) -> bool:
        """Whether a program wrote 0, 0 for the texts: nobody puts two texts there."""
        found = [i.layout for i in _inscriptions(self.page)]
        return sum(1 for at in found if at.x == 0 == at.y) > 1

    def node(
        self,
        raw: RawPlace | RawTransition,
        kind: str,
        size: tuple[float, float],
        title: str,
        link: str = "",
    ) -> Shape:
        """A place or transition."""
        centre = (round(raw.layout.x), -round(raw.layout.y))
        if self.arranged:
            centre = self.arranged.centres[raw.id]  # type: ignore[assignment]  # a pair of numbers, too
        w, h = node_size(raw.layout, size)
        is_round = raw.layout.shape == "ellipse" or (raw.layout.shape == "" and kind == "place")
        caption = tuple(s.strip() for s in text.lines(raw.caption)) if raw.caption else ()
        return Shape(
            raw.id, kind, around(*centre, w, h), is_round, raw.layout, caption, title, link
        )

    def place(self, place: RawPlace) -> None:
        """Texts and tags of a place."""
        box, owner = self.nodes[place.id].box, place.id
        self.label(owner, "colset", place.type, Corner(box.right - 6, box.bottom + 1, 1, 1))
        self.label(owner, "initial", place.initial, Corner(box.right - 6, box.top - 1, 1, -1))
        if place.port:
            word = PORTS.get(place.port.lower(), place.port)
            corner = Corner(box.left + 8, box.bottom - 2, -1, 1)
            self.tag(owner, "port", word, place.port_layout, corner, f"port: {word}")
        if place.fusion:
            corner = Corner(box.left + 8, box.top + 2, -1, -1)
            title = f"fusion set: {place.fusion}"
            self.tag(owner, "fusion", place.fusion, place.fusion_layout, corner, title)

    def transition(self, t: RawTransition) -> None:
        """Texts and the tag of a transition."""
        box, owner = self.nodes[t.id].box, t.id
        self.label(owner, "guard", t.guard, Corner(box.left, box.top - 1, -1, -1))
        self.label(owner, "delay", t.delay, Corner(box.right, box.top - 1, 1, -1))
        self.label(owner, "code", t.code, Corner(box.right, box.bottom + 1, 1, 1))
        self.label(owner, "priority", t.priority, Corner(box.left, box.bottom + 1, -1, 1))
        self.label(
            owner, "channel", t.channel, Corner(box.right + 2, (box.top + box.bottom) / 2, 1, 0)
        )
        if t.substitution:
            word = self.page_name(t.substitution.subpage)
            corner = Corner((box.left + box.right) / 2, box.bottom + 3, 0, 1)
            title = f"stands for page {word}"
            link = t.substitution.subpage
            self.tag(owner, "subpage", word, t.substitution.layout, corner, title, link)

    def label(self, owner: str, kind: str, i: Inscription | None, corner: Corner) -> None:
        """An inscription, at its own position, or else at the corner."""
        if i is None or "".join(i.text.text.split()) in HIDDEN:
            return
        block = text.lines(i.text.text)
        w, h = text.extent(block, i.layout.bold)
        if self.without_position(i.layout):
            box = corner.box(w, h)
        else:
            box = around(round(i.layout.x), -round(i.layout.y), w, h)
        title = f"{i.text.origin.part}: {i.text.text}"
        self.labels.append(Label(owner, kind, block, box, i.layout, title, i.text.origin.part))

    def without_position(self, layout: Layout) -> bool:
        """Whether a text needs a position of ours."""
        if self.arranged or not layout.known:
            return True
        return self.nowhere and layout.x == 0 == layout.y

    def tag(
        self,
        owner: str,
        kind: str,
        word: str,
        layout: Layout,
        corner: Corner,
        title: str,
        link: str = "",
    ) -> None:
        """A tag, as wide as its word."""
        word = text.clean(word)
        w, h = text.width(word) + 6, text.LINE
        lost = layout.x == 0 == layout.y and not around(0, 0, _FAR, _FAR).holds(
            self.nodes[owner].centre
        )
        if self.arranged or not layout.known or lost:
            box = corner.box(w, h)
        else:
            box = around(round(layout.x), -round(layout.y), w, h)
        box = _off(box, self.nodes[owner])
        self.tags.append(Tag(owner, kind, word, box, title, link))

    def incidences(self) -> list[tuple[RawArc, tuple[Point, Point], float]]:
        """The arcs, each with the points inside transition and place that it heads for.

        The number says how far it is from the middle of those that run side by side: 0, or -0.5 and 0.5, ...
        """
        arcs = [
            a
            for a in (*self.page.arcs, *self.page.undirected)
            if a.transition in self.nodes and a.place in self.nodes
        ]
        straight: dict[tuple[str, str], list[RawArc]] = {}
        for arc in arcs:
            if not self.bends(arc):
                straight.setdefault((arc.transition, arc.place), []).append(arc)
        found = []
        for arc in arcs:
            t, p = self.nodes[arc.transition], self.nodes[arc.place]
            siblings = sorted(straight.get((t.id, p.id), ()), key=lambda a: -a.order)
            bends = self.bends(arc)
            if bends:
                found.append((arc, (_beside(t, bends[0]), _beside(p, bends[-1])), 0.0))
            else:
                side = siblings.index(arc) - (len(siblings) - 1) / 2
                ends = _shifted(t.centre, p.centre, side * SIBLING_DISTANCE)
                found.append((arc, ends, side))
        return found

    def bends(self, arc: RawArc) -> tuple[Point, ...]:
        """Bend points from the transition to the place."""
        if self.arranged:
            return self.arranged.bends.get(arc.id, ())
        points = [(float(round(x)), float(-round(y))) for x, y in arc.layout.bends]
        # A bend inside the node at its end would put the arrow head there, too.
        while points and self.nodes[arc.transition].box.grown(-1).holds(points[0]):
            del points[0]
        while points and self.nodes[arc.place].box.grown(-1).holds(points[-1]):
            del points[-1]
        return tuple(points)

    def line(self, arc: RawArc, ends: tuple[Point, Point], side: float) -> Line:
        """An arc and its inscription."""
        t, p = self.nodes[arc.transition], self.nodes[arc.place]
        bends = self.bends(arc)
        start = enter(bends[0] if bends else ends[1], ends[0], t.box, t.round)
        end = enter(bends[-1] if bends else ends[0], ends[1], p.box, p.round)
        points = (start, *bends, end)
        middle = along(points, min(max(0.5 + 0.15 * side, 0.1), 0.9))
        self.label(arc.id, "inscription", arc.inscription, Corner(middle[0] + 4, middle[1], 1, -1))
        written = f": {arc.inscription.text.text}" if arc.inscription else ""
        return Line(arc.id, arc.orientation, points, arc.layout, f"{arc_title(arc, t, p)}{written}")

    def auxiliary(self, aux: RawAux) -> Shape | None:
        """A free text becomes a label; a shape is given back."""
        at = (round(aux.layout.x), -round(aux.layout.y))
        block = text.lines(aux.text) if aux.text else ()
        if aux.layout.shape not in ("box", "ellipse"):
            if block:
                w, h = text.extent(block, aux.layout.bold)
                top = at[1] - text.ASCENT
                box = Box(at[0], top, at[0] + w, top + h)
                self.labels.append(Label(aux.id, "aux", block, box, aux.layout, ""))
            return None
        box = around(*at, aux.layout.width, aux.layout.height)
        is_round = aux.layout.shape == "ellipse"
        return Shape(aux.id, "aux", box, is_round, aux.layout, block, "")

    def notes(self, auxiliaries: Iterable[RawAux], lines: list[Line]) -> None:
        """Free texts below a page that is arranged anew."""
        boxes = [s.box for s in self.nodes.values()] + [of_points(line.points) for line in lines]
        whole = union([*boxes, *(label.box for label in self.labels)])
        y = whole.bottom + 3 * text.LINE
        for aux in auxiliaries:
            if aux.text:
                block = text.lines(aux.text)
                w, h = text.extent(block, aux.layout.bold)
                box = Box(whole.left, y, whole.left + w, y + h)
                self.labels.append(Label(aux.id, "aux", block, box, aux.layout, ""))
                y += h + text.LINE

    def token(self, place: RawPlace) -> tuple[Point, Point]:
        """Where the bubble with the number of tokens begins, and how far from the bubble its marking does.

        Both are points at half height on the left. The file has the distance from CPN Tools' place for each: 5 beside
        the place, and 5 beside the bubble.
        """
        box = self.nodes[place.id].box
        x, y = box.right + 5, (box.top + box.bottom) / 2
        if self.arranged or not place.token.known:
            return (x + DEFAULT_TOKEN, y), (5.0, 0.0)
        at = (x + place.token.x, y - place.token.y)
        return at, (5 + place.marking.x, -place.marking.y)


def _inscriptions(page: RawPage) -> Iterable[Inscription]:
    for place in page.places:
        yield from (i for i in (place.type, place.initial) if i)
    for t in page.transitions:
        yield from (i for i in (t.guard, t.delay, t.code, t.priority) if i)
    yield from (a.inscription for a in page.arcs if a.inscription)


def _off(tag: Box, node: Shape) -> Box:
    """A tag moved the least so that it does not hide the node's name, if a small step will do."""
    name = text_box(node)
    if not (node.caption and name.overlaps(tag)):
        return tag
    steps = [
        (name.right - tag.left, 0.0),
        (name.left - tag.right, 0.0),
        (0.0, name.bottom - tag.top),
        (0.0, name.top - tag.bottom),
    ]
    dx, dy = min(steps, key=lambda step: abs(step[0]) + abs(step[1]))
    if abs(dx) + abs(dy) > _STEP:
        return tag
    return Box(tag.left + dx, tag.top + dy, tag.right + dx, tag.bottom + dy)


def _beside(node: Shape, bend: Point) -> Point:
    """Where an arc from a bend heads for: straight on when the bend is beside, above or below the node."""
    x, y = node.centre
    if not node.box.left <= bend[0] <= node.box.right and node.box.top < bend[1] < node.box.bottom:
        return x, bend[1]
    if not node.box.top <= bend[1] <= node.box.bottom and node.box.left < bend[0] < node.box.right:
        return bend[0], y
    return x, y


def _shifted(t: Point, p: Point, shift: float) -> tuple[Point, Point]:
    """Both ends moved to the side of the line between them."""
    dx, dy = p[0] - t[0], p[1] - t[1]
    length = (dx * dx + dy * dy) ** 0.5
    if shift == 0 or length == 0:
        return t, p
    x, y = -dy / length * shift, dx / length * shift
    return (t[0] + x, t[1] + y), (p[0] + x, p[1] + y)
