"""A `Document` of flat pages (from a PNML net) as a file of CPN Tools.

CPN Tools enumerates variables that no arc binds only where their colour set has at most 100 values; a PNML net may have
larger ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import escape

from pn2code.convert.pnml import element
from pn2code.reading.document import (
    Document,
    Inscription,
    RawArc,
    RawBlock,
    RawColset,
    RawDeclaration,
    RawMl,
    RawPage,
    RawPlace,
    RawTransition,
    RawVar,
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
_LOOK = (
    element("fillattr", colour="White", pattern="", filled="false")
    + element("lineattr", colour="Black", thick=1, type="Solid")
    + element("textattr", colour="Black", bold="false")
)


def emit(document: Document, points: Points) -> str:
    """The file.

    Args:
        document: pages without hierarchy.
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
        """CPN Tools' ids are `ID` and a number."""
        if identity not in self.ids:
            self.ids[identity] = self.new()
        return self.ids[identity]

    def document(self, document: Document) -> str:
        pages = "\n".join(self.page(p) for p in document.pages)
        instances = "".join(
            element("instance", id=self.new(), page=self.id(f"page {p.id}")) for p in document.pages
        )
        globbox = "\n".join(self.declarations(document.globbox))
        return (
            '<?xml version="1.0" encoding="utf-8"?>\n'
            '<!DOCTYPE workspaceElements PUBLIC "-//CPN//DTD CPNXML 1.0//EN" '
            '"http://cpntools.org/DTD/6/cpn.dtd">\n'
            '<workspaceElements>\n<generator tool="CPN Tools" version="4.0.1" format="6"/>\n<cpnet>\n'
            f"<globbox>\n{globbox}\n</globbox>\n{pages}\n<instances>{instances}</instances>\n"
            '<options/>\n<binders/>\n<monitorblock name="Monitors"/>\n<IndexNode expanded="true"/>\n'
            "</cpnet>\n</workspaceElements>\n"
        )

    # --- declarations ----------------------------------------------------------------------------

    def declarations(self, block: RawBlock) -> Iterator[str]:
        for item in block.items:
            if isinstance(item, RawBlock):
                yield from self.declarations(item)
            else:
                yield self.declaration(item)

    def declaration(self, item: RawDeclaration) -> str:
        match item:
            case RawColset():
                ids = "".join(map(_id, item.ids))
                texts = "".join(element("ml", escape(t.text)) for t in item.texts)
                inside = element("with", texts) if texts else ids
                declare = element("declare", *map(_id, item.declare)) if item.declare else ""
                return element(
                    "color", _id(item.name), element(item.kind, inside), declare, id=self.new()
                )
            case RawVar():
                kind = element("type", _id(item.type))
                return element("var", kind, *map(_id, item.names), id=self.new())
            case RawMl():
                return element("ml", escape(item.text.text), id=self.new())
        raise TypeError(f"a PNML net has no {type(item).__name__}")

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
            element("ellipse", w=_WIDTH, h=_HEIGHT),
            self.label("type", p.type.text.text if p.type else "UNIT", x + 45, y - 26),
            self.label("initmark", _tokens(p.initial, ""), x + 45, y + 26),
            id=self.id(p.id),
        )

    def transition(self, t: RawTransition) -> str:
        x, y = self.points.get(t.id, (0.0, 0.0))
        return element(
            "trans",
            self.at(x, y),
            element("text", escape(t.name)),
            element("box", w=_WIDTH, h=_HEIGHT),
            element("binding", x=0, y=0),
            self.label("cond", f"[{t.guard.text.text}]" if t.guard else "", x - 45, y + 30),
            self.label("time", "", x + 45, y + 30),
            self.label("code", "", x + 45, y - 30),
            self.label("priority", "", x - 45, y - 30),
            id=self.id(t.id),
            explicit="false",
        )

    def arc(self, a: RawArc) -> str:
        x1, y1 = self.points.get(a.transition, (0.0, 0.0))
        x2, y2 = self.points.get(a.place, (0.0, 0.0))
        words = _tokens(a.inscription, "" if a.orientation in ("inhibitor", "reset") else "1")
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

    def at(self, x: float, y: float) -> str:
        return element("posattr", x=f"{x:.1f}", y=f"{y:.1f}") + _LOOK

    def label(self, tag: str, words: str, x: float, y: float) -> str:
        inside = element("text", escape(words), tool="CPN Tools", version="4.0.1")
        return element(tag, self.at(x, y), inside, id=self.new())


def _tokens(i: Inscription | None, otherwise: str) -> str:
    """The text of a multi-set; numbers of P/T nets are multi-sets of the unit token."""
    words = i.text.text if i else otherwise
    return f"{words}`()" if words.isdigit() else words


def _id(name: str) -> str:
    return element("id", escape(name))
