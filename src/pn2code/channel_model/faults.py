"""What must not happen to a message, or to a side."""

from __future__ import annotations

from enum import Enum


class Fault(Enum):
    """A verdict: the number is the token of the verdict's place."""

    OVERRUN = 1
    LOST = 2
    TWICE = 3
    REFUSED = 4
    STALE = 5
    OLD = 6
    TORN = 7
    STOP = 8
    BARE = 9
    MIXED = 10
    DEAD = 11


SAYS = {
    Fault.OVERRUN: "a message is to be written into a file that is not empty",
    Fault.LOST: "a message that nobody has consumed is lost",
    Fault.TWICE: "a message is consumed twice",
    Fault.REFUSED: "a message is refused although nobody has crashed",
    Fault.STALE: "a message of an earlier session is found in a later one",
    Fault.OLD: "a message of an earlier session is taken in a later one",
    Fault.TORN: "half a message is taken",
    Fault.STOP: "a side stops although nobody has crashed",
    Fault.BARE: "a flag is acted upon without the data that belong to it",
    Fault.DEAD: "a side joins the session of a supervisor that is dead",
    Fault.MIXED: "a flag is acted upon with the data of another one",
}
"""In words."""
