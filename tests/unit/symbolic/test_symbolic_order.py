"""Orders of places: all places once, those that depend on each other close together."""

from __future__ import annotations

import random

from pn2code.symbolic.order import orders

Arcs = list[dict[int, int]]


def ring(cells: int) -> tuple[int, Arcs, Arcs]:
    """Cells in a ring that share a fork with the next one; first all forks, then all that think, then all that eat."""
    pre: Arcs = []
    post: Arcs = []
    for i in range(cells):
        forks, thinks, eats = {i: 1, (i + 1) % cells: 1}, cells + i, 2 * cells + i
        pre += [{**forks, thinks: 1}, {eats: 1}]
        post += [{eats: 1}, {**forks, thinks: 1}]
    return 3 * cells, pre, post


def longest_span(order: list[int], pre: Arcs, post: Arcs) -> int:
    """Levels from the highest to the lowest place of a transition, the most."""
    level = {p: i for i, p in enumerate(order)}
    spans = []
    for a, b in zip(pre, post, strict=True):
        touched = [level[p] for p in {*a, *b}]
        spans.append(max(touched) - min(touched))
    return max(spans)


def test_each_order_has_all_places_once() -> None:
    draw = random.Random(1)
    for places in (1, 2, 3, 10, 40):
        pre = [{draw.randrange(places): 1} for _ in range(20)]
        post = [dict.fromkeys(draw.sample(range(places), min(places, 2)), 1) for _ in range(20)]
        for order in orders(places, pre, post):
            assert sorted(order) == list(range(places))


def test_the_most_promising_one_brings_together_what_belongs_together() -> None:
    places, pre, post = ring(50)
    found = orders(places, pre, post)
    assert longest_span(list(range(places)), pre, post) == 149, "as in the file"
    assert longest_span(found[0], pre, post) < 20
    assert len({tuple(o) for o in found}) == len(found) > 1, "different ones"
    assert found == orders(places, pre, post), "the same each time"


def test_nets_without_places_or_arcs() -> None:
    assert orders(0, [{}], [{}]) == [[]]
    assert sorted(orders(3, [], [])[0]) == [0, 1, 2]
    assert sorted(orders(2, [{}, {1: 1}], [{}, {1: 1}])[0]) == [0, 1]
