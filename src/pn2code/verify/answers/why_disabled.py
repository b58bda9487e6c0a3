"""Why nothing can occur in a marking: the transitions that lack least, and what each of them lacks.

    `Order` cannot occur: its guard `n > 9` is false for the tokens that are there.
    `StartPress` cannot occur: place `placed` is empty.

    `Feed` cannot occur: place `TableFree` is empty, which it was not at the start.

A transition that could occur if its empty places held what they held at the start comes first: somebody did not give
back what he took. A transition none of whose input places holds a token is not worth a line. Nor is one whose only
tokens are those that never leave their places (of a mode, a counter), if there are others: such a token says nothing
about who is near. Of those that lack equally many tokens the ones that have most come first. It is the reference token
game that answers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from pn2code.net.flat import ArcKind, FlatArc, FlatTransition
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException

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
    kept = _kept(game)
    found: list[tuple[int, bool, int, str]] = []
    for t in game.net.transitions if among is None else among:
        inputs = list(_inputs(t))
        empty = {a.place for a in inputs if not _holds(game.marking, a.place)}
        if inputs and len(empty) == len({a.place for a in inputs}):
            continue
        name = t.name.rpartition(".")[2]
        arrived = len({a.place for a in inputs} - empty - kept)
        was_possible = bool(empty) and _is_possible_with_first(game, t, empty)
        lack = _lack(game, t, sorted(empty))
        if was_possible:
            lack += f", which {'it was' if len(empty) == 1 else 'they were'} not at the start"
        row = (0 if was_possible else len(empty), not was_possible, arrived)
        found.append((*row, f"`{name}` cannot occur: {lack}."))
    near = [row for row in found if row[2] or not row[0]] or found
    least = sorted(near, key=lambda row: (row[0], row[1], -row[2]))[:MOST_REASONS]
    return [text for *_, text in least]


def _is_possible_with_first(game: Game, t: FlatTransition, empty: set[int]) -> bool:
    """Whether it could occur if its empty places held what they held at the start."""
    first = game.own_initial_marking.places
    if any(not any(True for _ in first[p]) for p in empty):
        return False
    places = tuple(first[p] if p in empty else x for p, x in enumerate(game.marking.places))
    marking = replace(game.marking, places=places)
    try:
        return next(game.enabling.enabled(t, marking), None) is not None
    except (GameError, MlException):
        return False


def _kept(game: Game) -> set[int]:
    """The places in which something lies now and whose tokens each transition that takes one gives back."""
    takes_away = set()
    for t in game.net.transitions:
        given = {a.place for a in t.arcs if a.kind is ArcKind.OUTPUT}
        taken = {a.place for a in t.arcs if a.kind in (ArcKind.INPUT, ArcKind.RESET)}
        takes_away |= taken - given
    return {p.index for p in game.net.places if _holds(game.marking, p.index)} - takes_away


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
