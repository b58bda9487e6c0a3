"""How a layout is checked."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.how_far import Say, silent
from pn2code.geometry.zones import Explore, Refused


@frozen
class Options:
    """How.

    Args:
        folder: of the traces; stem: what their names begin with.
        initial: markings that files gave, for the headers of traces.
        explore: explores a changed cell; None: no proposals.
        stage: hears in words what is done; say: and how far it is.
        jobs: processes that sweep.
        refused: what `generate` would say of a changed cell.
    """

    folder: Path
    stem: str
    initial: str | None = None
    explore: Explore | None = None
    stage: Callable[[str], None] = lambda _text: None
    jobs: int = 1
    say: Say = silent
    refused: Refused = lambda _changed: ""
