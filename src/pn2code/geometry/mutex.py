"""The zone that a net lacks: a place that keeps transitions of several robots from being under way at once.

    for proposal in proposals(graph, sides): ...

A robot is commanded by the supervisor, so the place belongs there. A side is what one robot must not do while others do
theirs: the states in which it is under way. Wanted are groups of tokens of the supervisor (those of a place, or of it
those that have colours in common) of which one is held in all of them, and in the fewest states besides; the new
place holds a token exactly while all of these are empty, which is a place invariant (Moody and Antsaklis, "Supervisory
Control of Discrete Event Systems Using Petri Nets", 1998): whoever puts a token into one of them takes it, whoever
takes one away gives it back.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.base.unused_name import unused_name
from pn2code.cell.partition import Partition
from pn2code.geometry.graph import CellGraph
from pn2code.geometry.token_groups import (
    Conditions,
    Group,
    Held,
    held_groups,
    is_one,
    is_same,
    moving,
    part_of,
    shape_of,
    told,
)
from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Kind
from pn2code.net.builder import Arc, Builder
from pn2code.net.flat import ArcKind, FlatArc, FlatNet, Form
from pn2code.semantics.game.token_game import GameError
from pn2code.semantics.values.colours import TEXTS

MOST_TRIED = 6
"""Ways to guard one zone."""
_CANDIDATES = 4


@frozen
class Hand:
    """A transition that takes the token, or gives it back.

    Args:
        transition: by index.
        is_always: whatever it is about; else only if it puts a token of a group and takes none away (or the reverse).
    """

    transition: int
    is_always: bool


@frozen
class Guard:
    """A place to be.

    Args:
        groups: of which one is held while the token is taken.
        place: it is there, by index, and some transitions take its token already; None: it is a new one.
    """

    groups: tuple[Group, ...]
    takes: tuple[Hand, ...]
    gives: tuple[Hand, ...]
    place: int | None = None


def guards(
    graph: CellGraph,
    sides: Sequence[Collection[int]],
    seen: Collection[int] | None = None,
) -> Iterator[Guard]:
    """Ways to keep sides apart, the least restrictive first.

    Args:
        sides: of each robot, and of what stands on its plates, the states in which it is in the zone.
        seen: states that runs come to: to others they do not, since something is impossible before; None: to all.
    """
    held = held_groups(graph, seen)
    candidates = [list(itertools.islice(_covers(graph, held, side), _CANDIDATES)) for side in sides]
    ways = sorted(itertools.product(*candidates), key=lambda way: sum(n for n, _ in way))
    tried: set[tuple[Group, ...]] = set()
    for way in ways:
        groups = tuple(sorted({g for _, own in way for g in own}, key=_order))
        is_shared = sum(len(own) for _, own in way) > len(groups)
        if groups in tried or (is_shared and not _are_two(held, groups)):
            continue  # a group for two robots keeps nobody out, unless another token is in one of the others then
        tried.add(groups)
        found = _guard(graph, groups)
        if found is not None:
            yield found


def _are_two(held: Held, groups: Sequence[Group]) -> bool:
    """Whether tokens of two groups are there at once in some state."""
    return any(
        not held.states[a].isdisjoint(held.states[b])
        for a, b in itertools.combinations(groups, 2)
        if a.place != b.place
    )


def _order(group: Group) -> tuple[int, int, str]:
    return group.place, len(group.fields), repr(group.fields)


def _covers(
    graph: CellGraph, held: Held, side: Collection[int]
) -> Iterator[tuple[int, tuple[Group, ...]]]:
    """Sets of groups of which one is held in each state of a side, and none at the start, with in how many states."""
    states, wanted = held.states, set(side)
    single = sorted((g for g in states if held.most[g] == 1 and 0 not in states[g]), key=_order)
    whole: list[tuple[int, tuple[Group, ...]]] = []
    seen: set[tuple[int, frozenset[int]]] = set()
    for g in single:
        # What is told by fewer colours comes first, and is enough.
        if wanted <= states[g] and (g.place, states[g]) not in seen:
            seen.add((g.place, states[g]))
            whole.append((len(states[g]), (g,)))
    yield from sorted(whole, key=lambda x: (x[0], _order(x[1][0])))
    # Several, one after the other.
    chosen: list[Group] = []
    left = set(wanted)
    while left:
        best = max(
            (g for g in single if all(states[g].isdisjoint(states[c]) for c in chosen)),
            key=lambda g: (len(left & states[g]), -len(states[g])),
            default=None,
        )
        if best is None or not left & states[best]:
            chosen = []
            break
        chosen.append(best)
        left -= states[best]
    if len(chosen) > 1:
        yield sum(len(states[g]) for g in chosen), tuple(sorted(chosen, key=_order))
    if not whole:
        yield from _loosely(graph, held, wanted)


def _loosely(
    graph: CellGraph, held: Held, wanted: Collection[int]
) -> Iterator[tuple[int, tuple[Group, ...]]]:
    """The same of groups that may be held at once, and more than once; with the place they are not any more.

    First those that are for little else, and that tokens come to from those that are chosen, or go from to them.
    """
    states, left = held.states, set(wanted)
    beside: dict[int, set[int]] = {}
    for t in graph.partition.net.transitions:
        if graph.partition.transition_owner[t.index] == 0:
            places = {arc.place for arc in t.arcs}
            for place in places:
                beside.setdefault(place, set()).update(places)
    some = [g for g in states if states[g] and 0 not in states[g] and not g.fields]
    chosen: list[Group] = []
    while left:
        nearby = set[int]().union(*(beside.get(g.place, ()) for g in chosen))
        best = max(
            sorted((g for g in some if left & states[g]), key=_order),
            key=lambda g: (g.place in nearby, len(left & states[g]) / len(states[g])),
            default=None,
        )
        if best is None:
            return
        chosen.append(best)
        left -= states[best]
    for group in sorted(chosen, key=lambda g: -len(states[g])):
        others = [g for g in chosen if g != group]
        if set(wanted) <= frozenset[int]().union(*(states[g] for g in others)):
            chosen = others
    yield sum(len(states[g]) for g in chosen), tuple(sorted(chosen, key=_order))


def _guard(graph: CellGraph, groups: tuple[Group, ...]) -> Guard | None:
    """Who takes and who gives; None: the net does not show it, or one would take two."""
    partition = graph.partition
    places = frozenset(g.place for g in groups)
    changes: dict[int, set[int]] = {}
    for t in partition.net.transitions:
        arcs = list(moving(t, places))
        if not all(map(is_one, arcs)) or (arcs and partition.transition_owner[t.index] != 0):
            return None
        if arcs:
            changes[t.index] = set()
    try:
        for e in graph.elements:
            if not e.is_step and e.owner >= 0 and e.transition in changes:
                t = partition.net.transitions[e.transition]
                moved = (_sign(a) * _has(graph, groups, a, e.number) for a in moving(t, places))
                changes[e.transition].add(sum(moved))
    except GameError:
        return None
    if any(abs(change) > 1 for found in changes.values() for change in found):
        return None
    takes = tuple(Hand(t, found == {1}) for t, found in changes.items() if 1 in found)
    gives = tuple(Hand(t, found == {-1}) for t, found in changes.items() if -1 in found)
    return Guard(groups, takes, gives) if takes else None


def _sign(arc: FlatArc) -> int:
    return 1 if arc.kind is ArcKind.OUTPUT else -1


def _has(graph: CellGraph, groups: Sequence[Group], arc: FlatArc, element: int) -> bool:
    """Whether the token that an arc moves is one of a group."""
    own = [g for g in groups if g.place == arc.place]
    if any(not g.fields for g in own):
        return True
    value = graph.value(graph.elements[element], told(arc))
    return any(g.has(graph.partition.net.places[arc.place].colset, value) for g in own)


def keepers(graph: CellGraph) -> list[int]:
    """Places of the supervisor with one token `()` that somebody takes and gives back: they keep somebody out.

    Those come first whose token is away in the fewest states.
    """
    net = graph.partition.net
    found: list[tuple[int, int]] = []
    for p in net.places:
        i = p.index
        if (
            graph.partition.place_owner[i] != 0
            or p.colset.whole.kind is not Kind.UNIT
            or p.colset.timed
        ):
            continue
        arcs = [(t.index, a) for t in net.transitions for a in moving(t, frozenset((i,)))]
        owners = {graph.partition.transition_owner[t] for t, _ in arcs}
        kinds = {a.kind for _, a in arcs}
        if (
            owners != {0}
            or not kinds <= {ArcKind.INPUT, ArcKind.OUTPUT}
            or not all(is_one(a) for _, a in arcs)
        ):
            continue
        counts = {m.get(i, 0) for m in graph.marked}
        if graph.marked[0].get(i, 0) == 1 and counts == {0, 1}:
            found.append((sum(not m.get(i, 0) for m in graph.marked), i))
    return [i for _, i in sorted(found)]


def users(graph: CellGraph, place: int) -> tuple[frozenset[int], frozenset[int]]:
    """The transitions that take a token from a place, and those that put one there."""
    net, own = graph.partition.net, frozenset((place,))
    kinds = [(t.index, a.kind) for t in net.transitions for a in moving(t, own)]
    return (
        frozenset(t for t, kind in kinds if kind is ArcKind.INPUT),
        frozenset(t for t, kind in kinds if kind is ArcKind.OUTPUT),
    )


def with_keepers(graph: CellGraph, sides: Sequence[Collection[int]]) -> Iterator[Guard]:
    """Ways to keep sides apart by a place that is there, whose token is away already while some are in the zone.

    First the best one of each place, those places first whose token is away for the shortest.

    Args:
        sides: of each robot the states in which it is in the zone.
    """
    held: Held | None = None
    turns: deque[Iterator[Guard]] = deque()
    for place in keepers(graph):
        free = [{s for s in side if graph.marked[s].get(place, 0)} for side in sides]
        if all(free) or not any(free):
            continue
        held = held or held_groups(graph)
        turns.append(_for_others(graph, held, set().union(*free), place))
    while turns:
        guards_of = turns.popleft()
        guard = next(guards_of, None)
        if guard is not None:
            yield guard
            turns.append(guards_of)


def _for_others(graph: CellGraph, held: Held, left: Collection[int], place: int) -> Iterator[Guard]:
    """Ways to take the token of a place that is there in some more states."""
    takes, gives = users(graph, place)
    made = 0
    for groups in _any_covers(held, left, place):
        guard = _guard(graph, groups)
        if guard is None:
            continue
        more, back = ({h.transition for h in hands} for hands in (guard.takes, guard.gives))
        if takes.isdisjoint(more) and gives.isdisjoint(back):
            yield replace(guard, place=place)
            made += 1
            if made == _CANDIDATES:
                return


def _any_covers(held: Held, wanted: Collection[int], place: int) -> Iterator[tuple[Group, ...]]:
    """Groups of other places of which one is held in each of some states; they may be held at once."""
    left = set(wanted)
    single = sorted(
        (
            g
            for g in held.states
            if held.most[g] == 1 and 0 not in held.states[g] and g.place != place
        ),
        key=lambda g: (len(held.states[g]), _order(g)),
    )
    yield from ((g,) for g in single if left <= held.states[g])
    chosen: list[Group] = []
    while left:
        best = max(single, key=lambda g: len(left & held.states[g]), default=None)
        if best is None or not left & held.states[best]:
            return
        chosen.append(best)
        left -= held.states[best]
    if len(chosen) > 1:
        yield tuple(sorted(chosen, key=_order))


def guarded(partition: Partition, guard: Guard, name: str) -> Partition:
    """The cell with the place."""
    b = Builder(partition.net)
    if guard.place is None:
        place = b.place(name, b.unit)
        b.begin(place, b.dot)
    else:
        place = guard.place
    conditions = Conditions(b, partition.net)

    def arc(kind: ArcKind, hand: Hand) -> Arc:
        if hand.is_always:
            return Arc(kind, place, b.dot)
        puts, takes = _puts_and_takes(partition.net, guard, hand)
        if kind is ArcKind.OUTPUT:
            puts, takes = takes, puts
        none, one, groups = conditions.none, conditions.one, guard.groups
        value = conditions.where(puts, groups, conditions.where(takes, groups, none, one), none)
        return Arc(kind, place, value, Form.MULTISET)

    for hand in guard.takes:
        b.add_arcs(hand.transition, [arc(ArcKind.INPUT, hand)], {})
    for hand in guard.gives:
        b.add_arcs(hand.transition, [arc(ArcKind.OUTPUT, hand)], {})
    more = (0,) if guard.place is None else ()
    return replace(partition, net=b.net(), place_owner=(*partition.place_owner, *more))


def _puts_and_takes(net: FlatNet, guard: Guard, hand: Hand) -> tuple[list[FlatArc], list[FlatArc]]:
    arcs = list(moving(net.transitions[hand.transition], frozenset(g.place for g in guard.groups)))
    return (
        [a for a in arcs if a.kind is ArcKind.OUTPUT],
        [a for a in arcs if a.kind is not ArcKind.OUTPUT],
    )


def held_in_words(net: FlatNet, group: Group) -> str:
    """What tokens of a group have in common; "": it is all of a place."""
    return " and ".join(
        f"{f'#{label}' if label else 'the colour'} = {_text(net, group, label)}"
        for label, _ in group.fields
    )


def _text(net: FlatNet, group: Group, label: str) -> str:
    shape = dict(shape_of(net.places[group.place].colset))
    return TEXTS.text(shape[label], dict(group.fields)[label])


def when(net: FlatNet, guard: Guard, hand: Hand, *, takes: bool) -> str:
    """In which case a transition takes the token, or gives it back, in CPN ML; "": whenever it occurs."""
    if hand.is_always:
        return ""
    puts, taken = _puts_and_takes(net, guard, hand)
    if not takes:
        puts, taken = taken, puts
    out = _one_of(net, guard, puts)
    unless = _one_of(net, guard, taken)
    return f"({out}) andalso not ({unless})" if unless else out


def _one_of(net: FlatNet, guard: Guard, arcs: Sequence[FlatArc]) -> str:
    """That one of the arcs moves a token of a group; "": none ever does."""
    found = [
        _is(net, group, told(arc))
        for arc, group in itertools.product(arcs, guard.groups)
        if arc.place == group.place
    ]
    return " orelse ".join(dict.fromkeys(x for x in found if x))


def _is(net: FlatNet, group: Group, token: core.Exp) -> str:
    """That a token is one of a group; "": it never is."""
    own = []
    for label, value in group.fields:
        part = part_of(token, label)
        if isinstance(part, core.Lit | core.Con):
            if not is_same(part, value):
                return ""
            continue
        is_shown = not label or isinstance(token, core.RecordExp)
        shown = part.span.text if is_shown else f"#{label} ({token.span.text})"
        own.append(f"{shown} = {_text(net, group, label)}")
    return " andalso ".join(own) or "true"


def stuck(graph: CellGraph) -> frozenset[int]:
    """States from which the cell cannot come to its end any more; without final places: in which nothing can happen."""
    count = len(graph.arcs)
    if not graph.partition.final_places:
        return frozenset(i for i, arcs in enumerate(graph.arcs) if not arcs)
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
    return frozenset(range(count)) - fine


def is_stuck_anew(before: CellGraph, after: CellGraph, place: int | None) -> bool:
    """Whether a state may be stuck with a place that without it is not.

    Which states of both are the same is told by how many tokens the places of the cell's net hold: of those that hold
    as many, all have to be stuck without it. `place`: but for this one, which is there before as well.
    """
    places = len(before.partition.net.places)

    def marked(graph: CellGraph, states: Collection[int]) -> set[frozenset[tuple[int, int]]]:
        return {
            frozenset((p, n) for p, n in graph.marked[i].items() if p < places and p != place)
            for i in states
        }

    old = stuck(before)
    known = marked(before, old)
    if (
        before.partition.final_places
    ):  # else only the last state is stuck, not those on the way to it
        known -= marked(before, frozenset(range(len(before.arcs))) - old)
    return not marked(after, stuck(after)) <= known


def fired(graph: CellGraph) -> frozenset[int]:
    """The transitions of the cell's net that occur."""
    return frozenset(e.transition for e in graph.elements if not e.is_step)


def free_name(net: FlatNet) -> str:
    """A name for the place that the net does not have, on its top page."""
    taken = {p.name for p in net.places}
    top = net.places[0].name.split(".")[0] + "." if "." in net.places[0].name else ""
    return unused_name(f"{top}Zone", taken, "{} {}")
