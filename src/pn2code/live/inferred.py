"""What must have happened where nobody has written it down: a shortest run of the net that explains what was seen.

    path = explain(game, start, transitions, is_goal)
    path[-1].marking

The transitions are those of the parties that write no trace. Another run might explain it as well: what is found is
inferred, and whoever shows it says so.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.net.flat import FlatTransition
from pn2code.semantics.game.errors import GivenUpError
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game, GameError

MOST_MARKINGS = 1500
"""That are looked at; behind them the explanation is given up."""
MOST_BINDINGS = 64
"""Of a transition in a marking: one that a sensor decides may have very many."""


_Node = tuple[Marking, tuple[int, ...]]


@frozen
class InferredStep:
    """An occurrence, and the marking after it."""

    element: BindingElement
    marking: Marking


def explain(
    game: Game,
    start: Marking,
    transitions: Sequence[FlatTransition],
    is_goal: Callable[[Marking], bool],
    *,
    arrivals: Mapping[int, int] | None = None,
    most: int = MOST_MARKINGS,
) -> list[InferredStep] | None:
    """A shortest run from `start`, of these transitions only, to a marking that is a goal; None: none was found.

    An empty list: `start` is one.

    Args:
        arrivals: by place, how many tokens exactly must come into it on the way; other places are free.
    """
    wanted = dict(arrivals or {})
    first: _Node = (start, (0,) * len(wanted))
    last = tuple(wanted.values())

    def is_end(node: _Node) -> bool:
        return node[1] == last and is_goal(node[0])

    if is_end(first):
        return []
    came: dict[_Node, tuple[_Node, InferredStep] | None] = {first: None}
    queue: deque[_Node] = deque([first])
    while queue and len(came) < most:
        before = queue.popleft()
        for step in _steps(game, before[0], transitions):
            used = tuple(
                n + (_size(step.marking, place) > _size(before[0], place))
                for place, n in zip(wanted, before[1], strict=True)
            )
            node = (step.marking, used)
            if node in came or any(n > limit for n, limit in zip(used, last, strict=True)):
                continue
            came[node] = (before, step)
            if is_end(node):
                return _path(came, node)
            queue.append(node)
    return None


def _size(marking: Marking, place: int) -> int:
    return len(marking.places[place])


def _steps(
    game: Game, marking: Marking, transitions: Sequence[FlatTransition]
) -> list[InferredStep]:
    found: list[InferredStep] = []
    for t in transitions:
        try:
            for n, binding in enumerate(game.bindings(t, marking)):
                if n == MOST_BINDINGS:
                    break
                element = BindingElement.make(t, binding)
                after, occurred = game.occur(marking, element)
                found.append(InferredStep(occurred, after))
        except (GameError, GivenUpError):
            continue
    return found


def _path(came: dict[_Node, tuple[_Node, InferredStep] | None], at: _Node) -> list[InferredStep]:
    path: list[InferredStep] = []
    while (before := came[at]) is not None:
        at, step = before
        path.append(step)
    return path[::-1]
