"""Which places of a cell's net were made for its registers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pn2code.net.flat import FlatPlace

MADE = "register-"
"""What the ids of elements begin with that are added for a register."""


def registers_of(places: Sequence[FlatPlace]) -> Mapping[int, int]:
    """By place that holds what a register is, or how far its messages are: the register's own place.

    Not the states in which readers wait for a value, which belong to their programs.
    """
    own = {p.origins[0]: p.index for p in places if not p.id.startswith(MADE) and p.origins}
    made = [p for p in places if p.id.startswith(MADE)]
    # A reader waits in places that it has for itself; the value comes in a channel, for which a place is made, too.
    registers = {own[p.origins[0]] for p in made if p.short.endswith("_taken")}
    found = {p: p for p in registers}
    return found | {p.index: own[p.origins[0]] for p in made if own[p.origins[0]] in registers}
