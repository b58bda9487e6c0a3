"""One transition of a robot or device under way."""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.geometry.contents import Contents
from pn2code.geometry.legs import Leg, Stand
from pn2code.geometry.prisms import PartEvent
from pn2code.robot.commands import Command


@frozen(eq=False)
class Activity:
    """One transition under way.

    Args:
        legs: each leg with the parts while it lasts.
        end: where the arm stands afterwards; None: a device.
        after: the parts afterwards.
        fault: why it cannot be done to its end; in which leg: the last.
        kinds: the kinds of parts that it handles.
        is_part: the fault is about a part; command: what cannot be done then.
        doubt: why it is not known whether an action can be done; "": it is.
        turns: the turntables that turn in it.
        may_run: belts that are told to run in it, also those that do not because a part waits at their stop: once that
            is taken away, they do.
        part_events: when parts are handled in it, come to rest, or begin to move with a plate.
        leans: the robots with parts in their tools on which clamps close in it: they must not move meanwhile.
        halfway: of a device of which nothing moves, the parts from the beginning until it is done.
    """

    number: int
    legs: tuple[tuple[Leg, Contents], ...]
    end: Stand | None
    after: Contents
    fault: str = ""
    kinds: frozenset[str] = frozenset()
    is_part: bool = False
    command: Command | None = None
    doubt: str = ""
    turns: frozenset[str] = frozenset()
    may_run: frozenset[str] = frozenset()
    part_events: tuple[PartEvent, ...] = ()
    leans: frozenset[str] = frozenset()
    halfway: tuple[Contents, ...] = ()

    @property
    def between(self) -> tuple[Contents, ...]:
        """The parts at each moment."""
        return (*(contents for _, contents in self.legs), *self.halfway, self.after)
