"""Files in memory, and which lines of them came from which net element."""

from __future__ import annotations

from dataclasses import field

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin


@frozen
class Block:
    """Lines `first`..`last` (1-based, inclusive) of a file that implement one net element.

    Args:
        element: unique name in the net, e.g. "Top.Robot1.Accept" or a declaration's name.
        kind: "transition", "place", "declaration", "channel", "page".
        origin: the net element.
    """

    element: str
    kind: str
    origin: Origin
    first: int
    last: int


@frozen
class OutputFile:
    """One file: path relative to the output folder with `/`, its text, its blocks."""

    path: str
    text: str
    blocks: tuple[Block, ...] = field(default=())
