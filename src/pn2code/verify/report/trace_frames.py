"""A trace on the pages of its net: after each step the tokens, what has occurred, and what it has changed.

frames = list(follow(net, {}, Path("net.dead-40.trace.jsonl"), lambda n: True))
frames[-1].state.overlay(page, 1, Overlay())
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.drawing.state import State, enabled_in
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.verify.answers.path import Step, play

OCCURRED, CHANGED = "#ff8800", "#ffc078"
"""Around the transition that has occurred and its arcs; around the places that it has changed."""


@frozen
class TraceFrame:
    """A marking on the way.

    Args:
        number: steps so far; 0 at the start.
        step: the last of them; None at the start.
        state: what is drawn over the pages.
        involved: (id of a transition or place, number of the page instance) that the step is about.
    """

    number: int
    step: Step | None
    state: State
    involved: frozenset[tuple[str, int]]


def follow(
    net: FlatNet, storage: Mapping[str, str], trace: Path, wanted: Callable[[int], bool]
) -> Iterator[TraceFrame]:
    """The start and the marking after each step of a trace, checked by the token game.

    Args:
        net: the net.
        storage: as for `Game`.
        trace: a file by a simulator or by `verify`.
        wanted: by number of the step: what is not wanted is played, but not given.

    Raises:
        TraceRefusedError: the file is no trace of the net.
        GameError: an inscription raises an exception, or a step is not possible.
        OSError: it cannot be read.
    """
    game, played = play(net, storage, trace)
    if wanted(0):
        yield _moment(net, game, 0, None, None, game.marking)
    before = game.marking
    for step, transition in played:
        if wanted(step.number):
            yield _moment(net, game, step.number, step, transition, before)
        before = game.marking


def _moment(
    net: FlatNet,
    game: Game,
    number: int,
    step: Step | None,
    occurred: FlatTransition | None,
    before: Marking,
) -> TraceFrame:
    after = game.marking
    highlight: dict[tuple[str, int], str] = {}
    for place in net.place_instances:
        if before.places[place.place] != after.places[place.place]:
            highlight[place.id, place.number] = CHANGED
    if occurred is not None:
        highlight[occurred.id, occurred.instance_number] = OCCURRED
        for arc in occurred.arcs:
            highlight[arc.id, occurred.instance_number] = OCCURRED
    settled = game.advance_time(after)
    state = State(net, settled, enabled_in(game, settled), highlight)
    return TraceFrame(number, step, state, frozenset(highlight))
