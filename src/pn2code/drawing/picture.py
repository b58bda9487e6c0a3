"""Pages as one SVG document, empty or with a marking."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.drawing.state import State, enabled_in
from pn2code.drawing.svg import Overlay, draw_pages, page_svg
from pn2code.reading.document import Document, RawPage
from pn2code.semantics.game import Game
from pn2code.semantics.marking import Marking


def picture(
    document: Document,
    pages: Sequence[RawPage],
    game: Game | None = None,
    marking: Marking | None = None,
) -> str:
    """The pages, one below the other; with a game and a marking of it, its tokens and what is enabled.

    Of a page with several instances the first is shown.

    Raises:
        GameError: a guard or an inscription raises an exception.
    """
    overlays = {page.id: Overlay() for page in pages}
    if game is not None and marking is not None:
        state = State(game.net, marking, enabled_in(game, marking))
        overlays = {p.id: state.overlay(p, state.shown_first(p), Overlay()) for p in pages}
    if len(pages) == 1:
        return page_svg(document, pages[0], overlays[pages[0].id])
    return draw_pages(document, [(p, overlays[p.id]) for p in pages])
