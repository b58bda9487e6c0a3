"""Timers of the supervisor that wait longer for an answer than `reply_timeout_s` permits.

    Ask:      out call, out Asked, out Timer @+20       `reply_timeout_s` is 15
    Said:     in Asked, in Timer, in said               the answer
    Timeout:  in Asked, in Timer                        it cannot occur while nobody answers: the cell stops before

warn(partition, config, d)                    # as warnings

Whoever has got a flag and sends nothing owes an answer, and stops the cell after `reply_timeout_s`. One is told only
where each message of whom the command goes to ends the wait, so that the timer is for those who send nothing.
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Channel, ChannelKind, Partition
from pn2code.diagnostics import Diagnostics, Note
from pn2code.net.flat import FlatTransition
from pn2code.verify.codes import LONG_TIMER
from pn2code.verify.controller.durations import Durations
from pn2code.verify.controller.short_timers import (
    ended,
    of_supervisor,
    puts_one,
    shortest,
    taken,
    timers,
)


def warn(partition: Partition, config: CellConfig, d: Diagnostics) -> None:
    """A warning for each."""
    limit = config.supervisor.reply_timeout_s
    owners = partition.owners
    own = of_supervisor(partition)
    durations = Durations(partition.net, config.storage)
    for start in own:
        for place, delays in timers(start, partition):
            seconds = sum(shortest(durations, e) for e in delays)
            if seconds <= limit:
                continue
            for over in own:
                command = _waited_for(start, over, place, own, partition)
                if command is not None:
                    who = owners[command.reader].phrase
                    d.warning(
                        LONG_TIMER,
                        f"the timer of {seconds:g} s that `{start.short}` starts is longer than `reply_timeout_s`, "
                        f"{limit:g} s: if {who} does not answer `{command.name}`, the supervisor stops the cell before "
                        "the timer is over",
                        start.origin,
                        notes=[Note(f"`{over.short}` would occur when it is over", over.origin)],
                        hint="make `reply_timeout_s` longer than the timer, or the timer shorter",
                    )


def _waited_for(
    start: FlatTransition,
    over: FlatTransition,
    timer: int,
    own: list[FlatTransition],
    partition: Partition,
) -> Channel | None:
    """The command whose answer ends the wait, as the timer does; None: it is not such a timer."""
    put = puts_one(start, partition).keys()
    waiting = ended(start, over, timer, partition)
    for command in partition.channels:
        if command.place not in put or command.kind is not ChannelKind.FLAG:
            continue
        said = {c.place for c in partition.channels if c.writer == command.reader}
        takers = [t for t in own if said & taken(t)]
        if takers and all(waiting & taken(t) for t in takers):
            return command
    return None
