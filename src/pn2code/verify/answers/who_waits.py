"""Where nothing can occur in a cell: the messages that the supervisor waits for (of scripts see `waiting`).

supervisor_waits(game, partition)     # "The supervisor waits: `Arrived` needs a message in `done`."

It waits with a transition when all that this takes from the supervisor's own places is there, what its guard asks of
it holds, and messages are missing. It is the reference token game that answers.
"""

from __future__ import annotations

from dataclasses import replace

from pn2code.cell.partition import OwnerKind, Partition
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL
from pn2code.net.flat import ArcKind, BindEquation, BindStep, BindTerm, FlatTransition, Role
from pn2code.net.uses import NetVariables, pattern_variables
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.token_game import Game, GameError

MOST_NAMES = 4
"""Transitions, channels and ways that are named."""
_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


def supervisor_waits(game: Game, partition: Partition) -> str:
    """A sentence; "": it does not wait for messages in the marking of the game."""
    channels = {c.place: c.name for c in partition.channels}
    needs: dict[tuple[int, ...], list[FlatTransition]] = {}
    for t, index in zip(game.net.transitions, partition.transition_owner, strict=True):
        inputs = [a.place for a in t.arcs if a.kind in _TAKING]
        missing = [p for p in inputs if p in channels and not _holds(game, p)]
        own = [p for p in inputs if p not in channels]
        is_supervisor = partition.owners[index].kind is OwnerKind.SUPERVISOR
        if (
            is_supervisor
            and t.role
            is Role.OWN  # that of a register waits all the time, and for nothing that is missing
            and missing
            and all(_holds(game, p) for p in own)
            and _fits(game, t, missing)
        ):
            needs.setdefault(tuple(dict.fromkeys(missing)), []).append(t)
    if not needs:
        return ""
    parts = []
    for places, transitions in list(needs.items())[:MOST_NAMES]:
        names = _listed([f"`{t.short}`" for t in transitions])
        files = [f"`{channels[p]}`" for p in places]
        verb = "needs" if len(transitions) == 1 else "need"
        what = "a message" if len(files) == 1 else "messages"
        parts.append(f"{names} {verb} {what} in {_listed(files)}")
    more = f", and {len(needs) - MOST_NAMES} more ways" if len(needs) > MOST_NAMES else ""
    return f"The supervisor waits: {'; '.join(parts)}{more}."


def lacks_messages_alone(game: Game, partition: Partition, t: FlatTransition) -> bool:
    """Whether tokens are missing, and only in channels."""
    channels = {c.place for c in partition.channels}
    empty = {a.place for a in t.arcs if a.kind in _TAKING and not _holds(game, a.place)}
    return bool(empty) and empty <= channels


def _listed(names: list[str]) -> str:
    if len(names) > MOST_NAMES:
        return f"{', '.join(names[:MOST_NAMES])} and {len(names) - MOST_NAMES} more"
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def _holds(game: Game, place: int) -> bool:
    return any(True for _ in game.marking.places[place])


def _fits(game: Game, t: FlatTransition, missing: list[int]) -> bool:
    """Whether it could occur as far as that does not depend on the messages that are missing."""
    uses = NetVariables(game.net.program.variables)
    known: set[int] = set()
    plan: list[BindStep] = []
    for step in t.plan:
        if isinstance(step, BindTerm) and t.arcs[step.arc].place not in missing:
            inscription = t.arcs[step.arc].inscription
            pattern = inscription.terms[step.term].pattern if inscription is not None else None
            assert pattern is not None, "what binds is a pattern"
            known |= {s.uid for s in pattern_variables(pattern)}
            plan.append(step)
        elif isinstance(step, BindEquation) and {s.uid for s in uses.of(step.value)} <= known:
            known |= {s.uid for s in pattern_variables(step.pattern)}
            plan.append(step)

    def is_known(e: core.Exp) -> bool:
        return {s.uid for s in uses.of(e)} <= known

    taken = [a for a in t.arcs if a.kind in _TAKING and a.place not in missing]
    if not all(a.inscription is None or is_known(a.inscription.value) for a in taken):
        return True  # which of its own tokens it takes depends on the message
    true = next(c for c, _ in game.net.program.datatypes["bool"].constructors if c.name == "true")
    guards = tuple(g if is_known(g) else core.Con(true, BOOL, g.span) for g in t.guards)
    arcs = tuple(
        replace(a, kind=ArcKind.OUTPUT) if a.kind in _TAKING and a.place in missing else a
        for a in t.arcs
    )
    bare = replace(t, arcs=arcs, guards=guards, plan=tuple(plan))
    net = replace(
        game.net, transitions=tuple(bare if x.index == t.index else x for x in game.net.transitions)
    )
    try:
        return next(Enabling(net, game.evaluator).enabled(bare, game.marking), None) is not None
    except GameError:
        return False
