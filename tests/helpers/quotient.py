"""Time equivalence by the reference token game: states that differ only in how late it is are one.

The class of a marking is its marking with the stamps counted from its time on, and those not after it 0. Each class is
expanded from the marking by which it was found first, at its true time.
"""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field, replace

from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.marking import Marking, binding_to_json, place_to_json
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import Timed
from pn2code.semantics.values.multiset import TimedMultiSet


@dataclass(slots=True)
class Quotient:
    """Classes in the order in which they were found, as text, and arcs: numbers of classes, transition and binding."""

    nodes: list[str] = field(default_factory=list)
    arcs: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    dead: int = 0


def aged(marking: Marking) -> Marking:
    """What stands for the class of a marking."""
    now = marking.time
    places = tuple(
        TimedMultiSet.of(Timed(t.value, max(t.stamp - now, 0)) for t in tokens)
        if isinstance(tokens, TimedMultiSet)
        else tokens
        for tokens in marking.places
    )
    return replace(marking, time=0, places=places)


def quotient(flat: FlatNet, most: int = 2000) -> Quotient:
    """The whole of it; fails when it has more classes than that."""
    game = Game(flat, {}, files=Files(None))
    found = Quotient()
    names: dict[str, str] = {}

    def text(marking: Marking) -> str:
        alike = aged(marking)
        return json.dumps(
            {
                p.name: place_to_json(game.colours, p.colset, alike.places[p.index])
                for p in flat.places
            },
            sort_keys=True,
        )

    waiting = [game.marking]
    names[text(game.marking)] = ""
    found.nodes.append(text(game.marking))
    while waiting:
        marking = waiting.pop(0)
        source = text(marking)
        settled = game.advance_time(marking)
        elements = game.enabled_in(settled)
        found.dead += not elements
        for element in elements:
            after, occurred = game.occur(settled, element)
            target = text(after)
            label = json.dumps(
                [flat.transitions[element.transition].name, binding_to_json(occurred)],
                sort_keys=True,
            )
            found.arcs[source, target, label] += 1
            if target not in names:
                names[target] = ""
                found.nodes.append(target)
                waiting.append(after)
                assert len(found.nodes) <= most, "the quotient is large"
    return found
