"""Shortest and longest paths in a graph with times on its arcs, to where something ends.

    paths = TimedPaths(successors, ends)
    paths.longest()          # TimedPath(ns=58_120_000_000, arcs=[(0, 3), ...]); None: there is no way
    paths.cycle              # nodes of a cycle that takes time, from which an end can be reached: no way is longest

`successors[n]` are (node, ns, mark) of node `n`; node 0 is the start. What takes no time may go round.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Sequence

from pn2code.base.components import components
from pn2code.base.frozen import frozen

Arc = tuple[int, int, int]
"""To which node, how long (ns), and a mark for whoever reads the way."""


@frozen
class TimedPath:
    """A way from the start: how long it is, and the node and mark of each of its arcs."""

    ns: int
    arcs: tuple[tuple[int, int], ...]

    @property
    def last(self) -> int:
        """Where it ends."""
        return self.arcs[-1][0] if self.arcs else 0


def shortest(
    successors: Sequence[Sequence[Arc]],
    ends: Collection[int],
    weigh: Callable[[int, int], int] = lambda ns, _mark: ns,
) -> TimedPath | None:
    """The shortest way to an end; None: there is none.

    Args:
        weigh: how long an arc counts, by its time and mark.
    """
    best = {0: 0}
    before: dict[int, tuple[int, int]] = {}
    todo = [(0, 0)]
    while todo:
        ns, node = heapq.heappop(todo)
        if ns > best[node]:
            continue
        if node in ends:
            return TimedPath(ns, tuple(_back(before, node)))
        for target, more, mark in successors[node]:
            total = ns + weigh(more, mark)
            if total < best.get(target, total + 1):
                best[target] = total
                before[target] = (node, mark)
                heapq.heappush(todo, (total, target))
    return None


class TimedPaths:
    """The paths to the ends, as long as they can be."""

    def __init__(self, successors: Sequence[Sequence[Arc]], ends: Collection[int]) -> None:
        self.successors, self.ends = successors, ends
        self.leading = leading_to(successors, ends)
        """by node: whether an end can be reached"""
        self._members = list(components(range(len(successors)), self._after))[::-1]
        """the components, in an order in which arcs lead forwards"""
        self._component = [0] * len(successors)
        for number, members in enumerate(self._members):
            for node in members:
                self._component[node] = number
        self.cycle = self._cycle_that_takes_time()

    def _after(self, node: int) -> list[int]:
        return [target for target, *_ in self.successors[node]]

    def never_end(self) -> bool:
        """Whether a run may go round for ever, with or without time."""
        return any(len(members) > 1 for members in self._members) or any(
            node in self._after(node) for node in range(len(self.successors))
        )

    def around(self) -> list[int]:
        """The marks of what is on the cycle that takes time, without those that are no element's."""
        out = []
        for node, target in zip(self.cycle, [*self.cycle[1:], *self.cycle[:1]], strict=True):
            out.append(max(mark for to, _, mark in self.successors[node] if to == target))
        return [m for m in out if m >= 0]

    def longest(self, ends: Collection[int] | None = None) -> TimedPath | None:
        """The longest way; None: there is none, or, with a cycle, no longest one.

        Args:
            ends: to one of these ends; None: to any.
        """
        if self.cycle or not self.leading[0]:
            return None
        best: dict[int, int] = {self._component[0]: 0}
        entry: dict[int, tuple[int, int, int]] = {}
        for c, members in enumerate(self._members):
            if c not in best:
                continue
            for node in sorted(members):
                for target, ns, mark in self.successors[node]:
                    other = self._component[target]
                    if other == c or not self.leading[target]:
                        continue
                    total = best[c] + ns
                    if total > best.get(other, -1):
                        best[other] = total
                        entry[other] = (node, target, mark)
        wanted = self.ends if ends is None else ends
        there = [n for n in sorted(wanted) if self._component[n] in best]
        if not there:
            return None
        end = max(there, key=lambda n: best[self._component[n]])
        return TimedPath(best[self._component[end]], tuple(self._way(entry, end)))

    def _way(self, entry: dict[int, tuple[int, int, int]], end: int) -> list[tuple[int, int]]:
        out: list[tuple[int, int]] = []
        node = end
        while True:
            component = self._component[node]
            found = entry.get(component)
            first = found[1] if found is not None else 0
            out += reversed(self._inside(first, node))
            if found is None:
                return out[::-1]
            node, target, mark = found
            out.append((target, mark))

    def _inside(self, first: int, last: int) -> list[tuple[int, int]]:
        """A way inside a component, where nothing takes time."""
        if first == last:
            return []
        component = self._component[first]
        before: dict[int, tuple[int, int]] = {}
        todo = [first]
        for node in todo:
            for target, _, mark in self.successors[node]:
                if (
                    self._component[target] == component
                    and target != first
                    and target not in before
                ):
                    before[target] = (node, mark)
                    todo.append(target)
        out = []
        node = last
        while node != first:
            parent, mark = before[node]
            out.append((node, mark))
            node = parent
        return out[::-1]

    def _cycle_that_takes_time(self) -> list[int]:
        """The nodes of one, in order; []: there is none."""
        component = self._component
        for node, arcs in enumerate(self.successors):
            for target, ns, _ in arcs:
                if ns > 0 and component[target] == component[node] and self.leading[node]:
                    if target == node:
                        return [node]
                    back = [n for n, _ in self._inside(target, node)]
                    return [node, target, *back[:-1]]
        return []


def longest_inside(successors: Sequence[Sequence[Arc]], inside: Collection[int]) -> int | None:
    """How long one can be among these nodes, until they are left (ns); None: as long as one likes."""
    if not inside:
        return 0
    numbers = {node: i for i, node in enumerate(sorted(inside), 1)}
    left = len(numbers) + 1
    graph: list[list[Arc]] = [[(i, 0, 0) for i in numbers.values()]]
    for node in numbers:
        arcs = [(numbers.get(target, left), ns, 0) for target, ns, _ in successors[node]]
        graph.append([*arcs, (left, 0, 0)])
    graph.append([])
    paths = TimedPaths(graph, {left})
    found = paths.longest()
    return None if paths.cycle or found is None else found.ns


def _back(before: dict[int, tuple[int, int]], node: int) -> list[tuple[int, int]]:
    out = []
    while node in before:
        parent, mark = before[node]
        out.append((node, mark))
        node = parent
    return out[::-1]


def leading_to(successors: Sequence[Sequence[Arc]], ends: Collection[int]) -> list[bool]:
    """By node: whether one of these ends can be reached from it."""
    into: list[list[int]] = [[] for _ in successors]
    for node, arcs in enumerate(successors):
        for target, *_ in arcs:
            into[target].append(node)
    out = [False] * len(successors)
    todo = list(ends)
    for node in todo:
        out[node] = True
    while todo:
        for node in into[todo.pop()]:
            if not out[node]:
                out[node] = True
                todo.append(node)
    return out
