"""Identifiers of a file that CPN Tools cannot work with, though it accepts the net.

The engine makes names of them: `CPN'placeID16`, `CPN'BTID42`. (Found by experiment with each kind of element.)
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.net.codes import ENGINE_ID
from pn2code.reading.document import Document

_FINE = re.compile(r"[A-Za-z0-9_']*")


def warn(document: Document, d: Diagnostics) -> None:
    """Warn of the first one: whoever writes a file by a program mostly makes all of them alike."""
    for problem, origin in _problems(document):
        d.warning(
            ENGINE_ID,
            problem,
            origin,
            hint="write `ID` and a number, as its editor does, if the net is to be used there, too",
        )
        return


def _problems(document: Document) -> Iterator[tuple[str, Origin]]:
    for page in document.pages:
        for kind, nodes in (("place", page.places), ("transition", page.transitions)):
            for node in nodes:
                if not _FINE.fullmatch(node.id):
                    whose = f"the identifier `{node.id}` of {kind} `{node.name}`"
                    what = f"{whose} has other characters than letters and digits"
                    yield f"{what}: CPN Tools accepts the net, but cannot compile it", node.origin
                if kind == "place" and node.id.startswith("P"):
                    what = f"the identifier `{node.id}` of place `{node.name}` begins with `P`"
                    yield (
                        f"{what}: the state-space tool of CPN Tools cannot be entered",
                        node.origin,
                    )
        if not _FINE.fullmatch(page.id):
            whose = f"the identifier `{page.id}` of page `{page.name}`"
            what = f"{whose} has other characters than letters and digits"
            yield f"{what}: the state-space tool of CPN Tools cannot be entered", page.origin
