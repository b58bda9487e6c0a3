"""Strongly connected components of a graph.

    list(components([1, 2, 3], {1: [2], 2: [1], 3: [1]}.__getitem__))     # [[1, 2], [3]]

By Tarjan (Depth-first search and linear graph algorithms, 1972), without recursion: graphs may be deep.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator
from typing import TypeVar

Node = TypeVar("Node", bound=Hashable)


def components(
    nodes: Iterable[Node], after: Callable[[Node], Iterable[Node]]
) -> Iterator[list[Node]]:
    """The components that can be reached from some nodes, each after all others that can be reached from it.

    Args:
        nodes: where to begin.
        after: the nodes to which there is an arc.
    """
    index: dict[Node, int] = {}
    low: dict[Node, int] = {}
    waiting: list[Node] = []
    is_waiting: set[Node] = set()
    for root in nodes:
        if root in index:
            continue
        stack = [(root, iter(after(root)))]
        index[root] = low[root] = len(index)
        waiting.append(root)
        is_waiting.add(root)
        while stack:
            node, rest = stack[-1]
            for other in rest:
                if other not in index:
                    index[other] = low[other] = len(index)
                    waiting.append(other)
                    is_waiting.add(other)
                    stack.append((other, iter(after(other))))
                    break
                if other in is_waiting:
                    low[node] = min(low[node], index[other])
            else:
                stack.pop()
                if stack:
                    parent = stack[-1][0]
                    low[parent] = min(low[parent], low[node])
                if low[node] == index[node]:
                    members = [waiting.pop()]
                    while members[-1] != node:
                        members.append(waiting.pop())
                    is_waiting.difference_update(members)
                    yield members[::-1]
