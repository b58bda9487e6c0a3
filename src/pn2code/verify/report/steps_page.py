"""A trace as one HTML file: the pages of the net after each step, steps linked to the ones before and after.

Without scripts: a step is shown when its address is visited. So that the file stays small, a long trace of a large
net shows with each step only the pages that it is about, and, when even that is too much, the chosen step alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from pn2code.drawing.geometry import Box
from pn2code.drawing.scene import build
from pn2code.drawing.shapes import Scene
from pn2code.drawing.svg import MARGIN, Links, Overlay, figure, svg_attributes
from pn2code.reading.document import Document, RawPage
from pn2code.verify.report import html
from pn2code.verify.report.trace_frames import TraceFrame

MOST_FIGURES = 240
"""Drawings of pages in one file."""


def steps_page(
    document: Document,
    pages: Sequence[RawPage],
    frames: Sequence[TraceFrame],
    chosen: int,
    last: int,
    title: str,
    loop: int | None = None,
) -> str:
    """The HTML file.

    Args:
        document, pages: the net, and its pages to be drawn.
        frames: some that follow each other.
        chosen: the number of the step that is shown first, with all pages.
        last: the number of the last step.
        title: what stands above.
        loop: so many steps come before those that are repeated for ever; None: none are.
    """
    scenes = {p.id: build(document, p) for p in pages}
    every = [_instances(pages, m) for m in frames]
    involved = [
        own if m.number == chosen else [(p, n) for p, n in own if _is_about(p, n, m)]
        for m, own in zip(frames, every, strict=True)
    ]
    choice = next(
        (c for c in (every, involved) if sum(map(len, c)) <= MOST_FIGURES),
        [own if m.number == chosen else [] for m, own in zip(frames, every, strict=True)],
    )
    sections = [
        {
            "number": m.number,
            "step": m.step,
            "figures": [_figure(scenes[p.id], p, n, m) for p, n in own],
            "before": m.number - 1 if m is not frames[0] else None,
            "after": m.number + 1 if m is not frames[-1] else None,
        }
        for m, own in zip(frames, choice, strict=True)
    ]
    # The chosen one comes last: it hides when another, before it, is visited.
    sections.sort(key=lambda section: section["number"] == chosen)
    return html.page(
        "steps.html.j2",
        ("report.css", "steps.css"),
        title=title,
        sections=sections,
        chosen=chosen,
        last=last,
        again=loop if loop is not None and loop < last else None,
        frames=frames,
        is_timed=any(m.step is not None and m.step.time for m in frames),
    )


def _instances(pages: Sequence[RawPage], moment: TraceFrame) -> list[tuple[RawPage, int]]:
    """All instances of the pages; what the step is about comes first."""
    found = [(p, n) for p in pages for n in moment.state.instances(p) or [1]]
    return sorted(found, key=lambda own: not _is_about(own[0], own[1], moment))


def _is_about(page: RawPage, number: int, moment: TraceFrame) -> bool:
    return any((node.id, number) in moment.involved for node in page.nodes)


def _figure(scene: Scene, page: RawPage, number: int, moment: TraceFrame) -> Mapping[str, Any]:
    overlay = moment.state.overlay(page, number, Overlay())
    body, box = figure(scene, overlay, Links())
    caption = (
        f"{page.name}, instance {number}" if len(moment.state.instances(page)) > 1 else page.name
    )
    return {"caption": caption, "svg": Markup(_svg(body, box.grown(MARGIN)))}


def _svg(body: Sequence[str], box: Box) -> str:
    rows = [f'<svg xmlns="http://www.w3.org/2000/svg" {svg_attributes(box)} role="img">', *body]
    return "\n".join([*rows, "</svg>"])
