"""`Net`: a document whose references are resolved: pages, ports and sockets, fusion sets, declarations in order.

Texts are still texts. Ids remain the keys, since instances of pages are made only when the net is flattened.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin
from pn2code.net.flat import ArcKind
from pn2code.reading.document import Document, Inscription, Layout, RawDeclaration


@frozen
class Place:
    """A place; `port` is "in", "out", "io" or "", `fusion` the name of its fusion set or ""."""

    id: str
    name: str
    colset: Inscription | None
    initial_marking: Inscription | None
    port: str
    fusion: str
    origin: Origin
    layout: Layout = Layout()


@frozen
class Arc:
    """An arc between a place (by id) of its page and the transition that has it."""

    id: str
    kind: ArcKind
    place: str
    inscription: Inscription | None
    origin: Origin
    layout: Layout = Layout()


@frozen
class Transition:
    """An ordinary transition with its arcs in the order of the file; default texts (`[]`, `@+`) count as absent."""

    id: str
    name: str
    guard: Inscription | None
    delay: Inscription | None
    code: Inscription | None
    priority: Inscription | None
    arcs: tuple[Arc, ...]
    origin: Origin
    layout: Layout = Layout()


@frozen
class PortSocket:
    """A port place of the subpage is the same place as the socket beside the substitution transition (ids)."""

    port: str
    socket: str


@frozen
class SubstitutionTransition:
    """Stands for the page with id `subpage`."""

    id: str
    name: str
    subpage: str
    ports: tuple[PortSocket, ...]
    origin: Origin
    layout: Layout = Layout()


@frozen
class Page:
    """A page."""

    id: str
    name: str
    places: tuple[Place, ...]
    transitions: tuple[Transition, ...]
    substitutions: tuple[SubstitutionTransition, ...]
    origin: Origin


@frozen
class FusionSet:
    """All members (place ids) are one place, in all instances of their pages."""

    id: str
    name: str
    members: tuple[str, ...]
    origin: Origin


@frozen
class Net:
    """A linked net.

    Args:
        document: where it came from (layout, monitors and options are there).
        declarations: in order of evaluation, blocks opened.
        pages: in order of the file.
        prime_pages: ids of the pages that are nobody's subpage.
        fusions: in order of the file.
        real_time: the clock is real.
        blocks: of the ML declarations that stand in a named block, by their origin: its name, "Outer/Inner".
    """

    document: Document
    declarations: tuple[RawDeclaration, ...]
    pages: tuple[Page, ...]
    prime_pages: tuple[str, ...]
    fusions: tuple[FusionSet, ...]
    real_time: bool
    blocks: Mapping[Origin, str] = field(default_factory=dict)

    def page(self, identity: str) -> Page:
        """A page by id."""
        return next(p for p in self.pages if p.id == identity)
