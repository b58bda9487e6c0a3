"""How much a swarm has seen: sketches of sets, compared with the sets themselves."""

from __future__ import annotations

import random

import pytest

from pn2code.verify.swarm.coverage import coverage, unseen

KEPT = 256


def sketches(sets: list[set[int]]) -> list[list[int]]:
    return [sorted(s)[:KEPT] for s in sets]


def hashes(count: int, seed: int) -> list[int]:
    r = random.Random(seed)
    return [r.getrandbits(64) for _ in range(count)]


def test_few_markings_are_counted() -> None:
    found = coverage(sketches([{1, 2, 3}, {3, 4}]), KEPT)
    assert (found.markings, found.is_exact, found.alone) == (4.0, True, 0.75)
    assert found.total is not None and found.total > 4.0


def test_searches_that_see_the_same_have_seen_all() -> None:
    same = set(hashes(50, 1))
    found = coverage(sketches([same, same, same]), KEPT)
    assert (found.markings, found.alone, found.total, found.part) == (50.0, 0.0, 50.0, 1.0)


def test_one_search_alone_tells_nothing_of_the_rest() -> None:
    found = coverage(sketches([set(hashes(1_000, 2))]), KEPT)
    assert found.total is None and found.part is None


def test_nothing_seen() -> None:
    found = coverage([[], []], KEPT)
    assert (found.markings, found.alone, found.total, found.part) == (0.0, 0.0, 0.0, None)


@pytest.mark.parametrize("seed", range(8))
def test_the_union_is_estimated(seed: int) -> None:
    """Within four standard errors, which are 1/16 of it for 256 hashes."""
    r = random.Random(seed)
    all_of_them = hashes(20_000, seed)
    sets = [set(r.sample(all_of_them, 4_000)) for _ in range(6)]
    true = len(set().union(*sets))
    found = coverage(sketches(sets), KEPT)
    assert not found.is_exact
    assert abs(found.markings - true) < 0.25 * true
    once = sum(sum(h in s for s in sets) == 1 for h in set().union(*sets)) / true
    assert abs(found.alone - once) < 0.13
    # What is drawn by chance tells how much there is.
    assert found.total is not None and abs(found.total - 20_000) < 0.35 * 20_000


def test_a_sketch_that_is_full_counts_nothing() -> None:
    whole = set(hashes(KEPT, 9))
    assert not coverage(sketches([whole, set()]), KEPT).is_exact


def test_unseen() -> None:
    """Chao's estimate, in the form without division by zero."""
    assert unseen(0.0, 5.0, 4) == 0.0
    assert unseen(10.0, 4.0, 2) == 0.5 * 10 * 9 / 10
    assert unseen(3.0, 0.0, 2) == 0.5 * 3 * 2 / 2
