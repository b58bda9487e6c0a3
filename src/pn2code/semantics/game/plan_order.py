"""What is looked at after which step of the plan of a transition: guards, and what is wanted of places.

Both as early as possible: a guard when all its variables have values, a place when all that is wanted of it is known.
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.ml.core.terms import Exp, Lit, Symbol
from pn2code.net.flat import (
    ArcKind,
    BindAll,
    BindEquation,
    BindRandom,
    BindTerm,
    FlatArc,
    FlatTransition,
    Term,
)
from pn2code.net.total import is_total
from pn2code.semantics.evaluation.effects import Effects
from pn2code.semantics.evaluation.used_symbols import variables


@frozen
class Wants:
    """What a transition wants.

    Args:
        arcs: its input arcs, by place, in order.
        together: their inscriptions draw random numbers or the like: all are looked at, whatever the others want.
    """

    arcs: dict[int, list[FlatArc]]
    together: bool


class PlanOrder:
    """The order of the plans of a net's transitions, each worked out once."""

    def __init__(self, effects: Effects) -> None:
        self._effects = effects
        self._guards: dict[int, list[list[int]]] = {}
        self._early: dict[int, list[list[int]]] = {}
        self._wants: dict[int, Wants] = {}

    def guards(self, t: FlatTransition) -> list[list[int]]:
        """For each position in the plan, which guards have all their variables there but not earlier."""
        if t.index not in self._guards:
            own = set(t.variables)
            open_guards = {i: variables(g) & own for i, g in enumerate(t.guards)}
            positions: list[list[int]] = []
            for bound in _bound_after(t):
                positions.append([i for i, needed in open_guards.items() if needed <= bound])
                for i in positions[-1]:
                    del open_guards[i]
            assert not open_guards, "the plan binds all variables of the guards"
            self._guards[t.index] = positions
        return self._guards[t.index]

    def early(self, t: FlatTransition) -> list[list[int]]:
        """For each position in the plan, the places of which all that is wanted is known then, and not earlier."""
        if t.index not in self._early:
            own = set(t.variables)
            order = _bound_after(t)
            positions: list[list[int]] = [[] for _ in order]
            wants = self.wanted(t)
            for place, arcs in wants.arcs.items():
                terms = [x for a in arcs for x in terms_of(a)]
                texts = [e for x in terms for e in _texts(x)]
                if wants.together or not all(map(is_total, texts)) or _is_found(t, place, terms):
                    continue
                needed = {s for e in texts for s in variables(e) & own}
                positions[next(i for i, bound in enumerate(order) if needed <= bound)].append(place)
            self._early[t.index] = positions
        return self._early[t.index]

    def wanted(self, t: FlatTransition) -> Wants:
        """What a transition wants of each place."""
        if t.index not in self._wants:
            arcs: dict[int, list[FlatArc]] = {}
            for arc in t.arcs:
                if arc.kind in (ArcKind.INPUT, ArcKind.BOTH) and arc.inscription is not None:
                    arcs.setdefault(arc.place, []).append(arc)
            texts = [
                e for own in arcs.values() for a in own for x in terms_of(a) for e in _texts(x)
            ]
            self._wants[t.index] = Wants(arcs, bool(self._effects.of(*texts)))
        return self._wants[t.index]


def _bound_after(t: FlatTransition) -> list[set[Symbol]]:
    """The variables that have values before the first step of the plan, and after each."""
    bound: set[Symbol] = set()
    after = [set(bound)]
    for step in t.plan:
        match step:
            case BindTerm(arc, term):
                inscription = t.arcs[arc].inscription
                assert inscription is not None
                pattern = inscription.terms[term].pattern
                assert pattern is not None
                bound |= variables(pattern)
            case BindEquation(_, pattern, _):
                bound |= variables(pattern)
            case BindAll(symbol) | BindRandom(symbol):
                bound.add(symbol)
        after.append(set(bound))
    return after


def terms_of(arc: FlatArc) -> tuple[Term, ...]:
    """The summands of the inscription of an arc."""
    return arc.inscription.terms if arc.inscription is not None else ()


def _is_found(t: FlatTransition, place: int, terms: list[Term]) -> bool:
    """Whether a step of the plan finds all that is wanted of a place: one token."""
    if len(terms) != 1:
        return False
    (term,) = terms
    found = any(isinstance(x, BindTerm) and t.arcs[x.arc].place == place for x in t.plan)
    return found and isinstance(term.coefficient, Lit) and term.coefficient.value == 1


def _texts(term: Term) -> list[Exp]:
    """The expressions of a summand of an input arc."""
    return [term.coefficient, term.value, *([] if term.delay is None else [term.delay])]
