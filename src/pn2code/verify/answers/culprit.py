"""Which expression raises the exception that an exploration has met: the token game goes there and tries.

error = culprit(net, storage, trace, transition, binding)    # GameError with the text that raises it; None: not found
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from pathlib import Path

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.report import value_text
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verify.answers.path import play

MOST_STEPS = 3_000
"""A longer run is not played again."""


def culprit(
    net: FlatNet,
    storage: Mapping[str, str],
    trace: Path,
    transition: int,
    binding: Mapping[str, str] | None,
) -> GameError | None:
    """What the token game raises after a run.

    Args:
        net, storage: as for `Game`.
        trace: the run to the marking.
        transition: by index.
        binding: texts by variable, where it is an occurrence that raises it; None: the search for bindings.
    """
    try:
        game, played = play(net, storage, trace)
        if sum(1 for _ in islice(played, MOST_STEPS)) == MOST_STEPS:
            return None
    except (TraceRefusedError, GameError, OSError):
        return None
    try:
        _try(game, transition, binding)
    except GameError as error:
        return error
    return None


def _try(game: Game, transition: int, binding: Mapping[str, str] | None) -> None:
    t = game.net.transitions[transition]
    if game.net.timed:
        game.advance()
    for found in game.enabling.enabled(t, game.marking):
        texts = {s.name: value_text(s, v) for s, v in found.items()}
        if binding is not None and texts.items() >= binding.items():
            game.occur(game.marking, BindingElement.make(t, found))
