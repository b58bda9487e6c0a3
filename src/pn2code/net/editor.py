"""What the editor of CPN Tools refuses, though the net has a meaning: warned of, since the net cannot be run there.

Each check says what the editor or the engine does with the net; all were asked.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.diagnostics import Diagnostics, Note
from pn2code.net import engine_ids, lonely_fusions
from pn2code.net.codes import NAME_NOT_UNIQUE, PORT_UNASSIGNED, SOCKET_ARCS, SOCKET_UNASSIGNED
from pn2code.net.engine_names import sent_name
from pn2code.net.linked import Page
from pn2code.reading.document import Document, RawPage, RawPlace, RawTransition

_PORT_TYPES = {"in": "In", "out": "Out", "i/o": "I/O"}


def warn(document: Document, pages: Iterable[Page], d: Diagnostics) -> None:
    """Warn of what the editor refuses.

    Args:
        document: the file; of a PNML file nothing is said.
        pages: the same, linked.
        d: gets the warnings.
    """
    if document.tool == "PNML":
        return
    linked = {p.id: p for p in pages}
    _pages(document, d)
    for page in document.pages:
        _names(page, page.places, "place", d)
        _names(page, page.transitions, "transition", d)
        for t in page.transitions:
            if t.substitution is not None:
                _sockets(page, t, linked, document, d)
    _ports(document, linked, d)
    lonely_fusions.warn(linked, d)
    engine_ids.warn(document, d)


def _names(
    page: RawPage, nodes: Iterable[RawPlace | RawTransition], kind: str, d: Diagnostics
) -> None:
    """Two places, or two transitions, of one name."""
    first: dict[str, RawPlace | RawTransition] = {}
    for node in nodes:
        sent = sent_name(node.caption)
        other = first.setdefault(sent, node)
        if sent and other is not node:
            both = f"one name, `{node.name}`"
            if node.name != other.name:
                both = f"the names `{other.name}` and `{node.name}`, both cut to `{sent}`"
            d.warning(
                NAME_NOT_UNIQUE,
                f"two {kind}s of page `{page.name}` have {both}: CPN Tools refuses the net (name not unique)",
                node.origin,
                notes=[Note("the first one is here", other.origin)],
                hint=f"give one of the {kind}s another name",
            )


def _pages(document: Document, d: Diagnostics) -> None:
    """Two pages of one name."""
    first: dict[str, RawPage] = {}
    for page in document.pages:
        sent = sent_name(page.name)
        other = first.setdefault(sent, page)
        if sent and other is not page:
            d.warning(
                NAME_NOT_UNIQUE,
                f"two pages have the same name, `{sent}`: CPN Tools refuses the net (name not unique)",
                page.origin,
                notes=[Note("the first one is here", other.origin)],
                hint="give one of the pages another name",
            )


def _sockets(
    page: RawPage, t: RawTransition, linked: dict[str, Page], document: Document, d: Diagnostics
) -> None:
    """Places beside a substitution transition that are no sockets, and sockets whose arcs do not suit the port."""
    own = {p.id: p for p in page.places}
    ways: dict[str, set[str]] = {}
    for arc in page.arcs:
        if arc.transition == t.id and arc.place in own:
            ways.setdefault(arc.place, set()).add(arc.orientation)
    me = next((s for s in linked[page.id].substitutions if s.id == t.id), None)
    if me is None or t.substitution is None:
        return  # its page does not exist, which has been said
    origin = t.substitution.origin
    assigned = {pair.socket for pair in me.ports}
    for place in ways:
        if place not in assigned:
            d.warning(
                SOCKET_UNASSIGNED,
                f"place `{own[place].name}` is connected to substitution transition `{t.name}`, "
                "but is not assigned to a port of its page; CPN Tools refuses the net",
                origin,
                notes=[Note("the place is here", own[place].origin)],
                hint="assign it to a port of the page",
            )
    target = next(p for p in document.pages if p.id == me.subpage)
    ports = {p.id: p for p in target.places}
    for pair in me.ports:
        wanted = _PORT_TYPES.get(ports[pair.port].port.lower())
        way = _way(ways.get(pair.socket, set()))
        if wanted is not None and way != wanted:
            arcs = f"has the arcs of a socket of type {way}" if way else "has no arc to it"
            d.warning(
                SOCKET_ARCS,
                f"port `{ports[pair.port].name}` is of type {wanted}, but its socket `{own[pair.socket].name}` "
                f"at `{t.name}` {arcs}: CPN Tools refuses the net",
                origin,
                notes=[Note("the port is declared here", ports[pair.port].origin)],
                hint="change the type of the port, or the arcs beside the substitution transition",
            )


def _way(orientations: set[str]) -> str:
    """The type of port that arcs between a place and a substitution transition suit; "" without arcs."""
    if "bothdir" in orientations or {"ptot", "ttop"} <= orientations:
        return "I/O"
    return "In" if "ptot" in orientations else "Out" if "ttop" in orientations else ""


def _ports(document: Document, linked: dict[str, Page], d: Diagnostics) -> None:
    """Ports without a socket: harmless if no instance of the page has one, else the engine cannot run the net."""
    origins = {
        t.id: t.substitution.origin
        for page in document.pages
        for t in page.transitions
        if t.substitution is not None
    }
    with_socket = {q.port for page in linked.values() for s in page.substitutions for q in s.ports}
    ports = {p.id: [q for q in p.places if q.port] for p in document.pages}
    for page in linked.values():
        for s in page.substitutions:
            assigned = {q.port for q in s.ports}
            for port in ports[s.subpage]:
                if port.id in assigned:
                    continue
                name = linked[s.subpage].name
                notes = [Note("the port is declared here", port.origin)]
                hint = "assign the port to a place beside the substitution transition"
                if port.id in with_socket:
                    d.warning(
                        PORT_UNASSIGNED,
                        f"port `{port.name}` of page `{name}` has no socket at `{s.name}`, but has one elsewhere: "
                        "CPN Tools cannot run such a net (its engine stops with the exception Subscript)",
                        origins[s.id],
                        notes=notes,
                        hint=f"{hint}; pn2code treats it as a separate place there",
                    )
                else:
                    d.note(
                        PORT_UNASSIGNED,
                        f"port `{port.name}` of page `{name}` has no socket at `{s.name}`",
                        origins[s.id],
                        notes=notes,
                        hint=hint,
                    )
