"""Classes of nets and properties of the graph, of the skeleton."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from pn2code.base.frozen import frozen
from pn2code.net.flat import ArcKind, FlatNet
from pn2code.structure.skeleton import Skeleton

ONE_TOKEN = frozenset({1})


@frozen
class Graph:
    """Places and transitions with the arcs between them; weights are not looked at.

    Args:
        pre, post: transition -> places it takes from, puts into.
        takers, givers: place -> transitions that take from it, put into it.
        touched: transition -> all places it has any arc to (inhibitor and reset arcs included).
    """

    pre: tuple[frozenset[int], ...]
    post: tuple[frozenset[int], ...]
    takers: tuple[frozenset[int], ...]
    givers: tuple[frozenset[int], ...]
    touched: tuple[frozenset[int], ...]


def graph(net: FlatNet) -> Graph:
    """The graph of a net; a BOTH arc counts as two."""
    ins, outs = (ArcKind.INPUT, ArcKind.BOTH), (ArcKind.OUTPUT, ArcKind.BOTH)
    pre = [frozenset(a.place for a in t.arcs if a.kind in ins) for t in net.transitions]
    post = [frozenset(a.place for a in t.arcs if a.kind in outs) for t in net.transitions]
    touched = tuple(frozenset(a.place for a in t.arcs) for t in net.transitions)
    count = len(net.places)
    return Graph(tuple(pre), tuple(post), _turned(pre, count), _turned(post, count), touched)


def _turned(sets: Sequence[Iterable[int]], count: int) -> tuple[frozenset[int], ...]:
    found: list[set[int]] = [set() for _ in range(count)]
    for t, places in enumerate(sets):
        for p in places:
            found[p].add(t)
    return tuple(map(frozenset, found))


def classes(skeleton: Skeleton, g: Graph) -> dict[str, bool]:
    """Which classes the skeleton belongs to. Nets with inhibitor or reset arcs are in none of those that rest on the
    graph alone."""
    weights = _weights(skeleton)
    ordinary = all(w == ONE_TOKEN for w in weights.values())
    pure = not any(a & b for a, b in zip(g.pre, g.post, strict=True))
    plain = ordinary and not skeleton.resets and not skeleton.inhibitors
    state_machine = plain and all(
        len(a) == 1 and len(b) == 1 for a, b in zip(g.pre, g.post, strict=True)
    )
    marked_graph = plain and all(
        len(a) == 1 and len(b) == 1 for a, b in zip(g.takers, g.givers, strict=True)
    )
    free = plain and all(
        len(s) <= 1 or all(g.pre[t] == {p} for t in s) for p, s in enumerate(g.takers)
    )
    pairs = plain and _pairs_of(g)
    extended = bool(plain) and all(a == b for a, b in pairs or ())
    asymmetric = bool(plain) and all(a <= b or b <= a for a, b in pairs or ())
    return {
        "ordinary": ordinary,
        "pure": pure,
        "state_machine": state_machine,
        "marked_graph": marked_graph,
        "free_choice": free,
        "extended_free_choice": extended,
        "asymmetric_choice": asymmetric,
    }


def _pairs_of(g: Graph) -> set[tuple[frozenset[int], frozenset[int]]]:
    """Successors of each two places that share one."""
    found = set()
    for places in g.pre:
        ordered = sorted(places)
        for i, p in enumerate(ordered):
            for q in ordered[i + 1 :]:
                found.add((g.takers[p], g.takers[q]))
    return found


def _weights(skeleton: Skeleton) -> Mapping[tuple[int, int, str], frozenset[int]]:
    """The numbers of tokens that each arc may move; -1 for an interval, 0 for a mode without it."""
    found: dict[tuple[int, int, str], set[int]] = {}
    modes: dict[int, int] = {}
    seen: dict[tuple[int, int, str], int] = {}
    for mode in skeleton.modes:
        modes[mode.transition] = modes.get(mode.transition, 0) + 1
        for side, name in ((mode.take, "take"), (mode.put, "put")):
            for p, size in side.items():
                key = (mode.transition, p, name)
                found.setdefault(key, set()).add(size.low if size.exact else -1)
                seen[key] = seen.get(key, 0) + 1
    for key, n in seen.items():
        if n < modes[key[0]]:
            found[key].add(0)
    return {k: frozenset(v) for k, v in found.items()}


def components(g: Graph, places: int) -> tuple[int, bool]:
    """How many connected parts the net has, and whether each of them is strongly connected."""
    size = places + len(g.pre)
    if not size:
        return 0, True
    forward: list[set[int]] = [set() for _ in range(size)]
    around: list[set[int]] = [set() for _ in range(size)]
    for t, node in enumerate(range(places, size)):
        for p in g.pre[t]:
            forward[p].add(node)
        forward[node] |= g.post[t]
        for p in g.touched[t]:
            around[p].add(node)
            around[node].add(p)
    backward: list[set[int]] = [set() for _ in range(size)]
    for a, successors in enumerate(forward):
        for b in successors:
            backward[b].add(a)
    count, strong, seen = 0, True, set[int]()
    for start in range(size):
        if start not in seen:
            part = _reach(around, start)
            seen |= part
            count += 1
            strong = strong and _reach(forward, start) == part == _reach(backward, start)
    return count, strong


def _reach(edges: Sequence[Iterable[int]], start: int) -> set[int]:
    found, todo = {start}, [start]
    while todo:
        for b in edges[todo.pop()]:
            if b not in found:
                found.add(b)
                todo.append(b)
    return found
