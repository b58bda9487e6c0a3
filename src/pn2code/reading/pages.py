"""Pages of a `.cpn` file: places, transitions, arcs and auxiliaries with texts, layout and origins."""

from __future__ import annotations

import re
from collections.abc import Callable, Set

from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.reading.codes import (
    ARC_DANGLING,
    ARC_ORIENTATION,
    CPN_ELEMENT,
    CPN_STRAY_TEXT,
    DUPLICATE_ID,
    UNSUPPORTED_CONSTRAINT,
)
from pn2code.reading.declarations import Warn
from pn2code.reading.document import (
    Inscription,
    Layout,
    RawArc,
    RawAux,
    RawPage,
    RawPlace,
    RawSubstitution,
    RawTransition,
)
from pn2code.reading.layout import Point, bends, layout, number, offset, point
from pn2code.reading.xml import Node

_DRAWING = {"posattr", "fillattr", "lineattr", "textattr", "text"}
_KNOWN = {
    "page": {
        "pageattr", "place", "trans", "arc", "Aux", "group", "vguideline", "hguideline", "constraints",
        "ssnode", "ssarc", "label", "aux-conn",
    },
    "place": _DRAWING | {"ellipse", "box", "token", "marking", "type", "initmark", "port", "fusioninfo"},
    "trans": _DRAWING | {
        "box", "ellipse", "binding", "cond", "time", "code", "priority", "channel", "subst",
    },
    "arc": _DRAWING | {"arrowattr", "transend", "placeend", "annot", "bendpoint"},
}  # fmt: skip
_ORIENTATIONS = {"ptot", "ttop", "bothdir", "inhibitor", "reset"}
_NO_LAYOUT = Layout()
_PAIR = re.compile(r"\(\s*([^(),\s]*)\s*,\s*([^(),\s]*)\s*\)")


def readable(text: str) -> str:
    """A name on one line: line breaks in names are layout."""
    return " ".join(text.split())


class PageReader:
    """Reads pages; remembers ids over all pages of a file.

    Args:
        ids: those of all places and transitions of the file.
        drawn: whether anybody will look at the layout; without it, all things are where they are by default.
    """

    def __init__(
        self, file: str, d: Diagnostics, unknown: Warn, ids: Set[str], *, drawn: bool = True
    ) -> None:
        self.file = file
        self.drawn = drawn
        self.d = d
        self.unknown = unknown
        self.ids = ids
        self.seen: dict[str, Origin] = {}
        self.arcs_seen: dict[str, Origin] = {}
        self.stray: set[str] = set()

    def page(self, node: Node) -> RawPage:
        """A `page` with everything on it."""
        attributes = node.child("pageattr")
        name = readable(attributes.get("name")) if attributes else ""
        name = name or node.get("id") or "page"
        origin = Origin(self.file, node.line, node.column, name, "", node.get("id"), "")
        self.claim(node, origin, f"page `{name}`")
        self.check_children(node)
        constraints = node.child("constraints")
        if constraints is not None and constraints.children:
            self.d.warning(
                UNSUPPORTED_CONSTRAINT,
                f"declarative constraints are not supported: those of page `{name}` have no effect",
                constraints.at(origin),
                hint="express the constraints by places",
            )
        places = tuple(self.place(n, name) for n in node.all("place"))
        transitions = tuple(self.transition(n, name) for n in node.all("trans"))
        names = {p.id: p.name for p in places} | {t.id: t.name for t in transitions}
        points: dict[str, Point] = {}
        if self.drawn:
            points = {n.get("id"): point(n) for n in node.all("place") + node.all("trans")}
        place_ids, transition_ids = {p.id for p in places}, {t.id for t in transitions}
        arcs = [
            self.arc(n, name, place_ids, transition_ids, names, points) for n in node.all("arc")
        ]
        auxiliaries = tuple(
            RawAux(n.get("id"), _text(n.child("text")), self.layout(n)) for n in node.all("Aux")
        )
        return RawPage(
            id=node.get("id"),
            name=name,
            places=places,
            transitions=transitions,
            arcs=tuple(a for a in arcs if a is not None and a.orientation != "nodir"),
            auxiliaries=auxiliaries,
            origin=origin,
            undirected=tuple(a for a in arcs if a is not None and a.orientation == "nodir"),
        )

    def claim(self, node: Node, origin: Origin, what: str) -> None:
        """Note an id; missing and repeated ones are errors."""
        identity = node.get("id")
        if not identity:
            self.d.error(
                CPN_ELEMENT, f"{what} has no id", origin, hint="add an id attribute that is unique"
            )
        elif identity in self.seen:
            first = self.seen[identity]
            self._repeated(
                self.d.error, what, identity, origin, first, "give one of them another id"
            )
        else:
            self.seen[identity] = origin

    def claim_arc(self, node: Node, origin: Origin, what: str) -> str:
        """The id of an arc. Nothing refers to arcs, so that a repeated one is only made different."""
        identity = node.get("id")
        first = self.arcs_seen.get(identity) or self.seen.get(identity)
        if not identity or first is None:
            if not identity:
                self.claim(node, origin, what)
            self.arcs_seen[identity] = origin
            return identity
        hint = "nothing refers to arcs by their ids, so both count; give one of them another id"
        self._repeated(self.d.warning, what, identity, origin, first, hint)
        number = 2
        while (other := f"{identity}/{number}") in self.arcs_seen:
            number += 1
        self.arcs_seen[other] = origin
        return other

    @staticmethod
    def _repeated(
        report: Callable[..., None],
        what: str,
        identity: str,
        origin: Origin,
        first: Origin,
        hint: str,
    ) -> None:
        """Say, as an error or a warning, that an id has been used before."""
        text = f"{what} has the id `{identity}`, which is already used"
        notes = [Note(f"`{identity}` is first used here", first)]
        report(DUPLICATE_ID, text, origin, notes=notes, hint=hint)

    def check_text(self, node: Node, base: Origin) -> None:
        """Warn of text directly in an element that has its texts in a `text`, once for each kind of element."""
        text = node.text.strip()
        if not text or node.tag in self.stray:
            return
        self.stray.add(node.tag)
        self.d.warning(
            CPN_STRAY_TEXT,
            f"the text `{readable(text)[:40]}` stands directly in an element `{node.tag}` and is not read",
            node.at(base),
            hint="write it inside an element `text`: "
            f"<{node.tag}><text>{readable(text)[:40]}</text></{node.tag}>",
        )

    def check_children(self, node: Node) -> None:
        """Warn of unknown elements."""
        known = _KNOWN[node.tag]
        for child in node.children:
            if child.tag not in known:
                self.unknown(node, child)

    def place(self, node: Node, page: str) -> RawPlace:
        """A `place`."""
        caption = _text(node.child("text"))
        name = readable(caption) or node.get("id")
        origin = self.element(node, page, f"place `{name}`")
        port, fusion = node.child("port"), node.child("fusioninfo")
        return RawPlace(
            id=node.get("id"),
            name=name,
            type=self.inscription(node.child("type"), origin, "colour set"),
            initial=self.inscription(node.child("initmark"), origin, "initial marking"),
            port=port.get("type") if port else "",
            fusion=fusion.get("name") if fusion else "",
            origin=origin,
            layout=self.layout(node),
            caption=caption,
            port_layout=self.layout(port),
            fusion_layout=self.layout(fusion),
            token=self.offset(node.child("token")),
            marking=self.offset(node.child("marking")),
        )

    def transition(self, node: Node, page: str) -> RawTransition:
        """A `trans`."""
        caption = _text(node.child("text"))
        name = readable(caption) or node.get("id")
        origin = self.element(node, page, f"transition `{name}`")
        subst = node.child("subst")
        return RawTransition(
            id=node.get("id"),
            name=name,
            guard=self.inscription(node.child("cond"), origin, "guard"),
            delay=self.inscription(node.child("time"), origin, "delay"),
            code=self.inscription(node.child("code"), origin, "code segment"),
            priority=self.inscription(node.child("priority"), origin, "priority"),
            channel=self.inscription(node.child("channel"), origin, "channel"),
            substitution=self.substitution(subst, origin) if subst else None,
            origin=origin,
            layout=self.layout(node),
            caption=caption,
        )

    def element(self, node: Node, page: str, what: str) -> Origin:
        """Origin of a place or transition, its id claimed, its children checked."""
        origin = Origin(self.file, node.line, node.column, page, what, node.get("id"), "")
        self.claim(node, origin, what)
        self.check_children(node)
        self.check_text(node, origin)
        return origin

    def substitution(self, node: Node, base: Origin) -> RawSubstitution:
        """A `subst` with its pairs."""
        origin = node.at(base)
        text = node.get("portsock")
        if _PAIR.sub("", text).strip(" ,;\t\n"):
            self.d.error(
                CPN_ELEMENT,
                f"{base.element} has port assignments that cannot be read: `{text}`",
                origin,
                hint="assignments are written (port id, socket id)(port id, socket id)",
            )
        tag = self.layout(node.child("subpageinfo"))
        return RawSubstitution(node.get("subpage"), tuple(_PAIR.findall(text)), origin, tag)

    def arc(
        self,
        node: Node,
        page: str,
        places: set[str],
        transitions: set[str],
        names: dict[str, str],
        points: dict[str, Point],
    ) -> RawArc | None:
        """An `arc`; None, after an error, when an end is missing."""
        ends = node.child("placeend"), node.child("transend")
        place, transition = (e.get("idref") if e else "" for e in ends)
        orientation = node.get("orientation").lower()
        source, target = names.get(place, place) or "?", names.get(transition, transition) or "?"
        if orientation == "ttop":
            source, target = target, source
        what = f"arc `{source}` -> `{target}`"
        origin = Origin(self.file, node.line, node.column, page, what, node.get("id"), "")
        identity = self.claim_arc(node, origin, what)
        self.check_children(node)
        # Design/CPN's arcs without direction, as at substitution transitions, move no tokens.
        undirected = orientation == "nodir"
        if undirected and (place not in places or transition not in transitions):
            return None
        if not undirected and orientation not in _ORIENTATIONS:
            self.d.error(
                ARC_ORIENTATION,
                f"{what} has {_found(node.get('orientation'))}",
                origin,
                hint="orientations are PtoT, TtoP, BOTHDIR, Inhibitor, Reset",
            )
            return None
        if transition and transition not in self.ids and (place in places or place not in self.ids):
            self.d.warning(
                ARC_DANGLING,
                f"arc `{node.get('id')}` leads to the transition `{transition}`, which is nowhere in the file: "
                "the arc is left out, as by the engine of CPN Tools",
                origin,
                hint="remove it from the file, or draw the transition again",
            )
            return None
        dangling = False
        for end, missing, known, other, kind in (
            ("placeend", place, places, transitions, "place"),
            ("transend", transition, transitions, places, "transition"),
        ):
            if missing in known:
                continue
            dangling = True
            arc = f"arc `{node.get('id')}`"
            if not missing:
                message = f"{arc} has no {kind} end"
            elif missing in other:
                wrong = "transition" if kind == "place" else "place"
                message = f"{arc} needs a {kind} at `{end}`, but `{missing}` is a {wrong}"
            else:
                message = f"{arc} leads to the {kind} `{missing}`, which is not on page `{page}`"
            self.d.error(
                ARC_DANGLING, message, origin, hint="draw the arc again, or remove it from the file"
            )
        if dangling:
            return None
        shape = _NO_LAYOUT
        if self.drawn:
            shape = layout(node, bends(node, points[transition], points[place]))
        return RawArc(
            id=identity,
            orientation=orientation,
            transition=transition,
            place=place,
            inscription=self.inscription(node.child("annot"), origin, "inscription"),
            origin=origin,
            layout=shape,
            order=int(number(node.get("order"))),
        )

    def inscription(self, node: Node | None, base: Origin, part: str) -> Inscription | None:
        """The text of an inscription; None when it has none, or only white space."""
        if node is None:
            return None
        self.check_text(node, base)
        text = node.child("text")
        if text is None:
            return None
        for inner in text.children:
            self.d.error(
                CPN_ELEMENT,
                f"the text of the {part} has an element `{inner.tag}` in it, so that it is not known what it is",
                inner.at(base),
                hint="an element `text` holds text alone; `<` is written `&lt;`",
            )
        if not text.text.strip():
            return None
        origin = Origin(
            base.file, text.line, text.column, base.page, base.element, base.element_id, part
        )
        return Inscription(text.source(origin), self.layout(node))

    def layout(self, node: Node | None) -> Layout:
        """Layout of anything but an arc."""
        return layout(node) if self.drawn else _NO_LAYOUT

    def offset(self, node: Node | None) -> Layout:
        """Layout of a `token` or `marking`."""
        return offset(node) if self.drawn else _NO_LAYOUT


def _found(orientation: str) -> str:
    return f"the unknown orientation `{orientation}`" if orientation else "no orientation"


def _text(node: Node | None) -> str:
    return node.text.strip() if node else ""
