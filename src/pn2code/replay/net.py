"""The net of a description: its pages as their author drew them, and which element is where.

    described = describe(document, net)      # {"pages": [...], "instances": [...], "places": [...], ...}

The drawing is that of `pn2code draw`; what changes with the marking is drawn by the page over it, with the sizes and
colours that `style` repeats from there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import PurePath
from typing import Any

from pn2code.drawing import style, svg, text
from pn2code.drawing.scene import build
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.reading.document import Document, RawPage

Json = dict[str, Any]

_KINDS = {
    ArcKind.INPUT: "in",
    ArcKind.OUTPUT: "out",
}


def describe(document: Document, net: FlatNet) -> Json:
    """Pages, their instances, and the elements of the flat net on them."""
    pages = [_page(document, page) for page in document.pages]
    instances = _Instances(document, net)
    return {
        "name": net.name,
        "timed": net.timed,
        "style": _style(),
        "pages": pages,
        "instances": instances.rows,
        "places": [
            {
                "name": p.name,
                "short": p.short,
                "colset": p.colset.name or "",
                "timed": p.colset.timed,
                "members": instances.members.get(p.index, []),
            }
            for p in net.places
        ],
        "transitions": [
            {
                "name": t.name,
                "short": t.short,
                "id": t.id,
                "instance": instances.of(t.id, t.instance_number, t.instance),
                "variables": [s.name for s in t.variables],
                "arcs": [
                    {"id": a.id, "place": a.place, "kind": _KINDS.get(a.kind, a.kind.value)}
                    for a in t.arcs
                ],
            }
            for t in net.transitions
        ],
    }


def drawing(document: Document, problems: Mapping[str, Sequence[svg.Problem]]) -> Json:
    """The pages of a net with errors, which are red; it has no elements that could be played.

    Args:
        document: as drawn.
        problems: by element id.
    """
    overlay = svg.Overlay(problems=problems)
    return {
        "name": PurePath(document.file).stem,
        "timed": False,
        "style": _style(),
        "pages": [_page(document, page, overlay) for page in document.pages],
        "instances": [
            {"page": i, "number": 1, "path": p.name} for i, p in enumerate(document.pages)
        ],
        "places": [],
        "transitions": [],
    }


def _style() -> Json:
    return {
        "bubble": svg.BUBBLE,
        "lines": svg.MARKING_LINES,
        "width": svg.MARKING_WIDTH,
        "size": text.SIZE,
        "line": text.LINE,
        "family": text.FAMILY,
        "tokenLine": style.TOKEN_LINE,
        "tokenFill": style.TOKEN_FILL,
        "enabled": style.ENABLED,
    }


def _page(document: Document, page: RawPage, overlay: svg.Overlay = svg.Overlay()) -> Json:  # noqa: B008 - frozen
    scene = build(document, page)
    rows, box = svg.figure(scene, overlay, svg.Links())
    box = box.grown(svg.MARGIN)
    return {
        "id": page.id,
        "name": page.name,
        "arranged": scene.arranged,
        "box": [round(v, 1) for v in (box.left, box.top, box.width, box.height)],
        "svg": "".join(rows),
        "tokens": {
            i: [round(v, 1) for v in (*at, *scene.markings[i])] for i, at in scene.tokens.items()
        },
        "hidden": sorted(scene.hidden),
        "subpages": {
            t.id: t.substitution.subpage for t in page.transitions if t.substitution is not None
        },
    }


class _Instances:
    """The page instances, in the order of the hierarchy.

    Attributes:
        rows: page (its position), number, path from the prime page.
        members: by flat place: [instance, XML id] of each place that it is on a page.
    """

    def __init__(self, document: Document, net: FlatNet) -> None:
        page_of = {n.id: i for i, page in enumerate(document.pages) for n in page.nodes}
        self.rows: list[Json] = []
        self.members: dict[int, list[list[Any]]] = {}
        self._page_of = page_of
        self._known: dict[tuple[int, int], int] = {}
        for p in net.place_instances:
            at = self.of(p.id, p.number, p.instance)
            if at >= 0:
                self.members.setdefault(p.place, []).append([at, p.id])
        for t in net.transitions:
            self.of(t.id, t.instance_number, t.instance)
        shown = {row["page"] for row in self.rows}
        for i, page in enumerate(
            document.pages
        ):  # with nothing but notes or substitution transitions
            if i not in shown:
                self.rows.append({"page": i, "number": 1, "path": page.name})

    def of(self, identity: str, number: int, path: str) -> int:
        """The position of the instance that holds an element; -1: the element is on no page."""
        page = self._page_of.get(identity, -1)
        if page < 0:
            return -1
        key = (page, number)
        if key not in self._known:
            self._known[key] = len(self.rows)
            self.rows.append({"page": page, "number": number, "path": path})
        return self._known[key]
