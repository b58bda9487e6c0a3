"""XML of PNML: elements by their local names, ids, texts."""

from __future__ import annotations

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.pnml.codes import PNML_UNKNOWN_ELEMENT
from pn2code.reading.xml import Node

NAMESPACE = "http://www.pnml.org/version-2009/grammar/pnml"
_IGNORED = frozenset({"toolspecific", "graphics"})


def local(tag: str) -> str:
    """The name without its namespace or prefix."""
    return tag.rpartition("}")[2].rpartition(":")[2]


def strip_namespaces(root: Node) -> None:
    """Replace the tags of a tree by local names; PNML's own namespace and none mean the same."""
    todo = [root]
    while todo:
        node = todo.pop()
        node.tag = local(node.tag)
        todo += node.children


def text_of(node: Node | None) -> str:
    """The `text` of a label, trimmed; "" if it has none."""
    text = node.child("text") if node else None
    return text.text.strip() if text else ""


def structure_of(node: Node | None) -> Node | None:
    """The one element inside the `structure` of a label."""
    structure = node.child("structure") if node else None
    return structure.children[0] if structure and structure.children else None


class Strangers:
    """Warns of unknown elements, once for each kind of parent."""

    def __init__(self, base: Origin, d: Diagnostics) -> None:
        self._base = base
        self._d = d
        self._reported: set[tuple[str, str]] = set()

    def check(self, node: Node, known: frozenset[str]) -> None:
        """Warn of the children of an element that are not known."""
        for child in node.children:
            if child.tag in known or child.tag in _IGNORED:
                continue
            if (node.tag, child.tag) in self._reported:
                continue
            self._reported.add((node.tag, child.tag))
            self._d.warning(
                PNML_UNKNOWN_ELEMENT,
                f"element `{child.tag}` inside `{node.tag}` is not known and is ignored",
                child.at(self._base),
                hint="is it misspelled? Elements of one tool belong inside `toolspecific`",
            )
