"""Model time in a run of a cell that `verify` has found (docs/execution.md, *the cell as it runs*).

Programs may be late, so that the clock goes on whether or not something is enabled: by a unit at a time, and only while
something is waited for; but not while the supervisor fires.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.trace.lines import is_number
from pn2code.trace.parties import Parties


def stamps(marking: Marking) -> list[int | float]:
    """Of all tokens, each once."""
    timed = (tokens for tokens in marking.places if isinstance(tokens, TimedMultiSet))
    return sorted({t.stamp for tokens in timed for t in tokens})


class ModelTime:
    """The clock of one run.

    Args:
        game: what repeats the run.
        parties: who runs what.
    """

    def __init__(self, game: Game, parties: Parties) -> None:
        self._game = game
        self._supervisor = parties.certain(game.net)
        self._mine = {t.index for t in game.net.transitions if parties.owner[t.index] == 0}
        self._fires: int | float | None = None

    def problem(self, t: object) -> str | None:
        """What is wrong with the time of the next line; None: the clock can show it."""
        now = self._game.marking.time
        if not is_number(t) or t == now:
            return None
        if not self._game.net.timed:
            return f"it says time {t}, but without time the clock shows {now}"
        if t < now:
            return f"time goes back: {t} after {now}"
        if isinstance(t, float) and not (t.is_integer() or self._game.net.real_time):
            return f"it says time {t}, but model time is a whole number"
        last = max([now, *self._awaited()])
        if t > last:
            return f"it says time {t}, but after {last} nothing is waited for"
        return self._fires_on(t)

    def _awaited(self) -> Iterator[int | float]:
        yield from stamps(self._game.marking)
        for t in self._game.net.transitions:
            yield from self._game.enabling.thresholds(t, self._game.marking)

    def _fires_on(self, t: float) -> str | None:
        """Within a cycle of the supervisor no time goes by."""
        if self._fires != self._game.marking.time:
            return None
        for transition in self._supervisor:
            with suppress(GameError):
                if next(self._game.bindings(transition, self._game.marking), None) is not None:
                    return (
                        f"it says time {t}, but in its cycle at {self._fires} the supervisor fires "
                        f"`{transition.name}` as well"
                    )
        return None

    def occurred(self, transition: int) -> None:
        """A step has been made."""
        if transition in self._mine:
            self._fires = self._game.marking.time
