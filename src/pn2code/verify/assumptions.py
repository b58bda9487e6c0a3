"""What the answers of `verify` rest on, in sentences for its report. Reasons: docs/execution.md, docs/protocol.md."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

NET: Final = (
    "The answers are about the net as it stands: supervisor, robots, devices and people do what their pages say.",
    "What was explored is the net as it was compiled for the explorer: packed places, arrays of other sizes and other "
    "compiler flags than in the generated net.o, which the supervisor and the simulator run.",
    "That net.o, the supervisor and the scripts do what the net does is not shown here: `pn2code conform` compares "
    "them and the explorer's graph with the token game, state by state.",
    "Runs that are shown were played again by the reference token game, which shares no code with the explorer.",
)
TIME: Final = "Time of the closed net goes by only where nothing is enabled; that of the cell whenever it likes."
CONTROL: Final = (
    "Controller checks: the net starts with its own initial marking, without the tokens of an `[[input]]` file.",
    "Controller checks and properties: the cell as it runs. Each program knows its own priorities, and the messages "
    "that it has seen; the supervisor goes in cycles; of what it can do, each does what comes first in the documented "
    "order.",
    "How quick a program is, is left open, and what sensors say; crashes are for the medium.",
)
MEDIUM: Final = (
    "A rename is atomic: a name leads to the old or to the new file, never to none or to half of one",
    "Who has opened a file reads it whole, also if another is renamed over it meanwhile",
    "What was renamed first is seen first by whoever looks at the *later* one first: a reader that sees the flag finds "
    "the data. Nothing is assumed of a reader that looks at the data first, so none does",
    "What was renamed is seen by the next look: looks may come late, but none shows what was replaced before it",
    "Files outlive the process that wrote them, with whole contents",
    "The lock of a process that has died is free, and its status file says what it said",
    "Of a shared and an exclusive lock on a file one is denied",
)
"""Of the file system, as in the table of docs/protocol.md."""


def assumed(*, timed: bool, control: bool, medium: bool, fair: Sequence[str] = ()) -> Iterator[str]:
    """The sentences that belong to what was asked.

    Args:
        timed: the net has time.
        control: the supervisor of a cell was checked.
        medium: its medium was.
        fair: names of properties that assume fairness, with what they assume.
    """
    yield from NET
    if timed:
        yield TIME
    yield from (f"Fairness is assumed of the property {one}." for one in fair)
    if control:
        yield from CONTROL
    if medium:
        yield from (f"File system: {one.replace('*', '')}." for one in MEDIUM)
