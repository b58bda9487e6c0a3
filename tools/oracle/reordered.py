"""Whether the engine refuses a net only for the order of its arcs.

Where several arcs from one place share variables, it finds out how to bind them, or not, by the order in which they
stand in the file. A net that it accepts in another order has nothing wrong with it. Arcs in both directions come first
for it, wherever they stand; as input arcs, which bind the same variables, they take part in the order.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, permutations
from pathlib import Path

from lxml import etree
from tools.oracle import engine

MOST = 24
"""Orders that are tried."""


def is_accepted(path: Path, errors: Sequence[engine.Answer]) -> bool:
    """Whether in some order of the arcs of each transition that is refused, it is refused no more."""
    refused = {e["id"] for e in errors if e["by"] == "engine"}
    return all(_one_is_accepted(path, name) for name in refused)


def _one_is_accepted(path: Path, transition: str) -> bool:
    other = path.with_name("reordered-" + path.name)
    for net in _orders(path, transition):
        other.write_bytes(net)
        (answer,) = engine.check([other])
        if "failure" not in answer and all(e["id"] != transition for e in answer["errors"]):
            return True
    return False


def _orders(path: Path, transition: str) -> Iterator[bytes]:
    """The net with the arcs of a transition in all orders."""
    parser = etree.XMLParser(resolve_entities=False, no_network=True, load_dtd=False)
    root = etree.fromstring(path.read_bytes(), parser)
    arcs = [
        e
        for e in root.iter("arc")
        for end in e.findall("transend")
        if end.get("idref") == transition
    ]
    if len(arcs) < 2:
        return
    page = arcs[0].getparent()
    at = [page.index(arc) for arc in arcs]
    for order in islice(permutations(arcs), 1, MOST):
        copies = {
            place: etree.fromstring(etree.tostring(arc))
            for place, arc in zip(at, order, strict=True)
        }
        for place, arc in copies.items():
            if arc.get("orientation") == "BOTHDIR":
                arc.set("orientation", "PtoT")
            page[place] = arc
        yield bytes(etree.tostring(root, encoding="iso-8859-1", xml_declaration=True))
