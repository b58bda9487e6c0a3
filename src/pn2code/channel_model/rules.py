"""What the two sides do: the protocol as it is implemented, and what a wrong one would do.

Each rule is one clause of docs/protocol.md that a side could break; the check of the channel model has to find it.
"""

from __future__ import annotations

from enum import Enum

from pn2code.base.frozen import frozen


class Emptying(Enum):
    """When a reader empties the file of a message that it has consumed (I4)."""

    BEFORE = "before it writes what follows"
    AFTER = "after it has written what follows"
    NEVER = "never"


@frozen
class Rules:
    """A protocol. The defaults are what `pn_channel_files.c` and `pn2code.channels` do.

    Args:
        renames: messages are written beside their place and renamed (I2); else in place.
        checks_empty: a writer writes only into an empty file (I3).
        empties: when a reader empties (I4).
        data_first: data are published before flags (I5).
        reads_flags_first: the supervisor looks at flags before it looks at data (I5).
        validates: what is torn is not taken (I6).
        checks_session: a message of another session is not taken (I6).
        checks_seq: a message that is not the next one is not taken (I6).
        cleans: the supervisor empties all files before it announces itself (I7).
        awaits_peers: the supervisor waits until robots of earlier sessions are gone (I7).
        unsays_first: a starting supervisor takes back an earlier `running` before its lock can be seen (I7).
        looks_again: a robot that has taken its lock looks again whether the supervisor runs (I7).
        joins_once: a robot does not join a session in which its predecessor has been (I7).
        looks_after: each side looks at the other's lock and status (I8, I9).
    """

    renames: bool = True
    checks_empty: bool = True
    empties: Emptying = Emptying.BEFORE
    data_first: bool = True
    reads_flags_first: bool = True
    validates: bool = True
    checks_session: bool = True
    checks_seq: bool = True
    cleans: bool = True
    awaits_peers: bool = True
    unsays_first: bool = True
    looks_again: bool = True
    joins_once: bool = True
    looks_after: bool = True
