"""Does what the structural analysis says hold in a marking, and along a run? Written against its results only."""

from __future__ import annotations

import random
from collections.abc import Iterator

from pn2code.net.flat import FlatNet
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.multiset import TimedMultiSet
from pn2code.structure import Analysis
from pn2code.structure.bounds import check
from pn2code.structure.coloured import value_of


def counts(marking: Marking) -> list[int]:
    """Numbers of tokens."""
    return [len(p) for p in marking.places]


def wrong_in(a: Analysis, marking: Marking) -> Iterator[str]:
    """What is claimed of all reachable markings and is false in this one."""
    n = counts(marking)
    names = [p.name for p in a.net.places]
    for i in (*a.p_invariants, *(a.p_basis or ())):
        if i.constant is not None and sum(w * n[p] for p, w in i.weights.items()) != i.constant:
            yield f"P-invariant { ({names[p]: w for p, w in i.weights.items()}) }"
    for c in a.coloured.found:
        if c.constant is not None:
            found = value_of(c.terms, marking.places, a.net, a.evaluator)
            if found != c.constant:
                yield f"coloured {[(names[p.place], p.steps, w) for p, w in c.terms]}: {found}"
    for b in a.bounds.values():
        tokens = marking.places[b.place]
        multiset = tokens.untimed() if isinstance(tokens, TimedMultiSet) else tokens
        if b.bound is not None and not b.lower <= n[b.place] <= b.bound:
            yield f"bound of {names[b.place]}: {n[b.place]}"
        if b.per_colour is not None and max(multiset.counts.values(), default=0) > b.per_colour:
            yield f"colour bound of {names[b.place]}"
    for s in a.siphons:
        if s.trap_is_marked and not any(n[p] for p in s.places):
            yield f"siphon {[names[p] for p in s.places]} is empty"


def wrong_step(
    a: Analysis, before: Marking, element: BindingElement, after: Marking
) -> Iterator[str]:
    """What is claimed of steps and is false in this one."""
    t = element.transition
    name = a.net.transitions[t].name
    old, new = counts(before), counts(after)
    if t in a.elements.dead:
        yield f"{name} occurs, and should not: {a.elements.dead[t]}"
    resets = {p for p, ts in a.skeleton.resets.items() if t in ts}
    places = [p for p in range(len(old)) if p not in resets]
    for mode in a.skeleton.modes:
        if mode.transition == t and all(
            p in mode.unknown or new[p] - old[p] == mode.delta.get(p, 0) for p in places
        ):
            break
    else:
        yield f"no mode of {name} fits {[b - a for a, b in zip(old, new, strict=True)]}"
    for s in a.siphons:
        if not any(old[p] for p in s.places) and any(new[p] for p in s.places):
            yield f"siphon {sorted(s.places)} was empty and is marked by {name}"
    for trap in a.traps:
        if any(old[p] for p in trap) and not any(new[p] for p in trap):
            yield f"trap {sorted(trap)} was marked and is emptied by {name}"


def wrong_proofs(a: Analysis) -> Iterator[str]:
    """Bounds whose proof does not hold."""
    for b in a.bounds.values():
        if not check(a.skeleton, b, a.initial):
            yield f"proof of {a.net.places[b.place].name}"


def wrong_on_walk(a: Analysis, net: FlatNet, *, steps: int, seed: int) -> list[str]:
    """What is false somewhere on a random walk; a GameError of the net goes through."""
    game = Game(net, seed=seed)
    draws = random.Random(seed)
    wrong = list(wrong_in(a, game.marking))
    for _ in range(steps):
        if wrong or not game.advance():
            break
        before = game.marking
        element = draws.choice(game.enabled())
        game.fire(element, checked=False)
        wrong += [*wrong_step(a, before, element, game.marking), *wrong_in(a, game.marking)]
    return wrong
