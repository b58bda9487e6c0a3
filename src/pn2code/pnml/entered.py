"""The nodes and arcs of a PNML net by their ids, and what its reference nodes stand for."""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.pnml.codes import PNML_ELEMENT, PNML_REFERENCE
from pn2code.pnml.nodes import Strangers, text_of
from pn2code.reading.codes import DUPLICATE_ID
from pn2code.reading.pages import readable
from pn2code.reading.xml import Node

KNOWN = {
    "net": frozenset({"name", "page", "declaration", "place", "transition", "arc", "text"}),
    "page": frozenset(
        {"name", "page", "declaration", "place", "transition", "arc", "referencePlace", "referenceTransition"}
    ),
    "place": frozenset({"name", "type", "hlinitialMarking", "initialMarking"}),
    "transition": frozenset({"name", "condition"}),
    "arc": frozenset({"name", "hlinscription", "inscription", "type", "arctype"}),
}  # fmt: skip
"""What is known below the elements of a net; anything else is warned of."""


class Entered:
    """What a file has, before it is read what it means.

    Args:
        file: the name used in messages.
        d: gets the errors.
    """

    def __init__(self, file: str, d: Diagnostics) -> None:
        self.file = file
        self.d = d
        self.base = Origin(file)
        self.strangers = Strangers(self.base, d)
        self.nodes: dict[str, Node] = {}
        self.names: dict[str, str] = {}
        self.page_of: dict[str, Node] = {}
        self.real: dict[str, str] = {}
        self.arcs_by_page: dict[int, list[Node]] = {}

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
        """Enter a node or an arc by its id."""
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

    def element(self, node: Node, page: str, part: str = "") -> Origin:
        """Origin of a place, a transition, or a part of one."""
        identity = node.get("id")
        what = f"{node.tag} `{self.names.get(identity, identity)}`"
        return Origin(self.file, node.line, node.column, page, what, identity, part)
