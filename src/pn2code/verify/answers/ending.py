"""Where a run ends because nothing can occur any more: what everybody waits for, and what transitions lack.

lines = sentences(game, partition)            # of a game at the end of a run; [] where something can occur
lines = after(net, storage, trace, partition) # the same of a trace
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from pathlib import Path

from pn2code.cell.partition import Partition
from pn2code.net.flat import FlatNet
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.answers.path import play
from pn2code.verify.answers.who_waits import waiting
from pn2code.verify.answers.why_disabled import reasons

HEAD = "  After that nothing can occur:"
MOST_STEPS = 3_000
"""A longer run is not played again."""


def sentences(game: Game, partition: Partition | None) -> list[str]:
    """In the marking of a game; of a cell its programs come first, then the transitions of those that do not wait.

    Raises:
        GameError: an inscription raises an exception.
    """
    if game.advance():
        return []
    if partition is None:
        return reasons(game)
    waits = waiting(game, partition)
    owners = partition.transition_owner
    others = [t for t in game.net.transitions if owners[t.index] not in waits]
    return [*waits.values(), *reasons(game, others)]


def after(
    net: FlatNet, storage: Mapping[str, str], trace: Path, partition: Partition | None
) -> list[str]:
    """Lines for a report at the end of a trace; none of a run that is too long, or cannot be played."""
    try:
        game, played = play(net, storage, trace)
        steps = sum(1 for _ in islice(played, MOST_STEPS))
        found = sentences(game, partition) if steps < MOST_STEPS else []
    except (TraceRefusedError, GameError, OSError):
        return []
    return [HEAD, *(f"    {x}" for x in found)] if found else []
