"""Transitions that only count: constant numbers of `()` from and to packed places, and nothing else.

Explorers have a row of a table for each arc of such a transition instead of C of its own (explore_counting.h). A large
place/transition net consists of them, and what a C compiler needs for a table is next to nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from pn2code.base.frozen import replace
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.types import Rep

FEW = 40
"""Transitions of a net that is compiled soon enough as it is: with code of its own each is somewhat faster."""


def is_large(net: ir.NetIR) -> bool:
    """Whether it is for an explorer, and has so many transitions that less C is better than somewhat faster C."""
    return net.has_successors and len(net.transitions) > FEW


def with_counts(net: ir.NetIR) -> ir.NetIR:
    """The net with `Transition.counts` and `Place.is_only_counted`: for explorers, in large nets whose places are all
    packed."""
    if not is_large(net) or not all(p.packed for p in net.places):
        return net
    transitions = tuple(replace(t, counts=counts(t, net.places)) for t in net.transitions)
    bodies: list[object] = [f.body for f in net.functions]
    bodies += [p.body for p in net.predicates]
    for t in transitions:
        bodies += [t.enumerate, t.fire, t.thresholds] if t.counts is None else []
    reached = {getattr(node, "place", None) for body in bodies for node in ir_nodes(body)}
    places = tuple(replace(p, is_only_counted=p.index not in reached) for p in net.places)
    return replace(net, transitions=transitions, places=places)


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
