"""How far a recording has been followed: the states in which the net may be, and what becomes of it in the end."""

from __future__ import annotations

from dataclasses import field
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.semantics.evaluation.references import Held
from pn2code.semantics.game.marking import Binding, BindingElement, Marking
from pn2code.semantics.game.partial_marking import PartialMarking
from pn2code.semantics.game.report import PlaceRow

Occurrence = tuple[int | float, BindingElement]
"""When, and what."""


@frozen
class Followed:
    """What became of a recording.

    Args:
        ok: whether every step could be repeated, as far as it is determined.
        steps: how many were.
        why: if not ok, what is wrong with the next one; else "" or what was drawn at random.
        random: whether some values had to be taken as recorded, since the net draws them.
        time: of the last marking.
        rows: the last marking; what is not known of it is as recorded, and so is said in `drawn`.
        drawn: names of the places with tokens that depend on drawn numbers.
        given_up: whether the next step is not known to be wrong: the token game gave up an evaluation.
        occurrences: (time, binding element) of each step that was repeated.
    """

    ok: bool
    steps: int
    why: str
    random: bool
    time: int | float
    rows: list[PlaceRow]
    drawn: tuple[str, ...] = ()
    occurrences: tuple[Occurrence, ...] = ()
    given_up: bool = False


@frozen
class State:
    """A marking that fits what has been seen, what is not known of it, the contents of the references, and how one
    comes there (one way, if there are several)."""

    marking: Marking
    unknown: PartialMarking
    references: Held
    path: Any = field(default=None, compare=False)
    """(what came before, the last occurrence), or None at the start"""

    def occurrences(self) -> tuple[Occurrence, ...]:
        """All since the start."""
        found: list[Occurrence] = []
        path = self.path
        while path is not None:
            path, last = path
            found.append(last)
        return tuple(reversed(found))


@frozen
class EnabledBinding:
    """A recorded binding that is enabled, and the tokens that it takes.

    Args:
        left: the marking without the tokens that are taken.
        unknown: what is not known of it.
        binding: without the outputs of the code segment.
        read: whether the values were read from the recording, which tells reals with 12 digits.
    """

    left: Marking
    unknown: PartialMarking
    binding: Binding
    read: bool = False
