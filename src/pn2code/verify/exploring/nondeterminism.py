"""What of a net depends on more than its marking: its state space is one of many, or not that of CPN Tools."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effect, effects_of, outside, texts
from pn2code.semantics.evaluation.references import occurring, searching
from pn2code.verify.codes import (
    CHANGES_REFERENCES,
    CHANGES_WHILE_SEARCHING,
    DRAWS_RANDOM,
)

MOST_NAMED = 5
"""Transitions that get a warning of their own."""
_ORDER = (Effect.DRAW, Effect.LOOK, Effect.COUNT)


def warn(net: FlatNet, d: Diagnostics) -> None:
    """Warns of transitions that draw random numbers, look at files, count steps, or change references."""
    effects = effects_of(net.program)
    found = [(t, effects.of(*_texts(t))) for t in net.transitions]
    changing = [t for t in net.transitions if Effect.WRITE in effects.of(*occurring(t))]
    if changing:
        names = ", ".join(f"`{t.name}`" for t in changing[:MOST_NAMED])
        more = f" and {len(changing) - MOST_NAMED} more" if len(changing) > MOST_NAMED else ""
        d.warning(
            CHANGES_REFERENCES,
            f"a node is a marking together with what the references hold: they are changed by {names}{more}",
            changing[0].origin,
            hint="CPN Tools does not restore references, so that its state space of this net may be another one",
        )
    named = 0
    for place in net.places:
        own = effects.of(place.initial[0]) if place.initial else frozenset()
        why = next((e for e in _ORDER if e in own), None)
        if why is not None and named < MOST_NAMED:
            named += 1
            d.warning(
                DRAWS_RANDOM,
                f"the initial marking of place `{place.name}` {why.value}: what is found is one of many state spaces",
                place.origins[0],
            )
    for t, own in found:
        why = next((e for e in _ORDER if e in own), None)
        if why is None or named == MOST_NAMED:
            continue
        named += 1
        d.warning(
            DRAWS_RANDOM,
            f"transition `{t.name}` {why.value}: what is found is one of many state spaces",
            t.origin,
        )


def draws(net: FlatNet) -> bool:
    """Whether random numbers or files decide anything, the initial marking included."""
    return outside(effects_of(net.program), net)


def counts(net: FlatNet) -> bool:
    """Whether the number of steps (`step ()`) decides anything: a state has none, so the explorer's never changes."""
    return Effect.COUNT in effects_of(net.program).of(*texts(net))


def undetermined(net: FlatNet) -> str:
    """Why the state space does not show all that the net can do, a word of `answers.reasons`; "": it does."""
    return "steps" if counts(net) else "chance" if draws(net) else ""


def refuse(net: FlatNet, d: Diagnostics) -> bool:
    """Refuses nets that change references while bindings are searched for; whether it did."""
    found = searching(net)
    for index in found[:MOST_NAMED]:
        t = net.transitions[index]
        d.error(
            CHANGES_WHILE_SEARCHING,
            f"a guard or an input arc of transition `{t.name}` assigns a reference: the net has no state space",
            t.origin,
            hint="assign it in the code segment; `pn2code simulate` runs the net as it is",
        )
    return bool(found)


def _texts(t: FlatTransition) -> Iterator[Any]:
    yield from (t.guards, t.delay, t.code.action if t.code else None)
    yield from (a.inscription.value for a in t.arcs if a.inscription)
