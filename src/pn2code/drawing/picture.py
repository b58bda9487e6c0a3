"""Pages as one SVG document."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.drawing.svg import Overlay, draw_pages, page_svg
from pn2code.reading.document import Document, RawPage


def picture(document: Document, pages: Sequence[tuple[RawPage, Overlay]]) -> str:
    """The pages, each with what is drawn over it: one alone, several one below the other with headings."""
    if len(pages) == 1:
        return page_svg(document, *pages[0])
    return draw_pages(document, pages)
