"""Transitions that only count: constant numbers of `()` from and to packed places, and nothing else.

Explorers have a row of a table for each arc of such a transition instead of C of its own (explore_counting.h). A large
place/transition net consists of them, and what a C compiler needs for a table is next to nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

from pn2code.ir import nodes as ir
from pn2code.ir.types import Rep

FEW = 40
"""Transitions of a net that is compiled soon enough as it is: with code of its own each is somewhat faster."""


def with_counts(
    transitions: Sequence[ir.Transition], places: Sequence[ir.Place]
) -> tuple[ir.Transition, ...]:
    """The same with `Transition.counts`, in large nets all of whose places are packed.

    Args:
        transitions: of the net.
        places: of the net, by index.
    """
    if len(transitions) <= FEW or not all(p.packed for p in places):
        return tuple(transitions)
    return tuple(replace(t, counts=counts(t, places)) for t in transitions)


def counts(t: ir.Transition, places: Sequence[ir.Place]) -> tuple[ir.Count, ...] | None:
    """What an occurrence needs, takes and puts, in the order of the arcs; None: it does more than count."""
    if t.variables or t.thresholds or not t.enumerate or t.enumerate[-1] != ir.Yield():
        return None
    needs: Counter[int] = Counter()
    for s in t.enumerate[:-1]:
        match s:
            case ir.UnlessHeld(place=place, value=value, count=count, limit=None):
                if place in needs or not _is_unit(value, places[place]):
                    return None
                needs[place] = count
            case ir.Note():
                pass
            case _:
                return None
    takes: Counter[int] = Counter()
    puts: Counter[int] = Counter()
    for s in t.fire:
        match s:
            case ir.Take(place=place, count=ir.Const(value=int(n)), value=value, limit=None):
                total = takes
            case ir.Put(place=place, count=ir.Const(value=int(n)), value=value, stamp=None):
                total = puts
            case ir.Note():
                continue
            case _:
                return None
        if not 0 < n < 2**31 or not _is_unit(value, places[place]):
            return None
        total[place] += n
    if any(takes[place] > needs[place] for place in takes):
        return None
    return tuple(
        ir.Count(place, needs[place], takes[place], puts[place])
        for place in dict.fromkeys([*needs, *takes, *puts])
    )


def _is_unit(value: ir.Ir, place: ir.Place) -> bool:
    return (
        isinstance(value, ir.Const)
        and value.type.rep is Rep.UNIT
        and place.packed is not None
        and place.packed.colours == 1
    )
