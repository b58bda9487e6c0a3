"""Pages as SVG.

    draw_page(document, page)                                   # as the author laid it out
    draw_page(document, page, marking={"ID7": Tokens(3, "3`1")}, enabled={"ID9"})
    draw_page(document, page, highlight={"ID9": "#ff8800"}, problems={"ID12": [Problem("too big")]})

Every place is a `<g class="place">`, every transition a `<g class="transition">` (or `substitution`), every arc a
`<g class="arc">`, each once and with its id of the file in `data-id`; tool tips are `<title>`. Nothing outside the file
is referred to. Same input, same bytes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.drawing import text
from pn2code.drawing.geometry import Box, Point, around, towards, union
from pn2code.drawing.scene import build
from pn2code.drawing.shapes import Label, Line, Scene, Shape, Tag, text_box
from pn2code.drawing.style import (
    ENABLED,
    PROBLEM,
    TAG_FILL,
    TAG_LINE,
    TOKEN_FILL,
    TOKEN_LINE,
    colour,
    dash,
)
from pn2code.reading.document import Document, RawPage

MARGIN = 12.0
CURVE = 15.0
"""CPN Tools rounds bends by this radius."""
_HEAD, _HALF_HEAD = 9.0, 3.5
_CIRCLE = 4.0
BUBBLE = 8.0
MARKING_LINES, MARKING_WIDTH = 20, 60
_HEADING = 26.0


@frozen
class Links:
    """Where things lead to and how they can be reached.

    Args:
        page: the address of a page, by id; "" for no link.
        element: the `id` attribute of an element, by its id in the file; "" for none.
        tag: the address behind the tag of an element, by kind of the tag and id of the element.
    """

    page: Callable[[str], str] = lambda identity: ""
    element: Callable[[str], str] = lambda identity: ""
    tag: Callable[[str, str], str] = lambda kind, identity: ""


@frozen
class Tokens:
    """What a place holds: how many tokens, and the marking as text."""

    count: int
    marking: str


@frozen
class Problem:
    """What is wrong with an element; `part` is the part of an inscription's origin ("guard"), or ""."""

    message: str
    part: str = ""


@frozen
class Overlay:
    """What is drawn over a page.

    Args:
        marking: by place id.
        enabled: ids of transitions with a green border.
        highlight: colour by element id.
        problems: by element id; shown in red, the message as a tool tip.
    """

    marking: Mapping[str, Tokens] = field(default_factory=dict)
    enabled: Collection[str] = frozenset()
    highlight: Mapping[str, str] = field(default_factory=dict)
    problems: Mapping[str, Sequence[Problem]] = field(default_factory=dict)


def draw_page(
    document: Document,
    page: RawPage,
    *,
    marking: Mapping[str, Tokens] | None = None,
    enabled: Collection[str] = (),
    highlight: Mapping[str, str] | None = None,
    problems: Mapping[str, Sequence[Problem]] | None = None,
    links: Links = Links(),  # noqa: B008 - frozen
) -> str:
    """One page as an SVG document; the arguments are those of `Overlay` and `Links`."""
    overlay = Overlay(marking or {}, enabled, highlight or {}, problems or {})
    return page_svg(document, page, overlay, links)


def page_svg(
    document: Document,
    page: RawPage,
    overlay: Overlay,
    links: Links = Links(),  # noqa: B008 - frozen
) -> str:
    """One page with an overlay as an SVG document."""
    body, box = figure(build(document, page), overlay, links)
    return _document(box.grown(MARGIN), page.name, body)


def draw_pages(
    document: Document,
    pages: Sequence[tuple[RawPage, Overlay]],
) -> str:
    """Several pages as one SVG document, one below the other with headings; substitution transitions link to them."""
    numbers = {page.id: i for i, (page, _) in enumerate(pages, 1)}
    rows: list[str] = []
    boxes: list[Box] = []
    top = 0.0
    for page, overlay in pages:
        body, box = figure(
            build(document, page),
            overlay,
            Links(lambda identity: f"#page-{numbers[identity]}" if identity in numbers else ""),
        )
        dx, dy = -box.left, top + _HEADING - box.top
        number = numbers[page.id]
        w = max(box.width, text.width(page.name, bold=True) * 1.4)
        rows.append(f'<g id="page-{number}" class="page" data-page="{text.attribute(page.name)}">')
        rows.append(
            f'<text class="heading" x="0" y="{_n(top + 12)}" font-size="18" font-weight="bold">'
            f"{text.escape(page.name)}</text>"
        )
        rows.append(f'<g transform="translate({_n(dx)} {_n(dy)})">')
        rows += body
        rows.append("</g>\n</g>")
        boxes.append(Box(0, top - 6, w, top + _HEADING + box.height))
        top += _HEADING + box.height + 3 * _HEADING
    title = ", ".join(page.name for page, _ in pages)
    return _document(union(boxes).grown(MARGIN), text.shorten(title, 1, 200), rows)


def figure(scene: Scene, overlay: Overlay, links: Links) -> tuple[list[str], Box]:
    """The elements of a page without the `svg` around them, and the box around them."""
    painter = _Painter(overlay, links)
    for shape in scene.shapes:
        if shape.kind == "aux":
            painter.shape(shape)
    for line in scene.lines:
        painter.line(line)
    for shape in scene.shapes:
        if shape.kind != "aux":
            painter.shape(shape)
    for tag in scene.tags:
        painter.tag(tag)
    painter.rows += painter.late
    for label in scene.labels:
        painter.label(label)
    for identity, tokens in overlay.marking.items():
        if identity in scene.tokens and tokens.count:
            hidden = identity in scene.hidden
            painter.tokens(tokens, scene.tokens[identity], scene.markings[identity], hidden)
    return painter.rows, union([scene.bounds(), *painter.boxes])


def svg_attributes(box: Box) -> str:
    """`viewBox`, size and font of an `svg` element that shows a box."""
    return (
        f'viewBox="{_n(box.left)} {_n(box.top)} {_n(box.width)} {_n(box.height)}" '
        f'width="{_n(box.width)}" height="{_n(box.height)}" '
        f'font-family="{text.FAMILY}" font-size="{_n(text.SIZE)}"'
    )


def _document(box: Box, title: str, body: Sequence[str]) -> str:
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<svg xmlns="http://www.w3.org/2000/svg" {svg_attributes(box)}>',
            f"<title>{text.escape(title)}</title>",
            f'<rect x="{_n(box.left)}" y="{_n(box.top)}" width="{_n(box.width)}" '
            f'height="{_n(box.height)}" fill="#ffffff"/>',
            *body,
            "</svg>\n",
        ]
    )


class _Painter:
    """Writes elements, and collects the boxes of what the scene does not know."""

    def __init__(self, overlay: Overlay, links: Links) -> None:
        self.overlay = overlay
        self.links = links
        self.rows: list[str] = []
        self.late: list[str] = []
        self.boxes: list[Box] = []

    def title(self, words: str, identity: str) -> str:
        """A tool tip, the messages about the element first."""
        messages = [f"error: {p.message}" for p in self.overlay.problems.get(identity, ())]
        words = "\n".join([*messages, words]) if words else "\n".join(messages)
        return f"<title>{text.escape(words)}</title>" if words else ""

    def halo(self, identity: str) -> str:
        """The colour of the border around an element, "" for none."""
        if identity in self.overlay.problems:
            return PROBLEM
        if identity in self.overlay.highlight:
            return colour(self.overlay.highlight[identity], "#ff8800")
        return ENABLED if identity in self.overlay.enabled else ""

    def group(
        self, kind: str, identity: str, content: Sequence[str], link: str = "", anchor: str = ""
    ) -> None:
        """A `g` for an element; inside a link if there is one."""
        extra = ""
        if kind.split()[0] not in ("label", "tag"):
            extra += " problem" if identity in self.overlay.problems else ""
            extra += " enabled" if identity in self.overlay.enabled else ""
        inner = "".join(content)
        if link:
            inner = f'<a href="{text.attribute(link)}">{inner}</a>'
        named = f' id="{text.attribute(anchor)}"' if anchor else ""
        self.rows.append(
            f'<g{named} class="{kind}{extra}" data-id="{text.attribute(identity)}">{inner}</g>'
        )

    def shape(self, shape: Shape) -> None:
        """A place, a transition or a shape of an auxiliary."""
        at, box = shape.layout, shape.box
        line = colour(at.colour)
        thick = max(at.thickness, 0.75)
        filling = colour(at.fill, "#ffffff") if at.fill else "#ffffff"
        if shape.kind == "aux" and not at.fill:
            filling = "none"
        rows = [self.title(shape.title, shape.id)]
        halo = self.halo(shape.id)
        if halo != ENABLED and shape.id in self.overlay.enabled:
            outer = box.grown(thick / 2 + 4.5)
            rows.append(_outline(shape.round, outer, ENABLED, 2.5, "none", ""))
            self.boxes.append(outer.grown(1.5))
        if halo:
            rows.append(_outline(shape.round, box.grown(thick / 2 + 1.5), halo, 4.0, "none", ""))
            self.boxes.append(box.grown(thick / 2 + 4))
        rows.append(_outline(shape.round, box, line, thick, filling, dash(at.line)))
        if shape.kind == "substitution":
            inner = box.grown(-4)
            if inner.width > 0 and inner.height > 0:
                rows.append(_outline(shape.round, inner, line, 1.0, "none", dash(at.line)))
        self.boxes.append(box.grown(thick))
        if shape.caption:
            name = _text(shape.caption, shape.centre, colour(at.text_colour), at.bold, centred=True)
            if box.contains(text_box(shape)):
                rows.append(name)
            else:  # above the arrow heads around the node
                self.late.append(f'<g class="name">{name}</g>')
        link = self.links.page(shape.link) if shape.link else ""
        self.group(shape.kind, shape.id, rows, link, self.links.element(shape.id))

    def line(self, line: Line) -> None:
        """An arc with its heads."""
        at, points = line.layout, line.points
        ink, thick = colour(at.colour), max(at.thickness, 0.75)
        size = min(max(at.head, 0.3), 6.0) * (1 + (thick - 1) / 4)
        head, half = _HEAD * size, _HALF_HEAD * size
        at_transition = line.kind in ("ptot", "bothdir", "reset")
        at_place = line.kind in ("ttop", "bothdir")
        heads: list[str] = []
        path = list(points)
        if at_transition and path[0] != path[1]:
            heads.append(_triangle(points[0], points[1], head, half, ink))
            path[0] = _shortened(points[0], points[1], head - 1)
            if line.kind == "reset":
                second = _shortened(points[0], points[1], head * 0.8)
                heads.append(_triangle(second, points[1], head, half, ink))
                path[0] = _shortened(points[0], points[1], head * 1.8 - 1)
        if at_place and path[-1] != path[-2]:
            heads.append(_triangle(points[-1], points[-2], head, half, ink))
            path[-1] = _shortened(points[-1], points[-2], head - 1)
        if line.kind == "inhibitor":
            radius = _CIRCLE * size
            x, y = towards(points[0], points[1], radius)
            heads.append(
                f'<circle cx="{_n(x)}" cy="{_n(y)}" r="{_n(radius)}" fill="#ffffff" stroke="{ink}" '
                f'stroke-width="{_n(thick)}"/>'
            )
            path[0] = _shortened(points[0], points[1], 2 * radius)
        rows = [self.title(line.title, line.id)]
        halo = self.halo(line.id)
        drawn = _path(path)
        if halo:
            rows.append(
                f'<path d="{drawn}" fill="none" stroke="{halo}" stroke-width="{_n(thick + 5)}" '
                'stroke-opacity="0.6" stroke-linecap="round"/>'
            )
        # A broad invisible line makes the tool tip easy to reach.
        rows.append(
            f'<path d="{_path(list(points))}" fill="none" stroke="#000000" stroke-opacity="0" '
            'stroke-width="9" pointer-events="stroke"/>'
        )
        dashes = dash(at.line)
        rows.append(
            f'<path d="{drawn}" fill="none" stroke="{ink}" stroke-width="{_n(thick)}"'
            + (f' stroke-dasharray="{dashes}"' if dashes else "")
            + "/>"
        )
        # Above tags, which often lie at the edges of nodes, where arcs end.
        self.late.append(f'<g class="head">{"".join(heads)}</g>')
        self.boxes += [around(*p, 2 * half + 4, 2 * half + 4) for p in (points[0], points[-1])]
        self.group(f"arc {line.kind}", line.id, rows)

    def label(self, label: Label) -> None:
        """An inscription or a free text."""
        at = label.layout
        centre = ((label.box.left + label.box.right) / 2, (label.box.top + label.box.bottom) / 2)
        wrong = label.part and any(
            p.part == label.part for p in self.overlay.problems.get(label.owner, ())
        )
        ink = PROBLEM if wrong else colour(at.text_colour)
        rows = [self.title(label.title, label.owner if wrong else "")]
        rows.append(_text(label.lines, centre, ink, at.bold, centred=False, box=label.box))
        self.group(f"label {label.kind}", label.owner, rows)

    def tag(self, tag: Tag) -> None:
        """A tag: a framed word."""
        centre = ((tag.box.left + tag.box.right) / 2, (tag.box.top + tag.box.bottom) / 2)
        rows = [
            self.title(tag.title, ""),
            _outline(False, tag.box, TAG_LINE, 1.0, TAG_FILL, ""),
            _text((tag.word,), centre, TAG_LINE, False, centred=True, halo=False),
        ]
        self.boxes.append(tag.box.grown(1))
        link = self.links.page(tag.link) if tag.link else self.links.tag(tag.kind, tag.owner)
        self.group(f"tag {tag.kind}", tag.owner, rows, link)

    def tokens(self, tokens: Tokens, at: Point, offset: Point, hidden: bool) -> None:
        """The green bubble with the number of tokens, and beside it the marking unless it is hidden."""
        number = str(tokens.count)
        radius = max(BUBBLE, text.width(number) / 2 + 2)
        at = (at[0] + radius, at[1])
        rows = [self.title(text.shorten(tokens.marking, 60, 300), "")]
        if not hidden:
            shown = text.shorten(tokens.marking, MARKING_LINES, MARKING_WIDTH)
            block = text.lines(shown)
            w, h = text.extent(block)
            left = at[0] + radius + offset[0]
            y = at[1] + offset[1]
            box = Box(left, y - h / 2 - 1, left + w + 6, y + h / 2 + 1)
            rows.append(_outline(False, box, TOKEN_LINE, 0.75, TOKEN_FILL, "", opacity=0.85))
            centre = (left + 3 + w / 2, y)
            inner = Box(left + 3, y - h / 2, left + 3 + w, y + h / 2)
            rows.append(
                _text(block, centre, "#000000", False, centred=False, box=inner, halo=False)
            )
            self.boxes.append(box.grown(1))
        rows.append(
            f'<circle cx="{_n(at[0])}" cy="{_n(at[1])}" r="{_n(radius)}" fill="{TOKEN_FILL}" '
            f'stroke="{TOKEN_LINE}"/>'
        )
        rows.append(_text((number,), at, "#000000", False, centred=True, halo=False))
        self.boxes.append(around(*at, 2 * radius + 2, 2 * radius + 2))
        self.rows.append(f'<g class="tokens">{"".join(rows)}</g>')


def _outline(
    is_round: bool, box: Box, line: str, thick: float, fill: str, dashes: str, opacity: float = 1.0
) -> str:
    style = f'fill="{fill}" stroke="{line}" stroke-width="{_n(thick)}"'
    if dashes:
        style += f' stroke-dasharray="{dashes}"'
    if opacity < 1:
        style += f' fill-opacity="{_n(opacity)}"'
    if is_round:
        x, y = (box.left + box.right) / 2, (box.top + box.bottom) / 2
        return (
            f'<ellipse cx="{_n(x)}" cy="{_n(y)}" rx="{_n(box.width / 2)}" ry="{_n(box.height / 2)}" '
            f"{style}/>"
        )
    return (
        f'<rect x="{_n(box.left)}" y="{_n(box.top)}" width="{_n(box.width)}" '
        f'height="{_n(box.height)}" {style}/>'
    )


def _text(
    block: Sequence[str],
    centre: Point,
    ink: str,
    bold: bool,
    *,
    centred: bool,
    box: Box | None = None,
    halo: bool = True,
) -> str:
    """Lines of text around a centre; `centred` lines, or else lines that begin at the left of the box."""
    x = centre[0] if centred or box is None else box.left
    style = ' text-anchor="middle"' if centred else ""
    style += ' font-weight="bold"' if bold else ""
    if halo and ink != "#ffffff":
        # A white edge keeps text readable where it lies on a line.
        style += ' stroke="#ffffff" stroke-width="2" stroke-opacity="0.6" stroke-linejoin="round"'
        style += ' paint-order="stroke"'
    top = centre[1] - text.LINE * len(block) / 2
    spans = []
    for i, line in enumerate(block):
        if not line.strip():
            continue
        y = top + text.LINE * (i + 0.5) + text.SIZE * 0.35
        # The length keeps a text as wide as its author saw it, whatever font there is.
        length = f' textLength="{_n(text.width(line, bold))}" lengthAdjust="spacingAndGlyphs"'
        spans.append(
            f'<tspan x="{_n(x)}" y="{_n(y)}"{length if len(line) > 1 else ""}>{text.escape(line)}</tspan>'
        )
    return f'<text fill="{ink}"{style} xml:space="preserve">{"".join(spans)}</text>'


def _path(points: list[Point]) -> str:
    """A line through points, its bends rounded."""
    steps = [f"M{_n(points[0][0])} {_n(points[0][1])}"]
    for before, at, after in zip(points, points[1:], points[2:], strict=False):
        radius = min(CURVE, math.dist(before, at) / 2, math.dist(at, after) / 2)
        a, b = towards(at, before, radius), towards(at, after, radius)
        steps.append(f"L{_n(a[0])} {_n(a[1])}Q{_n(at[0])} {_n(at[1])} {_n(b[0])} {_n(b[1])}")
    steps.append(f"L{_n(points[-1][0])} {_n(points[-1][1])}")
    return "".join(steps)


def _shortened(end: Point, before: Point, by: float) -> Point:
    """The end of a line moved back, at most to its middle."""
    return towards(end, before, min(by, math.dist(end, before) / 2))


def _triangle(tip: Point, tail: Point, length: float, half: float, ink: str) -> str:
    """An arrow head."""
    d = math.dist(tip, tail)
    ux, uy = (tail[0] - tip[0]) / d, (tail[1] - tip[1]) / d
    bx, by = tip[0] + ux * length, tip[1] + uy * length
    corners = (tip, (bx - uy * half, by + ux * half), (bx + uy * half, by - ux * half))
    return f'<polygon points="{" ".join(f"{_n(x)},{_n(y)}" for x, y in corners)}" fill="{ink}"/>'


def _n(value: float) -> str:
    """A number with at most one decimal."""
    shown = f"{value:.1f}"
    return "0" if shown == "-0.0" else shown.removesuffix(".0")
