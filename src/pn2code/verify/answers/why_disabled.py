"""Why nothing can occur in a marking: the transitions that lack least, and what each of them lacks.

    `Order` cannot occur: its guard `n > 9` is false for the tokens that are there.
    `StartPress` cannot occur: place `placed` is empty.

A transition none of whose input places holds a token is not worth a line. It is the reference token game that answers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from pn2code.net.flat import ArcKind, FlatArc, FlatTransition
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game

MOST_REASONS = 3
"""So many transitions are named."""
_MOST_TEXT = 60
"""Characters of a guard."""


def reasons(game: Game, among: Iterable[FlatTransition] | None = None) -> list[str]:
    """A sentence for each of the transitions that lack least; empty where something can occur.

    Args:
        game: in the marking.
        among: the transitions that are looked at; None: all.

    Raises:
        GameError: an inscription raises an exception.
    """
    if game.advance():
        return []
    found: list[tuple[int, str]] = []
    for t in game.net.transitions if among is None else among:
        inputs = list(_inputs(t))
        empty = {a.place for a in inputs if not _holds(game.marking, a.place)}
        if inputs and len(empty) == len({a.place for a in inputs}):
            continue
        name = t.name.rpartition(".")[2]
        found.append((len(empty), f"`{name}` cannot occur: {_lack(game, t, sorted(empty))}."))
    least = sorted(found, key=lambda row: row[0])[:MOST_REASONS]
    return [text for _, text in least]


def _inputs(t: FlatTransition) -> Iterator[FlatArc]:
    return (a for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.BOTH))


def _holds(marking: Marking, place: int) -> bool:
    return any(True for _ in marking.places[place])


def _lack(game: Game, t: FlatTransition, empty: list[int]) -> str:
    """What keeps the transition from occurring, as a clause."""
    if empty:
        names = [f"`{game.net.places[p].short}`" for p in empty]
        if len(names) == 1:
            return f"place {names[0]} is empty"
        return f"places {', '.join(names[:-1])} and {names[-1]} are empty"
    marking = game.marking
    for arc in t.arcs:
        if arc.kind is ArcKind.INHIBITOR and game.enabling.inhibited(arc, marking):
            return f"place `{game.net.places[arc.place].short}` inhibits it"
    if t.guards and _is_possible_without_guards(game, t):
        guards = ", ".join(" ".join(g.span.text.split()) for g in t.guards)
        shown = guards if len(guards) <= _MOST_TEXT else f"{guards[: _MOST_TEXT - 3]}..."
        return f"its guard `{shown}` is false for the tokens that are there"
    places = dict.fromkeys(f"`{game.net.places[a.place].short}`" for a in _inputs(t))
    return f"the tokens in {' and '.join(places)} are not those that its arcs take"


def _is_possible_without_guards(game: Game, t: FlatTransition) -> bool:
    """Whether it is the guard alone that keeps it from occurring.

    Guards that give a variable its value still do so: that is a part of the plan.
    """
    bare = replace(t, guards=())
    net = replace(
        game.net, transitions=tuple(bare if x.index == t.index else x for x in game.net.transitions)
    )
    return next(Enabling(net, game.evaluator).enabled(bare, game.marking), None) is not None
