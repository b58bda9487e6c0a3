"""A run as a trace, written while the token game plays it, and the game in which a trace of the explorer is played.

written(net, storage, elements, Path("net.trace.jsonl"))      # False: the file cannot be written
game = game_of(Trace.open(path, net), net, storage)           # at the start of the trace
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import closing
from pathlib import Path

from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace.script import Trace
from pn2code.trace.writing import TraceFile, TraceUnwritableError


def game_of(trace: Trace, net: FlatNet, storage: Mapping[str, str]) -> Game:
    """The game at the start of a trace, with its initial marking and its random numbers.

    Raises:
        GameError: a declaration or an initial marking raises an exception.
    """
    header = trace.header
    return Game(
        net,
        storage,
        header.initial or None,
        seed=header.seed or 1,
        still=header.still,
        files=Files(None),
    )


def written(
    net: FlatNet, storage: Mapping[str, str], elements: Iterable[BindingElement], path: Path
) -> bool:
    """Writes the run of these elements from the initial marking on; False: it cannot be written.

    Where nothing is enabled before an element, time goes on first.

    Args:
        net, storage: as for `Game`.
        elements: without what code segments give.
        path: the file.

    Raises:
        GameError: an inscription raises an exception.
        NotEnabled: an element is not enabled.
    """
    game = Game(net, storage, files=Files(None))
    try:
        with closing(TraceFile(path)) as file:
            file.header(game, "reference", 1)
            for element in elements:
                game.marking = game.advance_time(game.marking)
                file.occurrence(game, game.fire(element))
            is_over = not game.enabled_transitions(game.advance_time(game.marking))
            file.end(game.marking.time, "finished" if is_over else "steps")
    except TraceUnwritableError:
        return False
    return True
