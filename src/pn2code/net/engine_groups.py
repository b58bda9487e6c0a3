"""Arcs from one place whose variables CPN Tools cannot bring together.

    in A : (a, b)    in A : (c, b)      InternalError: insert_transvar: inserting known item with proper group

Its engine keeps the variables of the arcs from a place in groups. A later arc that shares variables with an earlier one
joins its group only if the first variable of the earlier one is among them; else the check of the page breaks off,
whatever binds the variables elsewhere. (Found by experiment, with products; of other colour sets nothing is said.)
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.ml.core.terms import Symbol
from pn2code.net.flat import ArcKind
from pn2code.net.typed import TypedArc
from pn2code.net.uses import NetVariables, pattern_variables

_TAKING = (ArcKind.INPUT, ArcKind.BOTH)


def clashes(
    arcs: Sequence[TypedArc], products: frozenset[str], variables: NetVariables
) -> Iterator[tuple[TypedArc, TypedArc, Symbol]]:
    """Pairs of arcs, the earlier one first, and a variable that they share.

    Args:
        arcs: of a transition, in order of the file.
        products: ids of the places whose colour sets are products.
        variables: of the net.
    """
    first: dict[str, list[tuple[TypedArc, tuple[Symbol, ...]]]] = {}
    for arc in arcs:
        if arc.inscription is None or arc.kind not in _TAKING or arc.place not in products:
            continue
        terms = arc.inscription.terms
        if len(terms) != 1:
            continue
        names = pattern_variables(terms[0].pattern)
        used = variables.of(arc.inscription.value)
        for earlier, before in first.get(arc.place, []):
            shared = [s for s in used if s in before]
            if shared and before[0] not in shared:
                yield earlier, arc, shared[0]
                return
        if names:
            first.setdefault(arc.place, []).append((arc, names))
