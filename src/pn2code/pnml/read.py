"""Reading `.pnml` files: place/transition nets and symmetric nets as a `Document`, like a `.cpn` file.

In: a path or bytes. Out: a `Document` whose inscriptions are CPN ML and know the PNML elements that they came from.
Pages that share nodes by reference places and transitions become one page; others stay pages of their own.

Example: `<initialMarking><text>5</text></initialMarking>` at a place of a P/T net becomes the initial marking ``5``
of a place of the colour set UNIT, where CPN Tools needs neither the name of the colour set nor more than the number.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import replace

from pn2code.diagnostics import Diagnostics, Origin, TooManyDiagnosticsError
from pn2code.pnml.codes import (
    NOT_PNML,
    PNML_NET_TYPE,
    PNML_SEVERAL_NETS,
)
from pn2code.pnml.declarations import Declarations
from pn2code.pnml.entered import KNOWN
from pn2code.pnml.nodes import strip_namespaces, text_of
from pn2code.pnml.placing import Point, bends, placed, position, scale
from pn2code.pnml.read_arcs import ArcReader
from pn2code.reading.cpn import give_up
from pn2code.reading.document import (
    Document,
    RawArc,
    RawBlock,
    RawColset,
    RawPage,
    RawPlace,
    RawTransition,
)
from pn2code.reading.pages import readable
from pn2code.reading.xml import Node, parse

_TYPES = {
    "ptnet": False, "ptNet": False, "PTNet": False, "pnmlcoremodel": False, "coremodel": False,
    "symmetricnet": True, "highlevelnet": True, "pt-hlpng": True, "hlnet": True,
}  # fmt: skip
_DEEPEST = 50
_UNIT = "UNIT"


def is_pnml(file: str, data: bytes) -> bool:
    """Whether a file is to be read as PNML: its name or its beginning says so."""
    if file.lower().endswith(".pnml"):
        return True
    return (
        not file.lower().endswith(".cpn")
        and re.search(rb"<(\w+:)?pnml[\s>]", data[:4096]) is not None
    )


def read_data(data: bytes, file: str, d: Diagnostics, *, partial: bool = False) -> Document | None:
    """Read the bytes of a `.pnml` file; `file` is the name used in messages.

    Returns:
        The document, or None if there were errors (if `partial`: only if this is no net at all).
    """
    before = len(d.errors)
    root = parse(data, file, d)
    if root is None:
        return None
    try:
        strip_namespaces(root)
        document = _Reader(file, d).document(root, hashlib.sha256(data).hexdigest())
    except TooManyDiagnosticsError:
        give_up(file, d)
        return None
    return None if len(d.errors) > before and not partial else document


class _Reader(ArcReader):
    """Reads one file."""

    def document(self, root: Node, sha256: str) -> Document | None:
        net = root.child("net")
        if root.tag != "pnml" or net is None:
            found = (
                f"the root element is `{root.tag}`" if root.tag != "pnml" else "`pnml` has no `net`"
            )
            self.d.error(
                NOT_PNML,
                f"not a PNML net: {found}",
                root.at(self.base),
                hint="a .pnml file has a root `pnml` with a `net` inside",
            )
            return None
        if len(nets := root.all("net")) > 1:
            self.d.warning(
                PNML_SEVERAL_NETS,
                f"the file has {len(nets)} nets, only the first, `{net.get('id')}`, is read",
                nets[1].at(self.base),
                hint="put each into a file of its own",
            )
        self.is_high_level = self.kind(net)
        self.strangers.check(net, KNOWN["net"])
        pages = self.pages(net)
        self.collect(pages)
        self.resolve()
        declared = [n for page in (net, *pages) for n in page.all("declaration")]
        self.declarations = Declarations(declared, self.base, self.d)
        if not self.is_high_level:
            origin = Origin(
                self.file, net.line, net.column, "", f"net `{net.get('id')}`", net.get("id")
            )
            self.declarations.items.append(
                RawColset("", _UNIT, "unit", (), (), (), False, (), False, "", origin)
            )
        merged = len(pages) > 1 and self.hang_together(pages)
        made: list[RawPage] = []
        title = readable(text_of(net.child("name"))) or net.get("id") or "Net"
        if merged:
            made.append(self.page(pages, title, pages[0]))
        else:
            for page in pages:
                own = readable(text_of(page.child("name")))
                fallback = title if len(pages) == 1 else page.get("id") or title
                made.append(self.page([page], own or fallback, page))
        items = self.declarations.items
        return Document(
            file=self.file,
            sha256=sha256,
            tool="PNML",
            version="",
            format="",
            globbox=RawBlock("", tuple(items)),
            pages=tuple(made),
            fusions=(),
            elements={
                "pages": len(made),
                "places": sum(len(p.places) for p in made),
                "transitions": sum(len(p.transitions) for p in made),
                "arcs": sum(len(v) for v in self.arcs_by_page.values()),
            },
        )

    def kind(self, net: Node) -> bool:
        """Whether the net is a high-level net."""
        name = net.get("type").rstrip("/").rpartition("/")[2].rpartition("#")[2]
        if name in _TYPES:
            return _TYPES[name]
        todo, typed = [net], False
        while todo and not typed:
            node = todo.pop()
            typed = node.tag == "place" and node.child("type") is not None
            todo += [c for c in node.children if c.tag in ("page", "place")]
        self.d.warning(
            PNML_NET_TYPE,
            f"the net type `{net.get('type')}` is not known: it is read as a "
            + ("high-level net" if typed else "place/transition net"),
            net.at(self.base),
            hint="types end in `/ptnet`, `/symmetricnet`, `/highlevelnet` or `/pt-hlpng`",
        )
        return typed

    def pages(self, net: Node) -> list[Node]:
        """All pages, inner ones after those around them; a net without pages is one itself."""
        found: list[Node] = []

        def walk(node: Node, depth: int) -> None:
            for page in node.all("page"):
                if depth < _DEEPEST:
                    found.append(page)
                    self.strangers.check(page, KNOWN["page"])
                    walk(page, depth + 1)

        walk(net, 0)
        loose = any(c.tag in ("place", "transition", "arc") for c in net.children)
        if not found or loose:
            found.insert(0, net)  # old files have no pages
        return found

    def page(self, pages: list[Node], name: str, first: Node) -> RawPage:
        """A page of the document, made of one page of the file, or of all."""
        origin = Origin(self.file, first.line, first.column, name, "", first.get("id"))
        own = [[c for c in p.children if c.tag in ("place", "transition")] for p in pages]
        points = [at for nodes in own for n in nodes if (at := position(n)) is not None]
        by = scale(points)
        places: list[RawPlace] = []
        transitions: list[RawTransition] = []
        arcs: list[RawArc] = []
        offsets: list[Point] = []
        below = 0.0
        for nodes in own:  # pages of the file stand below one another
            ys = [-at[1] * by for n in nodes if (at := position(n)) is not None]
            offset = (0.0, below - max(ys, default=0.0) if len(pages) > 1 else 0.0)
            below += (min(ys, default=0.0) - max(ys, default=0.0)) - 200.0
            offsets.append(offset)
            for node in nodes:
                shown = self.names.get(node.get("id"), "")
                layout = placed(position(node), by, offset, shown)
                if self.nodes.get(node.get("id")) is not node:
                    continue  # reported
                self.strangers.check(node, KNOWN[node.tag])
                if node.tag == "place":
                    place = self.place(node, name)
                    places.append(replace(place, layout=layout))
                else:
                    transitions.append(replace(self.transition(node, name), layout=layout))
        for p, offset in zip(pages, offsets, strict=True):
            for node in self.arcs_by_page.get(id(p), ()):
                arc = self.arc(node, name, len(arcs))
                if arc is not None:
                    shape = bends(node, by, offset, arc.orientation != "ttop")
                    arcs.append(replace(arc, layout=shape))
        return RawPage(
            id=first.get("id") or "page",
            name=name,
            places=tuple(places),
            transitions=tuple(transitions),
            arcs=tuple(arcs),
            auxiliaries=(),
            origin=origin,
        )
