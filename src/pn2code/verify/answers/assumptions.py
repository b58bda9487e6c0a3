"""What the answers of `verify` rest on, in sentences for its report. Reasons: docs/execution.md, docs/protocol.md."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

NET: Final = (
    "The answers are about the net as it stands: supervisor, robots, devices and people do what their pages say.",
    "The object that was verified is the explorer's own, made from the net with packed places and arrays of other "
    "sizes. The object that is deployed is net_own.o of the generated folder, in its `supervisor`: net.c without the "
    "transitions of robots. Both are compiled with the same standard and the same floating-point flags.",
    "This report does not show that net_own.o, the supervisor and the scripts do what the net does. `pn2code conform` "
    "compares them and the explorer's graph with the token game, state by state.",
    "The reference token game, which shares no code with the explorer, has replayed the runs that are shown.",
)
TIME: Final = "In the closed net time advances only where nothing is enabled; in the cell it may advance at any moment."
CONTROL: Final = (
    "Controller checks: places of `[[input]]` begin with the tokens that their files held; where a file was not there, "
    "with those of the net.",
    "Controller checks and properties are about the cell as it runs. Each program knows its own priorities and the "
    "messages that it has seen. The supervisor works in cycles. Of the transitions that are enabled, each program "
    "takes the first one in the documented order.",
    "Programs may be slow or fast, and sensors may give any value. Crashes are considered only with the medium.",
)
FILE_SYSTEM: Final = (
    "A rename is atomic: a name leads to the old or to the new file, never to none or to half of one",
    "A process that has opened a file reads all of it, even if another file is renamed over it in the "
    "meantime",
    "A reader that sees the later of two renamed files also finds the earlier one: if it sees the flag, it finds the "
    "data. Nothing is assumed about a reader that looks at the data first, so none does",
    "A renamed file is seen by the next look: looks may come late, but none shows what was replaced before it",
    "Files stay, with all of their contents, when the process that wrote them ends",
    "The lock of a process that has died is free, and its status file says what it said",
    "A file cannot have a shared and an exclusive lock at the same time",
)
"""Of the file system, as in the table of docs/protocol.md."""


def assumed(
    *, timed: bool, control: bool, channel_model: bool, fair: Sequence[str] = ()
) -> Iterator[str]:
    """The sentences that belong to what was asked.

    Args:
        timed: the net has time.
        control: the supervisor of a cell was checked.
        channel_model: its channel model was.
        fair: names of properties that assume fairness, with what they assume.
    """
    yield from NET
    if timed:
        yield TIME
    yield from (f"Fairness is assumed of the property {one}." for one in fair)
    if control:
        yield from CONTROL
    if channel_model:
        yield from (f"File system: {one.replace('*', '')}." for one in FILE_SYSTEM)
