"""How long one event can be waited for after another, in a graph with times on its arcs.

    found = longest_wait(successors, first, second, ends)
    found.ns                # 32_280_000_000: no wait is longer, and some run waits so long
    found.why               # "never", "repeats", "idle", "ends": there is no longest wait, or it is not known

An arc is an event by its mark; the event is at its end, after its time has gone by.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from pn2code.base.frozen import frozen
from pn2code.timing.longest import Arc, TimedPaths

Is = Callable[[int], bool]
_LEFT = -9
"""The mark of an arc on which the part that was seen is left."""


@frozen
class Wait:
    """The longest wait.

    Args:
        ns: how long; 0, if the first event never is; None: `why` says why.
        why: "never": after it the cell can come to where the second event is not possible any more; "repeats":
            something that takes time can go round before it; "idle": something that takes none can; "ends": the cycle
            can be over before it.
        before: the node in which the first event of that wait is possible; -1: it is none.
        way: node and mark of each arc from there, the first event included, to the second one (of "never": to where it
            is not possible any more, of "repeats": once round).
    """

    ns: int | None
    why: str = ""
    before: int = -1
    way: tuple[tuple[int, int], ...] = ()


def longest_wait(
    successors: Sequence[Sequence[Arc]],
    first: Is,
    second: Is,
    ends: Collection[int],
    over: Collection[int] = (),
    *,
    may_idle: bool = False,
) -> Wait:
    """The longest time from an event to the next one of the other kind.

    Args:
        successors: (node, ns, mark) of each node's arcs; node 0 is the start.
        first, second: whether the mark of an arc is such an event.
        ends: the nodes in which the cycle may be over.
        over: those of them from which the second event is not waited for as nobody begins it any more.
        may_idle: what takes no time and can go on for ever is no reason against a longest one.
    """
    begun = _begun(successors, first)
    if not begun:
        return Wait(0)
    inside = _until(successors, begun, second)
    numbers = {node: i for i, node in enumerate(inside, 1)}
    last = len(inside) + 1
    graph: list[list[Arc]] = [[(numbers[node], 0, -1) for node in begun]]
    for node in inside:
        graph.append(
            [
                (last if second(mark) else numbers[target], ns, mark)
                for target, ns, mark in successors[node]
            ]
        )
    graph.append([])
    paths = TimedPaths(graph, {last})

    def told(way: Sequence[tuple[int, int]], why: str, ns: int | None = None) -> Wait:
        node = inside[way[0][0] - 1]
        before, mark = begun[node]
        after = [(-1 if n == last else inside[n - 1], m) for n, m in way[1:]]
        return Wait(ns, why, before, ((node, mark), *after))

    never = [i for i in range(1, last) if not paths.leading[i]]
    lost = next((i for i in never if inside[i - 1] not in over), 0)
    if lost:
        return told(_reached(graph, lost), "never")
    if never:
        return Wait(None, "ends")
    if paths.cycle:
        there = _reached(graph, paths.cycle[0])
        return told([*there, *_round(graph, paths.cycle)], "repeats")
    found = paths.longest()
    assert found is not None
    if paths.never_end() and not may_idle:
        return Wait(None, "idle")
    if any(node in ends for node in inside):
        return Wait(None, "ends")
    return told(found.arcs, "", found.ns)


def seen_wait(
    successors: Sequence[Sequence[Arc]], first: Is, second: Is, over: Collection[int]
) -> Wait:
    """The longest time after an event without one of the other kind, in the part of a graph that was seen.

    Some run waits at least so long, whatever comes behind that part; "repeats": as long as it likes.

    Args:
        over: nodes in which the cycle may be over: what comes after them does not count.
    """
    left = [() if node in over else arcs for node, arcs in enumerate(successors)]
    reached = set(_until(left, {0}, lambda _: False))
    part = [[*(arcs if node in reached else ()), (0, 0, _LEFT)] for node, arcs in enumerate(left)]
    return longest_wait(part, first, lambda m: m == _LEFT or second(m), (), may_idle=True)


def lost_wait(
    successors: Sequence[Sequence[Arc]], first: Is, second: Is, lost: Collection[int]
) -> Wait | None:
    """How one comes to one of these nodes, after an event and without one of the other kind; None: one does not."""
    begun = _begun(successors, first)
    graph: list[list[Arc]] = [[(node + 1, 0, -1) for node in begun]]
    graph += [[(to + 1, ns, m) for to, ns, m in arcs if not second(m)] for arcs in successors]
    there = way_to(graph, {node + 1 for node in lost})
    if there is None:
        return None
    node = there[0][0] - 1
    before, mark = begun[node]
    after = [(n - 1, m) for n, m in there[1:]]
    return Wait(None, "never", before, ((node, mark), *after))


def waiting(successors: Sequence[Sequence[Arc]], first: Is, second: Is) -> tuple[int, ...]:
    """All nodes in which the second event is waited for after the first."""
    return _until(successors, _begun(successors, first), second)


def _begun(successors: Sequence[Sequence[Arc]], first: Is) -> dict[int, tuple[int, int]]:
    """The nodes behind the event: from where it leads there, and its mark."""
    begun: dict[int, tuple[int, int]] = {}
    for node, arcs in enumerate(successors):
        for target, _, mark in arcs:
            if first(mark):
                begun.setdefault(target, (node, mark))
    return begun


def _until(
    successors: Sequence[Sequence[Arc]], begun: Collection[int], second: Is
) -> tuple[int, ...]:
    """All nodes in which the second event is still waited for."""
    found = dict.fromkeys(begun)
    todo = list(found)
    while todo:
        for target, _, mark in successors[todo.pop()]:
            if not second(mark) and target not in found:
                found[target] = None
                todo.append(target)
    return tuple(found)


def way_to(graph: Sequence[Sequence[Arc]], goals: Collection[int]) -> list[tuple[int, int]] | None:
    """A way with few arcs from node 0: node and mark of each; None: there is none."""
    before: dict[int, tuple[int, int]] = {}
    todo = [0]
    for node in todo:
        if node in goals:
            out: list[tuple[int, int]] = []
            while node:
                parent, mark = before[node]
                out.append((node, mark))
                node = parent
            return out[::-1]
        for target, _, mark in graph[node]:
            if target and target not in before:
                before[target] = (node, mark)
                todo.append(target)
    return None


def _reached(graph: Sequence[Sequence[Arc]], node: int) -> list[tuple[int, int]]:
    found = way_to(graph, {node})
    assert found is not None, "it is reached"
    return found


def _round(graph: Sequence[Sequence[Arc]], cycle: Sequence[int]) -> list[tuple[int, int]]:
    out = []
    for node, target in zip(cycle, [*cycle[1:], *cycle[:1]], strict=True):
        _, mark = max((ns, mark) for to, ns, mark in graph[node] if to == target)
        out.append((target, mark))
    return out
