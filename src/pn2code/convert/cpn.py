"""A `Document` that was not drawn with CPN Tools (from PNML, or a net as text) as a file of CPN Tools.

CPN Tools enumerates variables that no arc binds only where their colour set has at most 100 values; a PNML net may have
larger ones.
"""

from __future__ import annotations

import re
from xml.sax.saxutils import escape

from pn2code.convert.cpn_declarations import declarations
from pn2code.convert.pnml import Xml, element
from pn2code.drawing.text import extent
from pn2code.reading.document import (
    Document,
    Inscription,
    RawArc,
    RawFusion,
    RawPage,
    RawPlace,
    RawSubstitution,
    RawTransition,
)

Points = dict[str, tuple[float, float]]
_ORIENTATIONS = {
    "ptot": "PtoT",
    "ttop": "TtoP",
    "bothdir": "BOTHDIR",
    "inhibitor": "Inhibitor",
    "reset": "Reset",
}
_WIDTH, _HEIGHT = 60, 40
_MARGIN = 16
"""Of a node, beside its name."""
_ID = re.compile(r"ID[0-9]{1,15}")
_LOOK = (
    element("fillattr", colour="White", pattern="", filled="false")
    + element("lineattr", colour="Black", thick=1, type="Solid")
    + element("textattr", colour="Black", bold="false")
)


def emit(document: Document, points: Points) -> str:
    """The file.

    Args:
        document: what it has, but monitors; the net of which it is read again is the same.
        points: where the nodes stand, by id, y upwards.
    """
    return _Writer(points).document(document)


class _Writer:
    def __init__(self, points: Points) -> None:
        self.points = points
        self.count = 0
        self.ids: dict[str, str] = {}

    def new(self) -> str:
        self.count += 1
        return f"ID{1_000_000 + self.count}"

    def id(self, identity: str) -> str:
        """CPN Tools' ids are `ID` and a number; those that are so stay, so that traces name the same elements."""
        if _ID.fullmatch(identity):
            return identity
        if identity not in self.ids:
            self.ids[identity] = self.new()
        return self.ids[identity]

    def document(self, document: Document) -> str:
        # In PNML what is not written means one token, numbers are tokens, and a guard has no brackets.
        self.is_pnml = document.tool == "PNML"
        self.pages = {p.id: p for p in document.pages}
        self.fused = {m: f.name for f in document.fusions for m in f.members}
        below = {
            t.substitution.subpage
            for p in document.pages
            for t in p.transitions
            if t.substitution is not None
        }
        pages = "\n".join(self.page(p) for p in document.pages)
        fusions = "".join(map(self.fusion, document.fusions))
        instances = "".join(self.instance(p) for p in document.pages if p.id not in below)
        globbox = "\n".join(declarations(document.globbox, self.new))
        options = "".join(
            element("option", element("value", element("boolean", escape(value))), name=name)
            for name, value in document.options.items()
        )
        return (
            '<?xml version="1.0" encoding="utf-8"?>\n'
            '<!DOCTYPE workspaceElements PUBLIC "-//CPN//DTD CPNXML 1.0//EN" '
            '"http://cpntools.org/DTD/6/cpn.dtd">\n'
            '<workspaceElements>\n<generator tool="CPN Tools" version="4.0.1" format="6"/>\n<cpnet>\n'
            f"<globbox>\n{globbox}\n</globbox>\n{pages}\n{fusions}<instances>{instances}</instances>\n"
            f'{element("options", options)}\n<binders/>\n<monitorblock name="Monitors"/>\n'
            '<IndexNode expanded="true"/>\n</cpnet>\n</workspaceElements>\n'
        )

    def fusion(self, f: RawFusion) -> Xml:
        members = [element("fusion_elm", idref=self.id(m)) for m in f.members]
        return element("fusion", *members, id=self.id(f.id), name=f.name) + "\n"

    def instance(self, page: RawPage, by: RawTransition | None = None) -> Xml:
        """An instance of a page, with those below it: a prime page, or below another one `by` a transition."""
        inside = [
            self.instance(self.pages[t.substitution.subpage], t)
            for t in page.transitions
            if t.substitution is not None and t.substitution.subpage in self.pages
        ]
        if by is None:
            return element("instance", *inside, id=self.new(), page=self.id(f"page {page.id}"))
        return element("instance", *inside, id=self.new(), trans=self.id(by.id))

    # --- pages -----------------------------------------------------------------------------------

    def page(self, page: RawPage) -> str:
        inside = [
            element("pageattr", name=page.name),
            *map(self.place, page.places),
            *map(self.transition, page.transitions),
            *map(self.arc, page.arcs),
        ]
        return element("page", *inside, id=self.id(f"page {page.id}"))

    def place(self, p: RawPlace) -> str:
        x, y = self.points.get(p.id, (0.0, 0.0))
        return element(
            "place",
            self.at(x, y),
            element("text", escape(p.name)),
            element("ellipse", w=_width(p.name), h=_HEIGHT),
            self.label(
                "type", _written(p.type) or ("UNIT" if self.is_pnml else ""), x + 45, y - 26
            ),
            self.label("initmark", self.tokens(p.initial, ""), x + 45, y + 26),
            self.tag("port", x - 24, y - 16, type=p.port) if p.port else "",
            self.tag("fusioninfo", x - 24, y - 16, name=self.fused[p.id])
            if p.id in self.fused
            else "",
            id=self.id(p.id),
        )

    def transition(self, t: RawTransition) -> str:
        x, y = self.points.get(t.id, (0.0, 0.0))
        return element(
            "trans",
            self.at(x, y),
            element("text", escape(t.name)),
            element("box", w=_width(t.name), h=_HEIGHT),
            self.substitution(t.substitution, x, y) if t.substitution else "",
            element("binding", x=0, y=0),
            self.label("cond", self.guard(t.guard), x - 45, y + 30),
            self.label("time", _written(t.delay), x + 45, y + 30),
            self.label("code", _written(t.code), x + 45, y - 30),
            self.label("priority", _written(t.priority), x - 45, y - 30),
            id=self.id(t.id),
            explicit="false",
        )

    def arc(self, a: RawArc) -> str:
        x1, y1 = self.points.get(a.transition, (0.0, 0.0))
        x2, y2 = self.points.get(a.place, (0.0, 0.0))
        words = self.tokens(a.inscription, "" if a.orientation in ("inhibitor", "reset") else "1")
        return element(
            "arc",
            self.at(0, 0),
            element("arrowattr", headsize="1.2", currentcyckle=2),
            element("transend", idref=self.id(a.transition)),
            element("placeend", idref=self.id(a.place)),
            self.label("annot", words, (x1 + x2) / 2, (y1 + y2) / 2 + 8),
            id=self.new(),
            orientation=_ORIENTATIONS[a.orientation],
            order=1,
        )

    def guard(self, i: Inscription | None) -> str:
        return f"[{i.text.text}]" if i is not None and self.is_pnml else _written(i)

    def tokens(self, i: Inscription | None, otherwise: str) -> str:
        """The text of a multi-set; numbers of P/T nets are multi-sets of the unit token."""
        if not self.is_pnml:
            return _written(i)
        words = i.text.text if i else otherwise
        return f"{words}`()" if words.isdigit() else words

    def substitution(self, s: RawSubstitution, x: float, y: float) -> Xml:
        page = self.pages.get(s.subpage)
        pairs = "".join(f"({self.id(port)},{self.id(socket)})" for port, socket in s.portsock)
        title = page.name if page is not None else s.subpage
        tag = self.tag("subpageinfo", x, y - _HEIGHT / 2, name=title)
        return element("subst", tag, subpage=self.id(f"page {s.subpage}"), portsock=pairs)

    def tag(self, tag: str, x: float, y: float, **attributes: str) -> Xml:
        """A label whose text is an attribute."""
        return element(tag, self.at(x, y), id=self.new(), **attributes)

    def at(self, x: float, y: float) -> str:
        return element("posattr", x=f"{x:.1f}", y=f"{y:.1f}") + _LOOK

    def label(self, tag: str, words: str, x: float, y: float) -> str:
        inside = element("text", escape(words), tool="CPN Tools", version="4.0.1")
        return element(tag, self.at(x, y), inside, id=self.new())


def _written(i: Inscription | None) -> str:
    return i.text.text if i is not None else ""


def _width(name: str) -> int:
    """Of a node, for its name."""
    return max(_WIDTH, round(extent((name,))[0]) + _MARGIN)
