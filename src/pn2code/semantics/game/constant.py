"""Transitions whose binding elements do the same in every marking.

Whether such an element is enabled depends on nothing but whether the tokens that it takes are there (and on
priorities), and what it takes and puts depends on nothing at all. So both need to be computed once.
"""

from __future__ import annotations

from collections.abc import Iterator

from pn2code.ml.core.colsets import Colset
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.semantics.evaluation.effects import Effects, effects_of


def constant_transitions(net: FlatNet) -> frozenset[int]:
    """Their numbers: in nets without time, those without code, effects of their texts, inhibitor and reset arcs."""
    if net.timed:
        return frozenset()
    effects = effects_of(net.program)
    return frozenset(t.index for t in net.transitions if _is_constant(net, t, effects))


def _is_constant(net: FlatNet, t: FlatTransition, effects: Effects) -> bool:
    if t.code is not None:
        return False
    if any(a.kind in (ArcKind.INHIBITOR, ArcKind.RESET) or a.inscription is None for a in t.arcs):
        return False
    # The plan of a search has no texts but those of guards and arcs.
    texts: list[object] = [*t.guards]
    for arc in t.arcs:
        assert arc.inscription is not None
        texts.append(arc.inscription.value)
        for term in arc.inscription.terms:
            texts += [term.value, term.coefficient, term.delay]
        texts.extend(_tests(net.places[arc.place].colset))
    for symbol in t.variables:
        if symbol.colset is not None:
            texts.extend(_tests(symbol.colset))
    return not effects.of(*texts)


def _tests(c: Colset) -> Iterator[object]:
    """The texts that say which values a colour set has."""
    yield from (test for test in (c.members, c.predicate) if test is not None)
    for part in c.components:
        if part is not None:
            yield from _tests(part)
