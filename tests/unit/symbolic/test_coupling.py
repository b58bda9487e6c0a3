"""Orders that are made better by moves: what crosses the levels."""

import random
import time

import pytest

from pn2code.symbolic import coupling
from pn2code.symbolic.coupling import improved
from pn2code.symbolic.order import Spans, touched


def _rings(rings: int, size: int) -> tuple[list[dict[int, int]], list[dict[int, int]]]:
    """Rings in each of which a token goes round."""
    pre = [{r * size + i: 1} for r in range(rings) for i in range(size)]
    post = [{r * size + (i + 1) % size: 1} for r in range(rings) for i in range(size)]
    return pre, post


def test_what_has_an_invariant_together_is_put_together() -> None:
    pre, post = _rings(4, 3)
    start = [r * 3 + i for i in range(3) for r in range(4)]
    order = improved(12, pre, post, start, until=time.monotonic() + 600.0, seed=3, moves=3000)
    assert [p // 3 for p in order[::3]] == [p // 3 for p in order[2::3]]


def test_a_better_order_has_all_places_and_costs_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    draw = random.Random(1)
    for _ in range(50):
        places = draw.randint(2, 12)
        some = [draw.sample(range(places), 2) for _ in range(draw.randint(1, 20))]
        pre = [{a: draw.randint(1, 2)} for a, _ in some]
        post = [{b: draw.randint(1, 2)} for _, b in some]
        start = draw.sample(range(places), places)
        order = improved(places, pre, post, start, until=time.monotonic() + 600.0, moves=50)
        assert sorted(order) == sorted(start)
        net = coupling.Coupled(places, pre, post)
        assert net.cost(order) <= net.cost(start)
    assert improved(2, [{0: 1}], [{1: 1}], [1, 0], until=0.0) == [1, 0]
    never = time.monotonic() + 600.0
    assert improved(2, [{0: 1}], [{1: 1}], [1, 0], until=never, enough=lambda: True) == [1, 0]
    monkeypatch.setattr(coupling, "MOST", 1)
    assert improved(2, [{0: 1}], [{1: 1}], [0, 1], until=time.monotonic() + 600.0) == [0, 1]


def test_as_many_invariants_cross_a_level_as_rings_are_cut() -> None:
    pre, post = _rings(2, 3)
    spans = Spans(6, touched(pre, post), is_narrow=True)
    net = coupling.Coupled(6, pre, post)

    def crossing(order: list[int]) -> float:
        return net.cost(order) - coupling.REACH * spans.cost(coupling.np.array(order))

    assert crossing([0, 1, 2, 3, 4, 5]) == pytest.approx(4.0)
    assert crossing([0, 3, 1, 4, 2, 5]) == pytest.approx(1 + 4 + 4 + 4 + 1)
