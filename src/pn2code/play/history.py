"""The course of a game that can be walked back and forth: entries, each of which is taken back and made again.

history = History(changes, most_bytes=256 << 20)
history.add(Kind.STEP, before, after, element=occurred)
game.marking = history.back(game.marking)

A budget of memory limits how far back one can go: the oldest entries are forgotten first; `forgotten` says how many.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from enum import Enum

from pn2code.base.frozen import frozen
from pn2code.play.changes import Change, Changes, applied, weight
from pn2code.semantics.evaluation.references import Held
from pn2code.semantics.game.marking import BindingElement, Marking


class Kind(Enum):
    """What an entry is."""

    STEP = "step"
    """a transition has occurred"""
    TIME = "time"
    """the clock was moved on"""
    EDIT = "edit"
    """somebody has changed the marking: a new run begins"""
    LEAP = "leap"
    """many steps of the compiled simulator"""


@frozen
class At:
    """Where a game stands, besides its tokens: model time, number of steps in the run, what references hold."""

    time: int | float
    steps: int
    references: Held


@frozen
class Entry:
    """Something that has happened in a game.

    Args:
        kind: what.
        before, after: where the game stood.
        changes: of the tokens.
        element: of a step: what has occurred.
        place: of an edit: where; -1: anything.
        chosen: the seed of the choice, if it was made at random as in `simulate`; None: by hand.
    """

    kind: Kind
    before: At
    after: At
    changes: tuple[Change, ...]
    element: BindingElement | None = None
    place: int = -1
    chosen: int | None = None


class History:
    """The entries of a game, and where in them it stands.

    Args:
        changes: tells what has changed in markings of the net.
        most_bytes: of memory.

    Attributes:
        forgotten: how many entries at the beginning are no longer there.
        position: how many entries have happened, the forgotten ones included.
        more: bytes that others keep for each entry, as long as it is remembered.
    """

    def __init__(self, changes: Changes, most_bytes: int) -> None:
        self._changes = changes
        self._most = most_bytes
        self._bytes = 0
        self._entries: deque[Entry] = deque()
        self.forgotten = 0
        self.position = 0
        self.more = 0

    @property
    def length(self) -> int:
        """How many entries there are, those that can be made again included."""
        return self.forgotten + len(self._entries)

    @property
    def is_time(self) -> bool:
        """Whether the last entry moved the clock on, and nothing else."""
        return self.can_go_back and self.entry(self.position - 1).kind is Kind.TIME

    @property
    def can_go_back(self) -> bool:
        """Whether there is an entry to take back."""
        return self.position > self.forgotten

    def clear(self) -> None:
        """A new game."""
        self._entries.clear()
        self._bytes = self.forgotten = self.position = 0

    def entry(self, number: int) -> Entry:
        """The entry of this number, from 0; it must not be forgotten."""
        return self._entries[number - self.forgotten]

    def add(
        self,
        kind: Kind,
        before: tuple[Marking, int],
        after: tuple[Marking, int],
        *,
        element: BindingElement | None = None,
        place: int = -1,
        chosen: int | None = None,
    ) -> Entry:
        """Something has happened; what could have been made again is gone.

        Args:
            kind: what.
            before, after: markings, each with the number of steps.
            element, place, chosen: as for `Entry`.
        """
        while self.length > self.position:
            self._bytes -= self._weight(self._entries.pop())
        (old, old_steps), (new, new_steps) = before, after
        entry = Entry(
            kind,
            At(old.time, old_steps, old.references),
            At(new.time, new_steps, new.references),
            self._changes.between(old, new),
            element,
            place,
            chosen,
        )
        self._entries.append(entry)
        self.position += 1
        self._bytes += self._weight(entry)
        while self._bytes > self._most and len(self._entries) > 1:
            self._bytes -= self._weight(self._entries.popleft())
            self.forgotten += 1
        return entry

    def _weight(self, entry: Entry) -> int:
        return weight(entry.changes) + self.more

    def chosen_by(self, seed: int) -> bool:
        """Whether everything so far was chosen at random, with this seed, from the beginning on."""
        if self.forgotten:
            return False
        entries = list(self._entries)[: self.position]
        return all(e.chosen == seed for e in entries)

    def back(self, marking: Marking) -> tuple[Marking, int]:
        """Takes the last entry back; the marking and the number of steps before it."""
        self.position -= 1
        entry = self.entry(self.position)
        at = entry.before
        tokens = applied(marking, entry.changes, back=True)
        return replace(tokens, time=at.time, references=at.references), at.steps

    def on(self, marking: Marking) -> tuple[Marking, int]:
        """Makes the next entry again; the marking and the number of steps after it."""
        entry = self.entry(self.position)
        self.position += 1
        at = entry.after
        tokens = applied(marking, entry.changes)
        return replace(tokens, time=at.time, references=at.references), at.steps
