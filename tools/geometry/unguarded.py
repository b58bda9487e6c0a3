"""A copy of a cell in which a place of the net has no arcs: a zone that nobody guards.

unguarded(Path("examples/shared-zone"), "Station", "Free", Path("copy"))        # 2 arcs are gone
"""

from __future__ import annotations

import shutil
from pathlib import Path

from lxml import etree


def unguarded(cell: Path, page: str, place: str, to: Path) -> int:
    """Copies the cell, and takes the arcs of a place on a page away; how many."""
    shutil.copytree(cell, to)
    (net,) = to.glob("*.cpn")
    tree = etree.parse(net)
    own = next(p for p in tree.iter("page") if p.find("pageattr").get("name") == page)
    ids = {p.get("id") for p in own.findall("place") if (p.findtext("text") or "").strip() == place}
    gone = [a for a in own.findall("arc") if a.find("placeend").get("idref") in ids]
    for arc in gone:
        own.remove(arc)
    tree.write(net, encoding="iso-8859-1", xml_declaration=True)
    return len(gone)
