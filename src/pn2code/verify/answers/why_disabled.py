"""Why nothing can occur in a marking: the transitions that are nearest to it, and what each of them lacks.

    `Doubt` cannot occur: its guard `length l >= 2` is false with l = [3].
    `Feed` cannot occur: place `TableFree` is empty, which it was not at the start.
    `StartPress` cannot occur: place `placed` is empty.
    `Finish` cannot occur: place `Cleans` holds 2`(), its arc takes 3`().

In this order:

* all tokens are there, one of them in a place that was empty at the start, and a guard is false (or a place inhibits
  it): something has come there, and cannot go on;
* it could occur if its empty places held what they held at the start: somebody did not give back what he took;
* all others: first those of which only the guard is false, then those that lack a token, then two, and so on.

A transition none of whose input places holds a token is not worth a line. Nor is one whose only tokens are those that
never leave their places (of a mode, a counter), if there are others: such a token says nothing about who is near. Of
those that lack equally many tokens the ones that have most come first. It is the reference token game that answers.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import islice

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind, BindTerm, FlatArc, FlatTransition
from pn2code.semantics.evaluation.used_symbols import variables
from pn2code.semantics.game.demands import Demand
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.errors import NoMatchError
from pn2code.semantics.game.marking import Binding, Marking, place_text, variable_text
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.semantics.values.data import MlException
from pn2code.semantics.values.multiset import MultiSet

MOST_REASONS = 3
"""So many transitions are named."""
_MOST_TEXT = 60
"""Characters of a guard, or of tokens."""
_MOST_BINDINGS = 1_000
"""So many are asked which places hold too little for them."""


@frozen
class _Lack:
    """What keeps a transition from occurring, as a clause, and so many tokens are missing; 0: it is something else."""

    says: str
    tokens: int


def reasons(
    game: Game, among: Iterable[FlatTransition] | None = None, most: int = MOST_REASONS
) -> list[str]:
    """A sentence for each of the transitions that are nearest; empty where something can occur.

    Args:
        game: in the marking.
        among: the transitions that are looked at; None: all.
        most: so many sentences.

    Raises:
        GameError: an inscription raises an exception.
    """
    if game.advance():
        return []
    kept = _kept(game)
    first = game.own_initial_marking.places
    found: list[tuple[tuple[int, int, int], str]] = []
    for t in game.net.transitions if among is None else among:
        inputs = list(_inputs(t))
        empty = {a.place for a in inputs if not _holds(game.marking, a.place)}
        if inputs and len(empty) == len({a.place for a in inputs}):
            continue
        name = t.name.rpartition(".")[2]
        arrived = {a.place for a in inputs} - empty - kept
        was_possible = bool(empty) and _is_possible_with_first(game, t, empty)
        lack = _lack(game, t, sorted(empty))
        says = lack.says
        if empty and all(any(True for _ in first[p]) for p in empty):
            says += f", which {'it was' if len(empty) == 1 else 'they were'} not at the start"
        has_come = lack.tokens == 0 and any(not any(True for _ in first[p]) for p in arrived)
        group = 0 if has_come else 1 if was_possible else 2
        row = (group, 0 if was_possible else lack.tokens, -len(arrived))
        found.append((row, f"`{name}` cannot occur: {says}."))
    near = [x for x in found if x[0][2] or not x[0][1]] or found
    return [text for _, text in sorted(near, key=lambda x: x[0])[:most]]


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


def _lack(game: Game, t: FlatTransition, empty: list[int]) -> _Lack:
    """What keeps the transition from occurring."""
    if empty:
        names = [f"`{game.net.places[p].short}`" for p in empty]
        says = (
            f"place {names[0]} is empty" if len(names) == 1 else f"places {_and(names)} are empty"
        )
        return _Lack(says, len(empty))
    marking = game.marking
    for arc in t.arcs:
        if arc.kind is ArcKind.INHIBITOR and game.enabling.inhibited(arc, marking):
            return _Lack(f"place `{game.net.places[arc.place].short}` inhibits it", 0)
    if t.guards:
        ways = _without_guards(game, t)
        if ways:
            return _Lack(_false_guard(game, t, ways), 0)
    return _Lack(_unfit(game, t), 1)


def _false_guard(game: Game, t: FlatTransition, ways: list[Binding]) -> str:
    """That the guard is false, as a clause; with the values where the tokens that are there leave no choice."""
    guards, given = [*t.guards], ""
    if len(ways) == 1:
        (binding,) = ways
        with suppress(
            GameError
        ):  # what a guard before it keeps from an exception is not asked alone
            false = game.enabling.false_guard(t, binding)
            guards = guards if false is None else [false]
        used = {s for g in guards for s in variables(g)}
        given = ", ".join(
            f"{s.name} = {' '.join(variable_text(game.colours, s, v).split())}"
            for s, v in binding.items()
            if s in used
        )
    text = _shortened(", ".join(" ".join(g.span.text.split()) for g in guards))
    with_ = (
        f"with {given}" if given and len(given) <= _MOST_TEXT else "for the tokens that are there"
    )
    return f"its guard `{text}` is false {with_}"


def _shortened(text: str) -> str:
    return text if len(text) <= _MOST_TEXT else f"{text[: _MOST_TEXT - 3]}..."


def _unfit(game: Game, t: FlatTransition) -> str:
    """Which places hold other tokens than the arcs take, as a clause; all have some."""
    net, enabling, marking = game.net, game.enabling, game.marking
    outputs = t.code.outputs if t.code else ()
    least: list[tuple[int, ...]] = []
    shortest: list[str] = []
    for binding in islice(enabling.bindings(t, marking), _MOST_BINDINGS):
        own = {s: v for s, v in binding.items() if s not in outputs}
        by_place: dict[int, list[Demand]] = {}
        try:
            demands = enabling.demands(t, own)
        except NoMatchError:
            continue
        for demand in demands:
            by_place.setdefault(demand.place, []).append(demand)
        lacking = tuple(
            p
            for p, wanted in by_place.items()
            if isinstance(enabling.take(marking, wanted), Demand)
        )
        if lacking and (not least or len(lacking) < len(least[0])):
            least, shortest = [], []
        if lacking and (not least or len(lacking) == len(least[0])):
            least.append(lacking)
            is_one = len(lacking) == 1
            shortest.append(_shortage(game, t, by_place[lacking[0]], own) if is_one else "")
    if len(dict.fromkeys(shortest)) == 1 and shortest[0]:
        return shortest[0]
    places = dict.fromkeys(p for lacking in least for p in lacking)
    if places:  # what they lack depends on what lies in the places that give the variables
        wanted = {s for a in _inputs(t) if a.place in places for s in _variables(t, a)}
        givers = {a.place for a in _inputs(t) if wanted & _variables(t, a)}
        places = dict.fromkeys(a.place for a in _inputs(t) if a.place in {*places, *givers})
    else:  # no tokens match the patterns together
        patterns = dict.fromkeys(t.arcs[x.arc].place for x in t.plan if isinstance(x, BindTerm))
        alone = [p for p in patterns if next(enabling.matching(t, marking, p), None) is None]
        places = dict.fromkeys(alone[:1] or patterns or (a.place for a in _inputs(t)))
    names = [f"`{net.places[p].short}`" for p in places]
    arcs = "arcs take" if len([a for a in _inputs(t) if a.place in places]) != 1 else "arc takes"
    together = " together" if len(names) > 1 else ""
    return f"the tokens in {_and(names)} are not those that its {arcs}{together}"


def _variables(t: FlatTransition, arc: FlatArc) -> set[Symbol]:
    """The variables of the transition in what an arc takes."""
    terms = arc.inscription.terms if arc.inscription is not None else ()
    return {s for x in terms for e in (x.coefficient, x.value) for s in variables(e)} & {
        *t.variables
    }


def _shortage(game: Game, t: FlatTransition, wanted: list[Demand], binding: Binding) -> str:
    """What a place holds, and what is taken from it; "" where that is long, or about times."""
    place = game.net.places[wanted[0].place]
    tokens = game.marking.places[place.index]
    if not isinstance(tokens, MultiSet):
        return ""
    taken = MultiSet({})
    for demand in wanted:
        taken = taken + MultiSet({demand.value: demand.count})
    colours = game.enabling.colours
    held, takes = (" ".join(place_text(colours, place.colset, x).split()) for x in (tokens, taken))
    if len(held) > _MOST_TEXT or len(takes) > _MOST_TEXT:
        return ""
    arcs = [a for a in _inputs(t) if a.place == place.index]
    take = "its arcs take" if len(arcs) > 1 else "its arc takes"
    used = {s for a in arcs for s in _variables(t, a)}
    values = [f"{s.name} = {variable_text(colours, s, v)}" for s, v in binding.items() if s in used]
    given = f"with {', '.join(values)} " if values else ""
    if len(given) > _MOST_TEXT:
        return ""
    return f"{given}place `{place.short}` holds {held}, {take} {takes}"


def _and(names: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def _without_guards(game: Game, t: FlatTransition) -> list[Binding]:
    """With which bindings it could occur if it were not for the guards, two at most.

    Guards that give a variable its value still do so: that is a part of the plan. What the guards keep inscriptions
    from, an exception, is no way.
    """
    bare = replace(t, guards=())
    net = replace(
        game.net, transitions=tuple(bare if x.index == t.index else x for x in game.net.transitions)
    )
    found: list[Binding] = []
    try:
        found.extend(islice(Enabling(net, game.evaluator).enabled(bare, game.marking), 2))
    except (GameError, MlException):
        return found
    return found
