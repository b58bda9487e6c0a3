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

from pn2code.diagnostics import Diagnostics, Note, Origin, SourceText, TooManyDiagnosticsError
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.pnml.codes import (
    NOT_PNML,
    PNML_ELEMENT,
    PNML_NET_TYPE,
    PNML_REFERENCE,
    PNML_SEVERAL_NETS,
    PNML_SORT,
    UNSUPPORTED_PNML,
)
from pn2code.pnml.declarations import Declarations
from pn2code.pnml.nodes import Strangers, strip_namespaces, structure_of, text_of
from pn2code.pnml.placing import Point, bends, placed, position, scale
from pn2code.pnml.sorts import Sort
from pn2code.pnml.terms import Terms
from pn2code.reading.codes import ARC_DANGLING, DUPLICATE_ID
from pn2code.reading.cpn import give_up
from pn2code.reading.document import (
    Document,
    Inscription,
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
_KNOWN = {
    "net": frozenset({"name", "page", "declaration", "place", "transition", "arc", "text"}),
    "page": frozenset(
        {"name", "page", "declaration", "place", "transition", "arc", "referencePlace", "referenceTransition"}
    ),
    "place": frozenset({"name", "type", "hlinitialMarking", "initialMarking"}),
    "transition": frozenset({"name", "condition"}),
    "arc": frozenset({"name", "hlinscription", "inscription", "type", "arctype"}),
}  # fmt: skip
_DIGITS = re.compile(r"[0-9]{1,9}")
_ORIENTATIONS = {"inhibitor": "inhibitor", "reset": "reset", "test": "bothdir", "read": "bothdir"}
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


class _Reader:
    """Reads one file."""

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.base = Origin(file)
        self.strangers = Strangers(self.base, d)
        self.is_high_level = False
        self.nodes: dict[str, Node] = {}
        self.names: dict[str, str] = {}
        self.page_of: dict[str, Node] = {}
        self.real: dict[str, str] = {}
        self.sorts: dict[str, Sort | None] = {}
        self.arcs_by_page: dict[int, list[Node]] = {}

    # --- the whole -------------------------------------------------------------------------------

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
        self.strangers.check(net, _KNOWN["net"])
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
                    self.strangers.check(page, _KNOWN["page"])
                    walk(page, depth + 1)

        walk(net, 0)
        loose = any(c.tag in ("place", "transition", "arc") for c in net.children)
        if not found or loose:
            found.insert(0, net)  # old files have no pages
        return found

    def collect(self, pages: list[Node]) -> None:
        """Enter all nodes and arcs by their ids."""
        for page in pages:
            for node in page.children:
                if node.tag in (
                    "place",
                    "transition",
                    "referencePlace",
                    "referenceTransition",
                    "arc",
                ):
                    self.enter(node, page)

    def enter(self, node: Node, page: Node) -> None:
        identity = node.get("id")
        name = readable(text_of(node.child("name"))) or identity
        what = f"{node.tag} `{name}`"
        origin = Origin(self.file, node.line, node.column, "", what if name else node.tag, identity)
        if node.tag == "arc":
            self.arcs_by_page.setdefault(id(page), []).append(node)
            if not identity:
                return  # nobody refers to arcs
        if not identity:
            self.d.error(
                PNML_ELEMENT,
                f"a {node.tag} has no id",
                origin,
                hint="add an id attribute that is unique",
            )
        elif identity in self.nodes:
            first = self.nodes[identity]
            self.d.error(
                DUPLICATE_ID,
                f"{what} has the id `{identity}`, which is already used",
                origin,
                notes=[Note(f"`{identity}` is first used here", first.at(self.base))],
                hint="give one of them another id",
            )
        else:
            self.nodes[identity] = node
            self.names[identity] = name
            self.page_of[identity] = page

    def resolve(self) -> None:
        """What the reference nodes stand for."""
        for identity, node in self.nodes.items():
            wanted = "place" if node.tag in ("place", "referencePlace") else "transition"
            seen, at = {identity}, node
            while at.tag in ("referencePlace", "referenceTransition"):
                ref = at.get("ref")
                target = self.nodes.get(ref)
                if target is None or ref in seen or not target.tag.lower().endswith(wanted):
                    why = "which stands for itself" if ref in seen else f"which is no {wanted}"
                    self.d.error(
                        PNML_REFERENCE,
                        f"{node.tag} `{self.names[identity]}` leads to `{ref}`, {why}",
                        self.element(node, ""),
                        hint=did_you_mean(
                            ref,
                            [i for i, n in self.nodes.items() if n.tag == wanted],
                            f"let it lead to a {wanted}",
                        ),
                    )
                    break
                seen.add(ref)
                at = target
            else:
                self.real[identity] = at.get("id")

    def hang_together(self, pages: list[Node]) -> bool:
        """Whether there are reference nodes, or arcs with an end on another page than their own."""
        if any(n.tag in ("referencePlace", "referenceTransition") for n in self.nodes.values()):
            return True
        return any(
            self.page_of.get(arc.get(end), page) is not page
            for page in pages
            for arc in self.arcs_by_page.get(id(page), ())
            for end in ("source", "target")
        )

    # --- pages -----------------------------------------------------------------------------------

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
                self.strangers.check(node, _KNOWN[node.tag])
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

    def element(self, node: Node, page: str, part: str = "") -> Origin:
        """Origin of a place, a transition, or a part of one."""
        identity = node.get("id")
        what = f"{node.tag} `{self.names.get(identity, identity)}`"
        return Origin(self.file, node.line, node.column, page, what, identity, part)

    def place(self, node: Node, page: str) -> RawPlace:
        origin = self.element(node, page)
        identity = node.get("id")
        name = self.names[identity]
        kind: Inscription | None = None
        initial: Inscription | None = None
        if self.is_high_level:
            sort = self.place_sort(node, origin)
            self.sorts[identity] = sort
            colset = sort.name if sort else self.declarations.broken()
            type_node = node.child("type") or node
            at = replace(origin, line=type_node.line, column=type_node.column, part="colour set")
            kind = Inscription(SourceText(colset, at))
            marking = node.child("hlinitialMarking")
            term = structure_of(marking)
            if sort is not None and term is not None:
                terms = Terms(self.declarations, replace(origin, part="initial marking"), self.d)
                text = terms.multiset(term, sort)
                initial = Inscription(text) if text else None
            elif marking is not None and text_of(marking) and term is None:
                self.no_structure(marking, origin)
        else:
            label = node.child("initialMarking")
            if label is not None:
                initial = self.weight(label, origin, "initial marking", 0)
        return RawPlace(
            id=identity,
            name=name,
            type=kind,
            initial=initial,
            port="",
            fusion="",
            origin=origin,
            caption=name,
        )

    def place_sort(self, node: Node, origin: Origin) -> Sort | None:
        """The sort of a place of a high-level net."""
        label = node.child("type")
        structure = structure_of(label)
        if label is None or structure is None:
            self.d.error(
                PNML_ELEMENT,
                f"place `{self.names[node.get('id')]}` has no sort",
                label.at(origin) if label else origin,
                hint="write a `type` with a `structure`",
            )
            return None
        return self.declarations.sort(structure, structure.at(replace(origin, part="colour set")))

    def no_structure(self, node: Node, origin: Origin) -> None:
        """Report a label that people can read, but programs cannot."""
        self.d.error(
            PNML_ELEMENT,
            f"`{node.tag}` has a text, but no `structure`",
            node.at(origin),
            hint="save the net with a tool that writes the structure: texts have no fixed form",
        )

    def weight(self, label: Node, base: Origin, part: str, least: int) -> Inscription | None:
        """The number of a P/T net's label; None for the least one, which needs no text."""
        node = label.child("text") or label
        text = node.text.strip()
        # Some tools write `Default,5`.
        digits = text.rpartition(",")[2].strip() if text.startswith("Default,") else text
        if not _DIGITS.fullmatch(digits) or int(digits) < least:
            is_large = digits.isascii() and digits.isdigit() and int(digits[:40]) > 0
            self.d.error(
                UNSUPPORTED_PNML if is_large else PNML_ELEMENT,
                f"`{text[:40]}` is "
                + ("too large" if is_large else f"no {'positive ' if least else ''}number"),
                node.at(replace(base, part=part)),
                hint="numbers of more than nine digits are not supported"
                if is_large
                else "place/transition nets have numbers as markings and weights",
            )
            return None
        at = node.source(replace(base, part=part)).origin
        return Inscription(SourceText(str(int(digits)), at)) if int(digits) != least else None

    def transition(self, node: Node, page: str) -> RawTransition:
        origin = self.element(node, page)
        guard: Inscription | None = None
        label = node.child("condition")
        term = structure_of(label)
        if term is not None:
            text = Terms(self.declarations, replace(origin, part="guard"), self.d).condition(term)
            guard = Inscription(text) if text else None
        elif label is not None and text_of(label):
            self.no_structure(label, origin)
        name = self.names[node.get("id")]
        return RawTransition(
            id=node.get("id"),
            name=name,
            guard=guard,
            delay=None,
            code=None,
            priority=None,
            channel=None,
            substitution=None,
            origin=origin,
            caption=name,
        )

    # --- arcs ------------------------------------------------------------------------------------

    def arc(self, node: Node, page: str, number: int) -> RawArc | None:
        """An arc; None, after an error, when an end is missing."""
        self.strangers.check(node, _KNOWN["arc"])
        source, target = node.get("source"), node.get("target")
        shown = [self.names.get(i, i) or "?" for i in (source, target)]
        identity = node.get("id") or f"arc{number}:{node.line}:{node.column}"
        what = f"arc `{shown[0]}` -> `{shown[1]}`"
        origin = Origin(self.file, node.line, node.column, page, what, node.get("id"))
        ends = [self.nodes.get(i) for i in (source, target)]
        for word, wanted, end in zip(("source", "target"), (source, target), ends, strict=True):
            if end is None or end.tag == "arc":
                why = (
                    f"leads to `{wanted}`, which is no node of the net"
                    if wanted
                    else f"has no {word}"
                )
                nodes = [i for i, n in self.nodes.items() if n.tag != "arc"]
                hint = did_you_mean(wanted, nodes, "draw it again, or remove it")
                self.d.error(ARC_DANGLING, f"arc `{node.get('id')}` {why}", origin, hint=hint)
                return None
        real = [self.real.get(i) for i in (source, target)]
        if None in real:
            return None  # a reference that leads nowhere has been reported
        first, second = (self.nodes[r] for r in real if r is not None)
        if first.tag == second.tag:
            self.d.error(
                ARC_DANGLING,
                f"arc `{node.get('id')}` connects two {first.tag}s",
                origin,
                hint="arcs lead from places to transitions and from transitions to places",
            )
            return None
        outwards = first.tag == "transition"
        place, transition = (second, first) if outwards else (first, second)
        orientation = self.orientation(node, origin, outwards)
        if orientation is None:
            return None
        inscription: Inscription | None = None
        if orientation in ("inhibitor", "reset"):
            self.plain(node, origin, orientation)
        elif not self.is_high_level:
            label = node.child("inscription")
            if label is not None and text_of(label):
                inscription = self.weight(label, origin, "inscription", 1)
        else:
            found = self.inscription(node, origin, place)
            if found is None:
                return None
            inscription = found
        return RawArc(
            id=identity,
            orientation=orientation,
            transition=transition.get("id"),
            place=place.get("id"),
            inscription=inscription,
            origin=origin,
        )

    def orientation(self, node: Node, origin: Origin, outwards: bool) -> str | None:
        """The orientation; inhibitor, reset and test arcs are common extensions."""
        label = node.child("type") or node.child("arctype")
        kind = (label.get("value") or text_of(label)) if label else node.get("type")
        kind = kind.strip().lower()
        if kind in ("", "normal", "inputarc", "outputarc"):
            return "ttop" if outwards else "ptot"
        if kind not in _ORIENTATIONS or outwards:
            self.d.error(
                UNSUPPORTED_PNML,
                f"arcs of type `{kind}` "
                + ("from a transition " if outwards else "")
                + "are not supported",
                origin,
                hint="arcs are normal, or, from a place to a transition, inhibitor, reset or test",
            )
            return None
        return _ORIENTATIONS[kind]

    def plain(self, node: Node, origin: Origin, orientation: str) -> None:
        """Inhibitor arcs ask for an empty place."""
        label = node.child("inscription") or node.child("hlinscription")
        if orientation == "inhibitor" and label is not None and text_of(label) not in ("", "1"):
            self.d.error(
                UNSUPPORTED_PNML,
                "an inhibitor arc with a weight is not supported",
                label.at(origin),
                hint="an inhibitor arc asks whether the place is empty",
            )

    def inscription(self, node: Node, origin: Origin, place: Node) -> Inscription | None:
        """The tokens that an arc of a high-level net moves; None after an error."""
        inside = replace(origin, part="inscription")
        sort = self.sorts.get(place.get("id"))
        if sort is None:
            if place.get("id") not in self.sorts:
                self.sorts[place.get("id")] = sort = self.place_sort(place, self.element(place, ""))
            if sort is None:
                return None
        label = node.child("hlinscription")
        term = structure_of(label)
        if term is None:
            if label is not None and text_of(label):
                self.no_structure(label, origin)
            elif sort.kind.value == "dot":
                return Inscription(SourceText("1`()", inside))
            else:
                name = self.names[place.get("id")]
                self.d.error(
                    PNML_SORT,
                    f"{origin.element} has no inscription",
                    origin,
                    notes=[f"place `{name}` holds `{sort.shown}`"],
                    hint="write a `hlinscription` that says which tokens it moves",
                )
            return None
        text = Terms(self.declarations, inside, self.d).multiset(term, sort)
        return Inscription(text) if text else None
