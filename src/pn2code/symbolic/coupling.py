"""Orders of places made better by moving parts of them, so that little is shared across each level.

    better = improved(places, pre, post, start, until)

What the places above a level say of those below it is, at least, what invariants across the level say: their number is
rank(above) + rank(below) - rank(all) of the effects of the transitions (iRank: Amparore, Ciardo, Donatelli, Miner
2019). Together with the levels that transitions reach over, this is the cost of an order here; each move that does not
make it larger is kept (local search). The rank is that over the numbers modulo 2, where an effect is a set of bits,
which only matters for how good the order is.
"""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Callable, Sequence
from math import inf
from typing import TYPE_CHECKING

from pn2code.base.late import Late
from pn2code.symbolic.order import Arcs, Spans, touched

if TYPE_CHECKING:
    import numpy as np
else:
    np = Late("numpy")

REACH = 4.0
"""So much counts the levels that transitions reach over, next to the squares of how many invariants cross a level."""
_PART = 0.12
"""One over how many places are moved together, on average."""
_NEAR = 0.6
"""So many moves go to a place that shares a transition with one that is moved."""
_TURNED = 0.3
_WIDE = 8
"""A transition with more places says little about which of them belong together."""
MOST = 4_000_000
"""Places times transitions; the rank of more takes too long."""


def improved(
    places: int,
    pre: Arcs,
    post: Arcs,
    start: Sequence[int],
    *,
    until: float,
    processor: float = inf,
    enough: Callable[[], bool] = lambda: False,
    seed: int = 1,
    moves: int = sys.maxsize,
) -> list[int]:
    """An order of all places that costs no more than the first one, which it is if the net is large.

    Args:
        places: how many there are.
        pre: what transitions take.
        post: what they put.
        start: the order to begin with, from the top downwards.
        until: when to stop, on the monotonic clock.
        processor: seconds of it that the thread may use.
        enough: asked before each move: whether nobody wants the order any more.
        seed: of the moves.
        moves: that are tried at most.
    """
    if places < 2 or places * len(pre) > MOST:
        return list(start)
    net = Coupled(places, pre, post)
    draw = random.Random(seed)
    order = list(start)
    lowest = net.cost(order)
    began = time.thread_time()
    for _ in range(moves):
        if time.monotonic() >= until or time.thread_time() - began >= processor or enough():
            break
        moved = net.moved(order, draw)
        cost = net.cost(moved)
        if cost <= lowest:
            order, lowest = moved, cost
    return order


class Coupled:
    """What a net says of orders of its places.

    Args:
        places: how many there are.
        pre: what transitions take.
        post: what they put.
    """

    def __init__(self, places: int, pre: Arcs, post: Arcs) -> None:
        self.effects = [0] * places
        """Place -> a bit for each transition that changes it by an odd number."""
        self.near: list[list[int]] = [[] for _ in range(places)]
        for t, (a, b) in enumerate(zip(pre, post, strict=True)):
            both = sorted({*a, *b})
            for p in both:
                if (b.get(p, 0) - a.get(p, 0)) % 2:
                    self.effects[p] |= 1 << t
                if len(both) <= _WIDE:
                    self.near[p] += [q for q in both if q != p]
        self.spans = Spans(places, touched(pre, post), is_narrow=True)

    def cost(self, order: list[int]) -> float:
        """What crosses the levels, as a number."""
        above = self._ranks(order)
        below = self._ranks(order[::-1])
        across = [a + b - above[-1] for a, b in zip(above[:-1], below[-2::-1], strict=True)]
        return sum(n * n for n in across) + REACH * self.spans.cost(np.array(order, np.int64))

    def _ranks(self, order: Sequence[int]) -> list[int]:
        """The rank of the effects of the first one, the first two...: Gauss's elimination, row by row."""
        basis: dict[int, int] = {}
        ranks = []
        for p in order:
            row = self.effects[p]
            while row:
                other = basis.get(row.bit_length())
                if other is None:
                    basis[row.bit_length()] = row
                    break
                row ^= other
            ranks.append(len(basis))
        return ranks

    def moved(self, order: list[int], draw: random.Random) -> list[int]:
        """The same with some places that follow each other at another level."""
        size = min(len(order) // 2, 1 + int(draw.expovariate(_PART)))
        at = draw.randrange(len(order) - size + 1)
        part = order[at : at + size]
        rest = order[:at] + order[at + size :]
        if draw.random() < _TURNED:
            part.reverse()
        to = draw.randrange(len(rest) + 1)
        near = self.near[draw.choice(part)]
        if near and draw.random() < _NEAR:
            place = draw.choice(near)
            if place not in part:
                to = rest.index(place) + draw.randrange(2)
        return rest[:to] + part + rest[to:]
