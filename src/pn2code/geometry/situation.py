"""A state of a cell with where its arms stand and which parts are there."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.geometry.contents import Contents
from pn2code.geometry.legs import Stand

Side = tuple[int, int, int]
"""What one arm does of two: (arm, transition, -1), or (arm, -1, place where it stands).

Of parts of a kind that stand on a plate of it, whatever the arm does, it is (arm, -2, which kind and plate).
"""
ON_PLATE = -2
Said = frozenset[tuple[int, str, bool]]
"""Whom, by the number of the owner, which sensor has told what."""


@frozen(eq=False)
class Situation:
    """A state of the cell with its arms and parts.

    Args:
        said: what sensors that see the scene may have said to whoever has asked before its commands: it is under way
            since then.
    """

    state: int
    stands: tuple[Stand, ...]
    contents: Contents
    said: Said = frozenset()

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from others."""
        return (self.state, self.contents.number, *(s.number for s in self.stands), self.said)


@frozen
class Met:
    """Where something is met first.

    Args:
        situation: its number.
        elements: what is under way there (-1: an arm that stands).
    """

    situation: int
    elements: tuple[int, ...]
