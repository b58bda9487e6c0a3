"""Model time in a run of a cell that `verify` has found (docs/execution.md, *the cell as it runs*).

Programs may be late, so that the clock goes on whether or not something is enabled: by a unit at a time, and only while
something is waited for.
"""

from __future__ import annotations

from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.lines import is_number


def stamps(marking: Marking) -> list[int | float]:
    """Of all tokens, each once."""
    timed = (tokens for tokens in marking.places if isinstance(tokens, TimedMultiSet))
    return sorted({t.stamp for tokens in timed for t in tokens})


def model_time_problem(game: Game, t: object) -> str | None:
    """What is wrong with the model time of the next line; None: the clock can show it."""
    now = game.marking.time
    if not is_number(t) or t == now:
        return None
    if not game.net.timed:
        return f"it says time {t}, but without time the clock shows {now}"
    if t < now:
        return f"time goes back: {t} after {now}"
    if isinstance(t, float) and not (t.is_integer() or game.net.real_time):
        return f"it says time {t}, but model time is a whole number"
    awaited = stamps(game.marking)
    for transition in game.net.transitions:
        awaited += game.enabling.thresholds(transition, game.marking)
    last = max(now, *awaited) if awaited else now
    if t > last:
        return f"it says time {t}, but after {last} nothing is waited for"
    return None
