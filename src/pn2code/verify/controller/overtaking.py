"""Whether scripts could take their messages as they do in a run of the cell.

A script that waits for several messages takes, when it is woken, the first transition in its order that is possible. In
the cell as it runs (`running`) a later one may occur although an earlier one is possible as well (`Running.meek`): the
message of the earlier one may have come after the script had looked for it. That is so only if, since the script last
did something, the later one was possible at a time when the earlier one was not; or if a third one was, which comes
after both and has woken the script: it has asked for the earlier one then, and the messages of both have come before it
asks for the later one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from pn2code.net.flat import ArcKind, FlatTransition
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException, MlLimit
from pn2code.trace.played import game_of
from pn2code.trace.script import Trace, TraceRefusedError
from pn2code.verify.controller.running import Running

MOST_STEPS = 3_000
"""Longer runs take the token game too long; of them it is not known."""


def is_in_order(running: Running, storage: Mapping[str, str], trace: Path) -> bool | None:
    """Whether the programs can have done this.

    Args:
        running: the cell as it runs.
        storage: as for `Game`.
        trace: a run of its net, with the steps of programs.

    Returns:
        None: that is not known, since the run is too long, or the token game cannot play it.
    """
    earlier = _earlier(running)
    if not earlier:
        return True
    try:
        return _played(running, storage, trace, earlier)
    except (TraceRefusedError, GameError, OSError, ValueError, MlException, MlLimit):
        return None


def _played(
    running: Running,
    storage: Mapping[str, str],
    trace: Path,
    earlier: Mapping[int, Sequence[FlatTransition]],
) -> bool | None:
    opened = Trace.open(trace, running.net, is_shown=True)
    game = game_of(opened, running.net, storage)
    owners = running.partition.transition_owner
    wakers = _wakers(running, earlier)
    since: dict[int, list[Marking]] = {owner: [] for owner in set(owners)}
    for number, step in enumerate(opened.steps(), 1):
        if number > MOST_STEPS:
            return None
        if step.time is not None and step.time > game.marking.time:
            game.set_time(step.time)
        t = step.transition.index
        if t < len(owners):
            seen = [*since[owners[t]], game.marking]
            rivals, others = earlier.get(t, ()), wakers.get(t, ())
            if not _may_come_first(game, step.transition, rivals, others, seen):
                return False
        game.fire(BindingElement.make(step.transition, step.bound), checked=False)
        for owner, markings in since.items():
            if t < len(owners) and owners[t] == owner:
                markings.clear()
            else:
                markings.append(game.marking)
    return True


def _earlier(running: Running) -> dict[int, list[FlatTransition]]:
    """By transition of a script those that come before it, and that the model lets it overtake."""
    net, owners = running.partition.net, running.partition.transition_owner
    meek = [running.net.transitions[i] for i in running.meek]
    return {
        t.index: rivals
        for t in net.transitions
        if (
            rivals := [
                r
                for r in meek
                if owners[r.index] == owners[t.index]
                and (r.priority, r.index) < (t.priority, t.index)
            ]
        )
    }


def _wakers(
    running: Running, earlier: Mapping[int, Sequence[FlatTransition]]
) -> dict[int, list[FlatTransition]]:
    """By transition with rivals those that compete with it and come later."""
    net, owners = running.partition.net, running.partition.transition_owner
    channels = {c.place for c in running.partition.channels}

    def own(t: FlatTransition) -> set[int]:
        return {a.place for a in t.arcs if a.kind is ArcKind.INPUT} - channels

    return {
        i: [
            running.net.transitions[u.index]
            for u in net.transitions
            if owners[u.index] == owners[i]
            and (u.priority, u.index) > (net.transitions[i].priority, i)
            and own(u) & own(net.transitions[i])
        ]
        for i in earlier
    }


def _may_come_first(
    game: Game,
    t: FlatTransition,
    rivals: Sequence[FlatTransition],
    others: Sequence[FlatTransition],
    seen: Sequence[Marking],
) -> bool:
    """Whether a transition can have been taken before each rival that is possible in the last marking as well.

    Args:
        game: of the cell as it runs.
        t: the transition.
        rivals: those that come before it.
        others: those that come after it.
        seen: the markings since the script last did something.
    """
    possible = [r for r in rivals if _is_possible(game, r, seen[-1])]
    if all(
        any(_is_possible(game, t, m) and not _is_possible(game, r, m) for m in seen)
        for r in possible
    ):
        return True
    return any(
        any(_is_possible(game, u, m) for u in others)
        and not any(_is_possible(game, r, m) for r in possible)
        for m in seen
    )


def _is_possible(game: Game, t: FlatTransition, marking: Marking) -> bool:
    return next(game.bindings(t, marking), None) is not None
