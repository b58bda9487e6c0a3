"""`Document`: what a `.cpn` file says, before anything is resolved.

Texts keep their positions (`SourceText`), layout is kept for drawing, nothing is interpreted.
"""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin, SourceText


@frozen
class Layout:
    """Where a thing stands on its page, in CPN Tools units (y grows upwards).

    Args:
        x, y: centre (of labels: centre of the text).
        width, height: size; 0 when unknown.
        bends: bend points of an arc, from the transition end to the place end.
        colour: line colour name, e.g. "Black".
        fill: fill colour name, empty when not filled.
        text_colour: text colour name.
        shape: "ellipse", "box", "label", "".
        thickness: line thickness.
        line: how the line is drawn: "solid", "dashed", "dotted" or "" as the file says, lower case.
        bold: whether the text is bold.
        head: size of an arc's arrow heads, 1.0 is normal.
        hidden: whether CPN Tools hides it (the marking of a place).
        known: whether the file says where it stands.
    """

    x: float = 0.0
    y: float = 0.0
    width: float = 0.0
    height: float = 0.0
    bends: tuple[tuple[float, float], ...] = ()
    colour: str = ""
    fill: str = ""
    text_colour: str = ""
    shape: str = ""
    thickness: float = 1.0
    line: str = ""
    bold: bool = False
    head: float = 1.0
    hidden: bool = False
    known: bool = False


@frozen
class Inscription:
    """A text of the net with its XML id and position; whitespace-only texts are absent (None), not empty."""

    text: SourceText
    layout: Layout = Layout()


@frozen
class RawPlace:
    """`place`.

    Args:
        caption: the name with its line breaks, as drawn.
        port_layout, fusion_layout: of the tags.
        token, marking: of the number of tokens and of the marking, relative to where CPN Tools puts them.
    """

    id: str
    name: str
    type: Inscription | None
    initial: Inscription | None
    port: str
    fusion: str
    origin: Origin
    layout: Layout = Layout()
    caption: str = ""
    port_layout: Layout = Layout()
    fusion_layout: Layout = Layout()
    token: Layout = Layout()
    marking: Layout = Layout()


@frozen
class RawSubstitution:
    """`subst`: the page it stands for and the (port id, socket id) pairs."""

    subpage: str
    portsock: tuple[tuple[str, str], ...]
    origin: Origin
    layout: Layout = Layout()


@frozen
class RawTransition:
    """`trans`; `caption` is the name with its line breaks, as drawn."""

    id: str
    name: str
    guard: Inscription | None
    delay: Inscription | None
    code: Inscription | None
    priority: Inscription | None
    channel: Inscription | None
    substitution: RawSubstitution | None
    origin: Origin
    layout: Layout = Layout()
    caption: str = ""


@frozen
class RawArc:
    """`arc`; orientation as in the file, lower case. `order` sorts arcs drawn side by side."""

    id: str
    orientation: str
    transition: str
    place: str
    inscription: Inscription | None
    origin: Origin
    layout: Layout = Layout()
    order: int = 0


@frozen
class RawAux:
    """`Aux`: a free text or shape of the page, for drawing."""

    id: str
    text: str
    layout: Layout = Layout()


@frozen
class RawPage:
    """`page`; `undirected` are Design/CPN's arcs without direction, which are only drawn."""

    id: str
    name: str
    places: tuple[RawPlace, ...]
    transitions: tuple[RawTransition, ...]
    arcs: tuple[RawArc, ...]
    auxiliaries: tuple[RawAux, ...]
    origin: Origin
    undirected: tuple[RawArc, ...] = ()

    @property
    def nodes(self) -> tuple[RawPlace | RawTransition, ...]:
        """Places and transitions."""
        return (*self.places, *self.transitions)


@frozen
class RawColset:
    """`color`: the structure that the file gives, texts not yet parsed.

    Args:
        kind: tag of the definition: "unit", "int", "enum", "product", "record", "list", "alias",
        ... or "" if none is known.
        ids: the ids of the definition in order: enum values, product components, list base, alias
        base, unit/bool names, index stem.
        fields: record fields and union fields as (label, type or "").
        texts: the `ml` texts in order: ranges, subset predicate or list.
        timed: `<timed/>`.
        declare: `<declare>` ids.
        layout_text: what CPN Tools shows (`colset INT = int;`), for messages and carets; may be absent.
    """

    id: str
    name: str
    kind: str
    ids: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]
    texts: tuple[SourceText, ...]
    timed: bool
    declare: tuple[str, ...]
    by_predicate: bool
    layout_text: str
    origin: Origin


@frozen
class RawVar:
    """`var x, y : TYPE`."""

    id: str
    names: tuple[str, ...]
    type: str
    origin: Origin


@frozen
class RawMl:
    """`ml`: a CPN ML declaration as text."""

    id: str
    text: SourceText
    origin: Origin


@frozen
class RawGlobref:
    """`globref x = exp`."""

    id: str
    name: str
    text: SourceText
    origin: Origin


@frozen
class RawUse:
    """`use "file"`."""

    id: str
    text: SourceText
    origin: Origin


@frozen
class RawOther:
    """A declaration of a kind that is not known (an old raw `errordecl`, a channel)."""

    id: str
    tag: str
    text: SourceText
    origin: Origin


RawDeclaration = RawColset | RawVar | RawMl | RawGlobref | RawUse | RawOther


@frozen
class RawBlock:
    """A named block of declarations; blocks nest, order matters."""

    name: str
    items: tuple[RawBlock | RawDeclaration, ...]


@frozen
class RawFusion:
    """`fusion`: a fusion set and the ids of its places."""

    id: str
    name: str
    members: tuple[str, ...]
    origin: Origin


@frozen
class RawMonitor:
    """`monitor`: kept as it is."""

    id: str
    name: str
    type: str
    disabled: bool
    nodes: tuple[tuple[str, str], ...]
    declarations: tuple[tuple[str, SourceText], ...]
    options: tuple[tuple[str, str], ...]
    origin: Origin


@frozen
class RawInstance:
    """`instance` of a page: of a prime page (`page`), or below another instance by a substitution `transition`."""

    id: str
    page: str
    transition: str
    below: tuple[RawInstance, ...]


@frozen
class Document:
    """A whole file.

    Args:
        file: path as given.
        sha256: of the bytes.
        tool, version, format: the generator.
        blocks: top-level declarations (the globbox as one block).
        options: name to text.
        elements: how many `pages`, `places`, `transitions` (substitution transitions are counted) and `arcs` the file
            has.
        instances: the page instances that the file lists, for what refers to them (monitors).
        unread: the words of lines that cannot be read: names among them may be declared there.
    """

    file: str
    sha256: str
    tool: str
    version: str
    format: str
    globbox: RawBlock
    pages: tuple[RawPage, ...]
    fusions: tuple[RawFusion, ...]
    monitors: tuple[RawMonitor, ...] = ()
    options: dict[str, str] = field(default_factory=dict)
    elements: dict[str, int] = field(default_factory=dict)
    instances: tuple[RawInstance, ...] = ()
    unread: frozenset[str] = frozenset()
