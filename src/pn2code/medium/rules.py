"""What the two sides do: the protocol as it is implemented, and ways of doing it wrong.

Each rule is one clause of docs/protocol.md that a side could break. `VARIANTS` are protocols with one or two of them
broken; the check of the medium has to find each of them out.
"""

from __future__ import annotations

from enum import Enum

from pn2code.frozen import frozen


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


@frozen
class Variant:
    """A protocol that is wrong: a name, what is wrong in words, and its rules."""

    name: str
    says: str
    rules: Rules


VARIANTS = (
    Variant("flag-before-data", "flags are published before their data", Rules(data_first=False)),
    Variant(
        "data-read-first",
        "the supervisor looks at the data before it looks at the flags",
        Rules(reads_flags_first=False),
    ),
    Variant(
        "not-emptied",
        "a message that was consumed stays in its file",
        Rules(empties=Emptying.NEVER),
    ),
    Variant(
        "not-emptied-no-seq",
        "a message that was consumed stays in its file, and nobody looks at its number",
        Rules(empties=Emptying.NEVER, checks_seq=False),
    ),
    Variant(
        "emptied-late",
        "a file is emptied after what follows has been written",
        Rules(empties=Emptying.AFTER),
    ),
    Variant(
        "overwrites",
        "a file is emptied late, and the writer writes without looking whether it is empty",
        Rules(empties=Emptying.AFTER, checks_empty=False),
    ),
    Variant("in-place", "messages are written in place, not renamed", Rules(renames=False)),
    Variant(
        "torn",
        "messages are written in place, and taken without being validated",
        Rules(renames=False, validates=False),
    ),
    Variant(
        "not-cleaned",
        "a new supervisor does not empty the files of an earlier session",
        Rules(cleans=False),
    ),
    Variant(
        "no-session",
        "a new supervisor does not empty the files, and nobody looks at a message's session",
        Rules(cleans=False, checks_session=False),
    ),
    Variant(
        "peers-alive",
        "a new supervisor does not wait until the robots of an earlier session are gone",
        Rules(awaits_peers=False),
    ),
    Variant(
        "lock-before-unsaid",
        "a new supervisor takes its lock while its status still says that the earlier one is running",
        Rules(unsays_first=False),
    ),
    Variant(
        "looks-once",
        "a robot looks for the supervisor before it takes its own lock, and not again after it",
        Rules(looks_again=False),
    ),
    Variant(
        "joins-again",
        "a robot that has died is started again in the same session",
        Rules(joins_once=False),
    ),
    Variant("blind", "no side looks at the other's lock and status", Rules(looks_after=False)),
)
"""Protocols that are wrong."""
