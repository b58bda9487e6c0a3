"""The bindings of a transition that are enabled: a list that is cut where it becomes long, and a choice at random.

found = listed(game, t, filters, most=200)
found.elements, found.is_cut
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Exp
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.errors import running
from pn2code.semantics.game.marking import Binding, BindingElement
from pn2code.semantics.game.token_game import Game

MOST_LISTED = 200
MOST_SECONDS = 3.0
"""Of looking for bindings; what was found by then is listed."""
_LOOK = 64


@frozen
class Listed:
    """Enabled binding elements of a transition.

    Args:
        elements: those that are listed.
        seen: how many were looked at.
        is_cut: there are more than those that are listed, or there may be.
    """

    elements: tuple[BindingElement, ...]
    seen: int
    is_cut: bool


def listed(
    game: Game, t: FlatTransition, filters: Sequence[Exp] = (), most: int = MOST_LISTED
) -> Listed:
    """The bindings that are enabled now and pass all filters, in the documented order.

    Raises:
        GameError: an inscription or a filter raises an exception.
    """
    found: list[BindingElement] = []
    seen, over = 0, time.monotonic() + MOST_SECONDS
    for binding in _enabled(game, t):
        seen += 1
        if _passes(game, t, binding, filters):
            if len(found) == most:
                return Listed(tuple(found), seen, True)
            found.append(BindingElement.make(t, binding))
        if seen % _LOOK == 0 and time.monotonic() > over:
            return Listed(tuple(found), seen, True)
    return Listed(tuple(found), seen, False)


def _enabled(game: Game, t: FlatTransition) -> Iterator[Binding]:
    enabled, raising = game.enabled_or_raising(game.marking)
    if t.index in raising:
        raise raising[t.index]
    if t in enabled:
        yield from game.enabling.enabled(t, game.marking)


def _passes(game: Game, t: FlatTransition, binding: Binding, filters: Sequence[Exp]) -> bool:
    if not filters:
        return True
    values = {s: binding[s] for s in t.variables if s in binding}
    with running(t.origin, "the filter"):
        return all(game.evaluator.value(f, values) is True for f in filters)
