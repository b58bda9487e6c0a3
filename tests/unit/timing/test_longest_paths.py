"""Shortest and longest paths of random graphs, next to all paths written out."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random

import pytest

from helpers.thorough import amount
from pn2code.timing.longest import Arc, TimedPaths, longest_inside, shortest


def acyclic(r: Random, count: int) -> list[list[Arc]]:
    out: list[list[Arc]] = []
    for n in range(count):
        later = range(n + 1, count)
        targets = r.sample(later, min(len(later), r.randint(0, 3)))
        out.append([(t, r.choice([0, 1, 5, 7]), 100 * n + t) for t in targets])
    return out


def all_ways(graph: list[list[Arc]], ends: set[int], node: int = 0, ns: int = 0) -> Iterator[int]:
    if node in ends:
        yield ns
    for target, more, _ in graph[node]:
        yield from all_ways(graph, ends, target, ns + more)


@pytest.mark.parametrize("seed", range(amount(20, 60)))
def test_they_are_the_least_and_the_most_of_all(seed: int) -> None:
    r = Random(seed)
    graph = acyclic(r, 9)
    ends = set(r.sample(range(9), 2))
    expected = list(all_ways(graph, ends))
    best, paths = shortest(graph, ends), TimedPaths(graph, ends)
    longest = paths.longest()
    assert not paths.cycle and not paths.never_end()
    if not expected:
        assert best is None and longest is None
        return
    assert best is not None and longest is not None
    assert (best.ns, longest.ns) == (min(expected), max(expected))
    for way in (best, longest):
        node = total = 0
        for target, mark in way.arcs:
            total += next(ns for t, ns, m in graph[node] if (t, m) == (target, mark))
            node = target
        assert (node, total) == (way.last, way.ns) and node in ends


def test_what_takes_time_may_not_go_round_on_the_way_to_an_end() -> None:
    graph: list[list[Arc]] = [[(1, 2, 10)], [(0, 0, 11), (2, 1, 12)], []]
    paths = TimedPaths(graph, {2})
    assert paths.longest() is None and set(paths.cycle) == {0, 1}
    assert paths.never_end()
    assert TimedPaths(graph, {0}).cycle  # the end itself is on it


def test_what_goes_round_elsewhere_does_not_matter() -> None:
    graph: list[list[Arc]] = [[(1, 2, 10), (3, 4, 13)], [(2, 1, 11)], [(1, 1, 12)], []]
    paths = TimedPaths(graph, {3})
    longest = paths.longest()
    assert longest is not None and longest.ns == 4 and not paths.cycle
    assert paths.never_end()


def test_going_round_in_no_time_is_no_repetition() -> None:
    graph: list[list[Arc]] = [[(1, 3, 10)], [(2, 0, 11)], [(1, 0, 12), (3, 2, 13)], []]
    longest = TimedPaths(graph, {3}).longest()
    assert longest is not None and longest.ns == 5
    assert [mark for _, mark in longest.arcs] == [10, 11, 13]


def test_a_weight_counts_only_what_is_asked() -> None:
    graph: list[list[Arc]] = [[(1, 5, 1), (2, 1, 2)], [(3, 1, 2)], [(3, 9, 1)], []]
    found = shortest(graph, {3}, lambda ns, mark: ns if mark == 2 else 0)
    assert found is not None and found.ns == 1


def test_how_long_one_can_be_inside() -> None:
    graph: list[list[Arc]] = [[(1, 9, 0)], [(2, 3, 0), (3, 1, 0)], [(3, 4, 0)], [(0, 50, 0)]]
    assert longest_inside(graph, {1, 2}) == 7
    assert longest_inside(graph, {2}) == 4
    assert longest_inside(graph, set()) == 0
    assert longest_inside(graph, {0, 1, 2, 3}) is None
