"""The zone that a net lacks: a place that keeps transitions of several robots from being under way at once.

    for proposal in proposals(graph, sides): ...

A robot is commanded by the supervisor, so the place belongs there. A side is what one robot must not do while others do
theirs: the states in which it is under way. Wanted are places of the supervisor that hold a token in all of them, the
fewest states besides; the new place holds a token exactly while all of these are empty, which is a place invariant
(Moody and Antsaklis, "Supervisory Control of Discrete Event Systems Using Petri Nets", 1998): whoever puts a token into
one of them takes it, whoever takes one away gives it back.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.geometry.graph import CellGraph
from pn2code.ml.core import terms as core
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, Form

MOST_TRIED = 6
"""Ways to guard one zone."""
_CANDIDATES = 4


@frozen
class Guard:
    """A place to be.

    Args:
        places: that are marked while the token is taken.
        takes, gives: transitions, by index.
    """

    places: tuple[int, ...]
    takes: tuple[int, ...]
    gives: tuple[int, ...]


def guards(graph: CellGraph, sides: Sequence[Collection[int]]) -> Iterator[Guard]:
    """Ways to keep sides apart, the least restrictive first.

    Args:
        sides: of each robot the states in which it is in the zone.
    """
    candidates = [list(itertools.islice(_covers(graph, side), _CANDIDATES)) for side in sides]
    ways = sorted(itertools.product(*candidates), key=lambda way: sum(n for n, _ in way))
    tried: set[tuple[int, ...]] = set()
    for way in ways:
        places = tuple(sorted({p for _, own in way for p in own}))
        if sum(len(own) for _, own in way) > len(places) or places in tried:
            continue  # a place for two robots keeps nobody out
        tried.add(places)
        found = _guard(graph.partition, places)
        marked = sum(graph.marked[0].get(p, 0) for p in places)
        if found is not None and marked == 0:
            yield found


def _covers(graph: CellGraph, side: Collection[int]) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Sets of places of the supervisor of which one is marked in each state of a side, with in how many states."""
    partition = graph.partition
    count = len(partition.net.places)
    own = [
        p for p in range(count)
        if partition.place_owner[p] == 0 and p not in partition.final_places
    ]  # fmt: skip
    states: dict[int, set[int]] = {p: set() for p in own}
    most: dict[int, int] = dict.fromkeys(own, 0)
    for i, marking in enumerate(graph.marked):
        for p, tokens in marking.items():
            if p in states:
                states[p].add(i)
                most[p] = max(most[p], tokens)
    wanted = set(side)
    single = [p for p in own if most[p] == 1 and 0 not in states[p]]
    whole = [(len(states[p]), (p,)) for p in single if wanted <= states[p]]
    yield from sorted(whole)
    # Several, one after the other.
    chosen: list[int] = []
    left = set(wanted)
    while left:
        best = max(
            (p for p in single if all(states[p].isdisjoint(states[c]) for c in chosen)),
            key=lambda p: (len(left & states[p]), -len(states[p])),
            default=None,
        )
        if best is None or not left & states[best]:
            return
        chosen.append(best)
        left -= states[best]
    if len(chosen) > 1:
        yield sum(len(states[p]) for p in chosen), tuple(sorted(chosen))


def _guard(partition: Partition, places: tuple[int, ...]) -> Guard | None:
    """Who takes and who gives; None: the net does not show it, or one would take two."""
    takes: list[int] = []
    gives: list[int] = []
    for t in partition.net.transitions:
        change = 0
        for arc in t.arcs:
            if arc.place not in places or arc.kind in (ArcKind.BOTH, ArcKind.INHIBITOR):
                continue
            if not _is_one(arc):
                return None
            change += 1 if arc.kind is ArcKind.OUTPUT else -1
        if abs(change) > 1 or (change and partition.transition_owner[t.index] != 0):
            return None
        if change:
            (takes if change > 0 else gives).append(t.index)
    return Guard(places, tuple(takes), tuple(gives)) if takes else None


def _is_one(arc: FlatArc) -> bool:
    """Whether it moves one token whatever happens."""
    if arc.inscription is None:
        return False
    if arc.kind is ArcKind.OUTPUT:
        return arc.inscription.form is Form.TOKEN
    terms = arc.inscription.terms
    if len(terms) != 1 or terms[0].whole:
        return False
    coefficient = terms[0].coefficient
    return isinstance(coefficient, core.Lit) and coefficient.value == 1


def guarded(partition: Partition, guard: Guard, name: str) -> Partition:
    """The cell with the place."""
    b = Builder(partition.net)
    place = b.place(name, b.unit)
    b.begin(place, b.dot)
    for t in guard.takes:
        b.add_arcs(t, [b.take(place, b.dot)], {})
    for t in guard.gives:
        b.add_arcs(t, [Arc(ArcKind.OUTPUT, place, b.dot)], {})
    return replace(partition, net=b.net(), place_owner=(*partition.place_owner, 0))


def stuck(graph: CellGraph) -> int:
    """States from which the cell cannot come to its end any more; without final places: in which nothing can happen."""
    count = len(graph.arcs)
    if not graph.partition.final_places:
        return sum(not arcs for arcs in graph.arcs)
    before: list[list[int]] = [[] for _ in range(count)]
    for i, arcs in enumerate(graph.arcs):
        for _, target in arcs:
            before[target].append(i)
    fine = set(graph.over)
    todo = list(fine)
    while todo:
        for state in before[todo.pop()]:
            if state not in fine:
                fine.add(state)
                todo.append(state)
    return count - len(fine)


def fired(graph: CellGraph) -> frozenset[int]:
    """The transitions of the cell's net that occur."""
    return frozenset(e.transition for e in graph.elements if not e.is_step)


def free_name(net: FlatNet) -> str:
    """A name for the place that the net does not have, on its top page."""
    taken = {p.name for p in net.places}
    top = net.places[0].name.split(".")[0] + "." if "." in net.places[0].name else ""
    numbered = (f"{top}Zone {n}" for n in itertools.count(2))
    return next(x for x in itertools.chain([f"{top}Zone"], numbered) if x not in taken)
