"""What has been found of a layout so far: moves that were looked at, and what does not surely keep apart.

progress = Progress()
progress.begin(situations)      # they are looked at now
progress.rows, progress.arms    # grow meanwhile; whose time is up tells what of it is wrong (`Look.so_far`)
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field

from pn2code.base.frozen import frozen, record
from pn2code.geometry.answers import Around, Move, Pair
from pn2code.geometry.apart import Apart
from pn2code.geometry.situation import Met, Side
from pn2code.geometry.situations import Situations


@frozen(eq=False)
class Meeting:
    """Two that do not surely keep apart, and where that is so first."""

    robots: tuple[str, str]
    transitions: tuple[str, str]
    doing: tuple[str, str]
    apart: Apart
    met: Met
    things: tuple[str, str] = ("", "")
    around: Around | None = None

    @property
    def is_touch(self) -> bool:
        """Whether they touch; else it is not known."""
        return self.apart.outcome == "touch"

    @property
    def told(self) -> tuple[object, ...]:
        """What is told of it: where it is the same, it is one."""
        gap = self.apart.where
        links = (gap.a, gap.b) if gap is not None else None
        return self.robots, self.transitions, self.doing, self.things, self.apart.outcome, links


@frozen
class Seen:
    """What was seen of a layout.

    Args:
        arms: what does not surely keep apart of two arms, by what they do; parts: of arms and parts that stand.
    """

    moves: tuple[Move, ...]
    arms: dict[tuple[Side, Side], Pair]
    parts: tuple[Pair, ...]

    @property
    def pairs(self) -> tuple[Pair, ...]:
        """All that does not surely keep apart."""
        return tuple(dict.fromkeys((*self.arms.values(), *self.parts)))


LATE = (
    "the time was up before everything was looked at: a NO is certain, of all else nothing is known"
)


@record
class Progress:
    """What has been found so far, for those whose time is up.

    Args:
        found: the situations that are looked at; seen: all of them, when that is done.
        at_start, rows, handled: moves that were looked at; arms, parts: what does not surely keep apart.
        moves, pairs: what was found wrong before in other parts of the cell.
    """

    found: Situations | None = None
    seen: Seen | None = None
    at_start: tuple[Move, ...] = ()
    rows: dict[tuple[int, str], Move] = field(default_factory=dict)
    handled: dict[tuple[str, str, str], Move] = field(default_factory=dict)
    arms: dict[tuple[Side, Side], Meeting] = field(default_factory=dict)
    parts: dict[tuple[str, str, str], Meeting] = field(default_factory=dict)
    moves: tuple[Move, ...] = ()
    pairs: tuple[Pair, ...] = ()

    def begin(self, found: Situations) -> None:
        """Situations are looked at now."""
        self.found, self.seen = found, None
        self.rows, self.handled, self.arms, self.parts = {}, {}, {}, {}

    def keep(self, moves: Iterable[Move], pairs: Iterable[Pair]) -> None:
        """What was found in the situations that were looked at last; of it what is wrong is certain."""
        self.moves = tuple(m for m in moves if m.answer == "no")
        self.pairs = tuple(p for p in pairs if p.answer == "no")
        self.found = None
