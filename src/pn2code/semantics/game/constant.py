"""Transitions whose binding elements do the same in every marking.

Whether such an element is enabled depends on nothing but whether the tokens that it takes are there (and on
priorities), and what it takes and puts depends on nothing at all. So both need to be computed once.
"""

from __future__ import annotations

from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.net.reached import inscriptions
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
    colsets = [net.places[a.place].colset for a in t.arcs]
    colsets += [s.colset for s in t.variables if s.colset is not None]
    return not effects.of(*inscriptions(t), *(test for c in colsets for test in c.tests()))
