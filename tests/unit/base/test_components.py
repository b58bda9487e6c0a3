"""Strongly connected components of random graphs, and of a deep one."""

from __future__ import annotations

from random import Random

import pytest

from pn2code.base.components import components


@pytest.mark.parametrize("seed", range(20))
def test_components_are_those_of_mutual_reach(seed: int) -> None:
    r = Random(seed)
    graph = [[r.randrange(8) for _ in range(r.randint(0, 2))] for _ in range(8)]
    found = list(components(range(8), graph.__getitem__))
    component = {node: members[0] for members in found for node in members}
    place = {members[0]: i for i, members in enumerate(reversed(found))}
    assert sorted(component) == list(range(8)) and sum(map(len, found)) == 8

    def reach(node: int) -> set[int]:
        seen, todo = {node}, [node]
        while todo:
            for target in graph[todo.pop()]:
                if target not in seen:
                    seen.add(target)
                    todo.append(target)
        return seen

    reached = [reach(n) for n in range(8)]
    for a in range(8):
        for b in range(8):
            together = b in reached[a] and a in reached[b]
            assert (component[a] == component[b]) == together
        for target in graph[a]:
            assert place[component[a]] <= place[component[target]]


def test_a_deep_graph() -> None:
    """A ring of 100,000 nodes is one component."""
    most = 100_000
    (members,) = components([0], lambda n: [(n + 1) % most])
    assert len(members) == most
