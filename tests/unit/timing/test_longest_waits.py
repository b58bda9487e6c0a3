"""`pn2code.timing.waits`: the longest wait for one event after another, in small graphs."""

from __future__ import annotations

from random import Random

import pytest

from pn2code.timing.longest import Arc
from pn2code.timing.waits import Wait, longest_wait, seen_wait

E, F, X = 1, 2, 0


def wait(graph: list[list[Arc]], ends: frozenset[int] = frozenset()) -> Wait:
    return longest_wait(graph, lambda m: m == E, lambda m: m == F, ends)


def test_the_longest_of_two_ways() -> None:
    found = wait([[(1, 5, E)], [(2, 3, X), (3, 1, F)], [(3, 4, F)], []])
    assert (found.ns, found.why) == (7, "")
    assert (found.before, found.way) == (0, ((1, E), (2, X), (-1, F)))


def test_who_is_never_asked_waits_for_nothing() -> None:
    assert wait([[(1, 5, F)], []]) == Wait(0)


@pytest.mark.parametrize(
    ("graph", "ends", "why"),
    [
        ([[(1, 0, E)], [(2, 1, F), (3, 1, X)], [], []], (), "never"),
        ([[(1, 0, E)], [(1, 1, X), (2, 1, F)], []], (), "repeats"),
        ([[(1, 0, E)], [(1, 0, X), (2, 1, F)], []], (), "idle"),
        ([[(1, 0, E)], [(2, 0, X), (3, 1, F)], [(1, 0, X)], []], (), "idle"),
        ([[(1, 0, E)], [(2, 1, F)], []], (1,), "ends"),
    ],
)
def test_there_is_no_longest_wait(graph: list[list[Arc]], ends: tuple[int, ...], why: str) -> None:
    found = wait(graph, frozenset(ends))
    assert (found.ns, found.why) == (None, why)


@pytest.mark.parametrize(
    ("graph", "over", "expected"),
    [
        # Node 2 was not looked at any more: so far somebody has waited for 3.
        ([[(1, 5, E)], [(2, 3, X), (3, 1, F)], [], []], (), Wait(3)),
        # Who waits after the end of the cycle does not count.
        ([[(1, 5, E)], [(2, 3, X)], [(3, 9, X)], []], (2,), Wait(3)),
        ([[(1, 5, X)], [(2, 0, X)], [(3, 1, E)], [(4, 9, X)], []], (1,), Wait(0)),
        ([[(1, 5, E)], [(1, 1, X), (2, 1, F)], []], (), Wait(None, "repeats")),
        ([[(1, 5, E)], [(1, 0, X), (2, 4, X)], []], (), Wait(4)),
        ([[(1, 5, F)], []], (), Wait(0)),
    ],
)
def test_of_a_part_it_is_known_how_long_a_run_waits_at_least(
    graph: list[list[Arc]], over: tuple[int, ...], expected: Wait
) -> None:
    found = seen_wait(graph, lambda m: m == E, lambda m: m == F, over)
    assert (found.ns, found.why) == (expected.ns, expected.why)


def test_an_event_of_both_kinds_waits_for_the_next_one() -> None:
    graph: list[list[Arc]] = [[(1, 0, E)], [(2, 3, E)], []]
    found = longest_wait(graph, lambda m: m == E, lambda m: m == E, ())
    assert found.why == "never"


def test_walks_never_wait_longer() -> None:
    seen = set()
    for seed in range(300):
        random = Random(seed)
        size = random.randint(3, 8)
        graph: list[list[Arc]] = [
            [
                (
                    random.randrange(node + 1, size + 1),
                    random.randint(0, 9),
                    random.choice((E, F, X)),
                )
                for _ in range(random.randint(1, 2))
            ]
            for node in range(size)
        ]
        graph.append([])
        found = wait(graph)
        longest, is_met = 0, True
        for _ in range(40):
            node, now, since = 0, 0, None
            while graph[node]:
                node, ns, mark = random.choice(graph[node])
                now += ns
                if mark == F and since is not None:
                    longest, since = max(longest, now - since), None
                if mark == E and since is None:
                    since = now
            is_met = is_met and since is None
        seen.add(found.why)
        assert found.why == "never" or (is_met and found.ns is not None and longest <= found.ns)
        assert found.ns is None or found.ns == 0 or found.way[0][1] == E
    assert seen == {"", "never"}
