"""What of a net depends on more than its marking: of such a net a state space is one of many."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.semantics.effects import Effect, Effects
from pn2code.verify.codes import DRAWS_RANDOM

MOST_NAMED = 5
"""Transitions that get a warning of their own."""
_ORDER = (Effect.DRAW, Effect.LOOK, Effect.COUNT, Effect.READ)


def warn(net: FlatNet, d: Diagnostics) -> None:
    """Warns of transitions that draw random numbers, look at files, count steps, or read references that change."""
    effects = Effects(net.program)
    found = [(t, effects.of(*_texts(t))) for t in net.transitions]
    changes = any(Effect.WRITE in own for _, own in found)
    named = 0
    for t, own in found:
        why = next((e for e in _ORDER if e in own and (e is not Effect.READ or changes)), None)
        if why is None or named == MOST_NAMED:
            continue
        named += 1
        d.warning(
            DRAWS_RANDOM,
            f"transition `{t.name}` {why.value}: what is found is one of many state spaces",
            t.origin,
        )


def draws(net: FlatNet) -> bool:
    """Whether random numbers or files decide anything."""
    effects = Effects(net.program)
    return any(
        e in effects.of(*_texts(t)) for t in net.transitions for e in (Effect.DRAW, Effect.LOOK)
    )


def _texts(t: FlatTransition) -> Iterator[Any]:
    yield from (t.guards, t.delay, t.code.action if t.code else None)
    yield from (a.inscription.value for a in t.arcs if a.inscription)
