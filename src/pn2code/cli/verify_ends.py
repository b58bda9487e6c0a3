"""Why nothing can occur after a run, in lines: which transitions are nearest to it, and what each program waits for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

from pn2code.cell.partition import SUPERVISOR, Partition
from pn2code.cli.verify_rows import count_of
from pn2code.net.flat import ArcKind, Role
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.script import TraceRefusedError
from pn2code.verdict.whole import Said
from pn2code.verify.answers import why_disabled
from pn2code.verify.answers.path import play
from pn2code.verify.answers.waiting import Scripts
from pn2code.verify.answers.who_waits import lacks_messages_alone, supervisor_waits

MOST_NEAR = 6
"""Transitions that are named where there is room for all of it."""
MOST_STEPS = 3_000
"""A longer run is not played again: its last steps are shown as they are recorded."""


def why_it_ends(said: Said, file: Path, is_deadlock: bool) -> list[str]:
    """Why nothing can occur after a run; nothing where something can, or the run is too long to be played."""
    try:
        game, played = play(said.net, said.storage, file)
        if sum(1 for _ in islice(played, MOST_STEPS)) == MOST_STEPS:
            return []
        return after_that(why_all_disabled(said, game, is_deadlock))
    except (TraceRefusedError, GameError, OSError):
        return []  # the run is told above, with what is wrong with it


def after_that(why: Sequence[str]) -> list[str]:
    """Lines that say why nothing can occur after a run."""
    return ["  After that nothing can occur:", *(f"    {x}" for x in why)] if why else []


def why_all_disabled(
    said: Said, game: Game, is_deadlock: bool, most: int | None = None
) -> list[str]:
    """Which transitions are nearest to occurring and what they lack, then what each program waits for.

    A transition that lacks messages alone is not named again where it is said what its program waits for.
    A cell may be in a deadlock where its closed net can go on.

    Args:
        most: lines; where there are more, some of the programs are only counted, but the transitions are named: where
            every program waits for a message, it is they that tell which token somebody has forgotten.

    Raises:
        GameError: an inscription raises an exception.
    """
    near_ones = MOST_NEAR if most is None else why_disabled.MOST_REASONS
    running = said.control.running if said.control is not None else None
    if running is None or said.config is None:
        return why_disabled.reasons(game, most=near_ones)[:most]
    if game.advance() and not is_deadlock:
        return []
    partition = running.partition
    stand = Scripts.of(partition, said.config).standing(game)
    supervisor = supervisor_waits(game, partition)
    if supervisor:
        stand[0] = supervisor
    waiting = {
        t.index
        for t, owner in zip(game.net.transitions, partition.transition_owner, strict=True)
        if owner in stand and lacks_messages_alone(game, partition, t)
    }
    others = [t for t in game.net.transitions if t.index not in waiting and t.role is Role.OWN]
    programs = [stand[k] for k in sorted(stand)]
    near = why_disabled.reasons(game, others, near_ones)
    near += _other_end(game, partition)
    room = len(programs) if most is None else max(most - len(near), 1)
    if len(programs) > room:
        rest = len(programs) - max(room - 1, 1)
        programs[-rest:] = [
            f"And {count_of(rest, 'program')} more: `--full` says what each waits for."
        ]
    return [*near, *programs]


def _other_end(game: Game, partition: Partition) -> list[str]:
    """The place in which the supervisor has ended, where nobody takes a token away, but which is not said to be final.

    Nothing where there is no one such place, or the cell has come to its end.
    """

    def holds(place: int) -> bool:
        return any(True for _ in game.marking.places[place])

    if any(holds(p) for p in partition.final_places):
        return []
    net, first = game.net, game.own_initial_marking.places
    used = {a.place for t in net.transitions for a in t.arcs if a.kind is not ArcKind.OUTPUT}
    put = {
        a.place
        for t, owner in zip(net.transitions, partition.transition_owner, strict=True)
        if owner == SUPERVISOR
        for a in t.arcs
    }
    ends = [p for p in put - used if holds(p) and not any(True for _ in first[p])]
    if len(ends) != 1:
        return []
    return [
        f"Nothing takes the token of `{net.places[ends[0]].short}` away: if the cell may end there, add this place to "
        "`final` in [supervisor] of cell.toml."
    ]
