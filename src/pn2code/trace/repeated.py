"""Lines of a trace that say what another line has said before: the step is made again without looking at its texts.

    steps = Repeated(game, rules.priorities, parties)
    steps.learn(text, line, occurred)        # after a step that was looked at in full
    line, occurred = steps.repeat(text)      # the same words later; None: they must be looked at

Only steps are repeated whose effect is the same in every marking (`constant_transitions`), by lines that differ in
their step number alone. Whether the tokens are there is looked at each time; if not, who asks looks for the reason.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.net.flat import ArcKind, BindTerm, FlatNet, FlatTransition
from pn2code.semantics.game.constant import constant_transitions
from pn2code.semantics.game.marking import Binding, BindingElement, PlaceMarking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Value, zero_signs
from pn2code.semantics.values.multiset import MultiSet
from pn2code.trace.parties import Parties

_LINE = re.compile(r'\{"step": ([1-9][0-9]{0,15}), ("t": .*\})\n?', re.DOTALL)
MOST = 50_000
"""Lines that are remembered; then all are forgotten."""


@frozen
class _Known:
    """What a line says, and what it does: by place the tokens that it takes, and those that it puts, in order."""

    line: Mapping[str, Any]
    occurred: BindingElement
    changes: tuple[tuple[int, tuple[tuple[Value, int], ...], tuple[tuple[Value, int], ...]], ...]


class Repeated:
    """The steps of one replay that can be made again.

    Args:
        game: what repeats them.
        priorities: whether those of all transitions hold; else those of one party.
        parties: who runs what.
    """

    def __init__(self, game: Game, priorities: bool, parties: Parties) -> None:
        self._game = game
        self._may = _without_rivals(game.net, priorities, parties)
        self._seen: set[str] = set()
        self._known: dict[str, _Known] = {}

    def learn(self, text: str, line: Mapping[str, Any], occurred: BindingElement) -> None:
        """A step has been made and looked at."""
        t = self._game.net.transitions[occurred.transition]
        if t.index not in self._may or (found := _LINE.fullmatch(text)) is None:
            return
        if found[2] not in self._seen:  # most lines of some traces are unlike all others
            if len(self._seen) >= MOST:
                self._seen.clear()
            self._seen.add(found[2])
            return
        if any(True for _, value in occurred.values for _ in zero_signs(value)):
            return  # equal zeros may differ in the sign, and the sign of a token is looked at
        if len(self._known) >= MOST:
            self._known.clear()
        game, binding = self._game, occurred.binding
        if not self._takes_what_binds(t, binding):
            return
        takes: dict[int, list[tuple[Value, int]]] = {}
        puts: dict[int, list[tuple[Value, int]]] = {}
        for demand in game.enabling.demands(t, binding):
            takes.setdefault(demand.place, []).append((demand.value, demand.count))
        for arc in t.arcs:
            if arc.kind in (ArcKind.OUTPUT, ArcKind.BOTH):
                put = game.put(MultiSet(), arc, binding, 0, game.marking.time)
                assert isinstance(put, MultiSet), "a net without time"
                puts.setdefault(arc.place, []).extend(put.counts.items())
        places = dict.fromkeys((*takes, *puts))
        changes = tuple((p, tuple(takes.get(p, ())), tuple(puts.get(p, ()))) for p in places)
        self._known[found[2]] = _Known(line, occurred, changes)

    def _takes_what_binds(self, t: FlatTransition, binding: Binding) -> bool:
        """Whether each token from which variables get their values is taken: of 0`n one has to be there, none is."""
        for step in t.plan:
            if isinstance(step, BindTerm):
                inscription = t.arcs[step.arc].inscription
                assert inscription is not None, "it has a pattern"
                n: Any = self._game.evaluator.value(
                    inscription.terms[step.term].coefficient, binding
                )
                if n <= 0:
                    return False
        return True

    def repeat(self, text: str) -> tuple[Mapping[str, Any], BindingElement] | None:
        """Makes the step of a line again; None, and nothing has happened: it has to be looked at."""
        found = _LINE.fullmatch(text)
        known = self._known.get(found[2]) if found is not None else None
        if found is None or known is None:
            return None
        game = self._game
        places: list[PlaceMarking] = list(game.marking.places)
        for place, takes, puts in known.changes:
            counts = dict(places[place].counts)  # type: ignore[union-attr] # a net without time
            for value, n in takes:
                left = counts.get(value, 0) - n
                if left > 0:
                    counts[value] = left
                elif left == 0:
                    del counts[value]
                else:
                    return None
            for value, n in puts:
                counts[value] = counts.get(value, 0) + n
            places[place] = MultiSet(counts)
        game.marking = replace(game.marking, places=tuple(places))
        game.steps += 1
        return {**known.line, "step": int(found[1])}, known.occurred


def _without_rivals(net: FlatNet, priorities: bool, parties: Parties) -> frozenset[int]:
    """Transitions whose steps are the same in all markings, and before which no other one goes."""
    best = min((t.priority for t in net.transitions), default=0)
    return frozenset(
        index
        for index in constant_transitions(net)
        if (
            net.transitions[index].priority == best
            if priorities
            else not parties.rivals(net, index)
        )
    )
