"""What a page consists of when it is drawn: shapes, lines, labels, tags. Lengths in points, y grows downwards."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.drawing import text
from pn2code.drawing.geometry import Box, Point, around, of_points, union
from pn2code.reading.document import Layout


@frozen
class Shape:
    """A place, a transition, or a shape of an auxiliary.

    Args:
        kind: "place", "transition", "substitution" or "aux".
        round: an ellipse, else a box.
        caption: lines of the name.
        title: what a tool tip says.
        link: id of the page that a substitution transition stands for.
    """

    id: str
    kind: str
    box: Box
    round: bool
    layout: Layout
    caption: tuple[str, ...]
    title: str
    link: str = ""

    @property
    def centre(self) -> Point:
        """The centre."""
        return (self.box.left + self.box.right) / 2, (self.box.top + self.box.bottom) / 2


@frozen
class Line:
    """An arc; points from the transition's edge to the place's edge.

    Args:
        kind: the orientation: "ptot", "ttop", "bothdir", "inhibitor", "reset" or "nodir".
    """

    id: str
    kind: str
    points: tuple[Point, ...]
    layout: Layout
    title: str


@frozen
class Label:
    """A text in its box.

    Args:
        owner, kind: what of which element (id), e.g. "guard".
        part: the part of the inscription's origin, as in diagnostics.
    """

    owner: str
    kind: str
    lines: tuple[str, ...]
    box: Box
    layout: Layout
    title: str
    part: str = ""


@frozen
class Tag:
    """The framed word at a port ("In"), a fusion place (its set) or a substitution transition (its page)."""

    owner: str
    kind: str
    word: str
    box: Box
    title: str
    link: str = ""


@frozen
class Scene:
    """All of a page.

    Args:
        arranged: the positions are not the author's.
        tokens, markings: by place id; see `_Builder.token`.
        hidden: ids of places whose marking CPN Tools does not show, only the number.
    """

    page: str
    name: str
    shapes: tuple[Shape, ...]
    lines: tuple[Line, ...]
    labels: tuple[Label, ...]
    tags: tuple[Tag, ...]
    arranged: bool
    tokens: dict[str, Point] = field(default_factory=dict)
    markings: dict[str, Point] = field(default_factory=dict)
    hidden: frozenset[str] = frozenset()

    def bounds(self) -> Box:
        """The box around everything."""
        boxes = [s.box for s in self.shapes]
        boxes += [text_box(s) for s in self.shapes if s.caption]
        boxes += [of_points(line.points) for line in self.lines]
        boxes += [label.box for label in self.labels]
        boxes += [tag.box for tag in self.tags]
        return union(boxes)


def text_box(shape: Shape) -> Box:
    """The box of a node's name."""
    return around(*shape.centre, *text.extent(shape.caption, shape.layout.bold))


@frozen
class Corner:
    """Where a text goes that has no position: it touches (x, y) and lies right (`dx` 1), left (-1) or around it (0)."""

    x: float
    y: float
    dx: int
    dy: int

    def box(self, width: float, height: float) -> Box:
        """The box of a text of this size."""
        return around(self.x + self.dx * width / 2, self.y + self.dy * height / 2, width, height)
