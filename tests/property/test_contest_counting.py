"""Nets made smaller to be counted: their numbers are those of the whole graph."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from math import comb
from pathlib import Path

import pytest

from helpers.examined import sizes
from helpers.random_tables import Graph, random_tables, restless_tables
from helpers.table_families import kanban
from pn2code.contest.counting import Counted, smaller
from pn2code.contest.engine import Space, Task, ask, engine
from pn2code.contest.portfolio import space
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics

SECONDS = 600.0
"""Ends what hangs; nothing takes that long, on however busy a machine."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def circuits(draw: random.Random) -> Tables:
    """Tokens that move, most of them one by one, with a place that holds a sum of what others hold, or more."""
    places = draw.randint(2, 8)
    initial = [draw.choice((0, 0, 0, 1, 2, 3)) for _ in range(places)]
    pre: list[dict[int, int]] = []
    post: list[dict[int, int]] = []
    for _ in range(draw.randint(2, 9)):
        kind = draw.random()
        taken, put = {draw.randrange(places): 1}, {draw.randrange(places): 1}
        if kind < 0.15:
            taken, put = (dict.fromkeys(draw.sample(range(places), 2), 1) for _ in range(2))
        elif kind < 0.25:
            taken = {draw.randrange(places): draw.randint(1, 2)}
        elif kind < 0.33:
            taken = {draw.randrange(places): draw.randint(1, 2)}
            put = dict(taken)
        elif kind < 0.4:
            put = {}
        pre.append(taken)
        post.append(put)
    if draw.random() < 0.5:
        _add_sum(draw, initial, pre, post)
    return _tables(initial, pre, post)


def _add_sum(
    draw: random.Random, initial: list[int], pre: list[dict[int, int]], post: list[dict[int, int]]
) -> None:
    some = draw.sample(range(len(initial)), draw.randint(1, min(3, len(initial))))
    factors = {p: draw.randint(1, 2) for p in some}
    for taken, put in zip(pre, post, strict=True):
        needed = sum(n * taken.get(p, 0) for p, n in factors.items())
        change = sum(n * put.get(p, 0) for p, n in factors.items()) - needed
        least = max(0, -change)
        wanted = least if draw.random() < 0.6 else draw.randint(least, max(least, needed + 1))
        taken |= {len(initial): wanted} if wanted else {}
        put |= {len(initial): wanted + change} if wanted + change else {}
    initial.append(sum(n * initial[p] for p, n in factors.items()) + draw.randint(0, 2))


def _tables(initial: list[int], pre: list[dict[int, int]], post: list[dict[int, int]]) -> Tables:
    names = {f"p{i}": (i,) for i in range(len(initial))}
    return Tables(
        tuple(initial), tuple(pre), tuple(post), names, {f"t{i}": (i,) for i in range(len(pre))}
    )


def _counted(program: Path, tables: Tables) -> tuple[Counted, Space | None]:
    made = smaller(tables, time.monotonic() + SECONDS)
    assert made is not None
    text = made.text(range(len(made.leaves)))
    found = list(ask(program, [Task("sizes", text, SECONDS, 256)]))
    assert all(isinstance(f, Space) for f in found)
    return made, next((f for f in found if isinstance(f, Space)), None)


def test_random_nets(program: Path) -> None:
    shared = sums = 0
    for seed in range(60):
        draw = random.Random(seed)
        tables = (circuits, circuits, random_tables, restless_tables)[seed % 4](draw)
        graph = Graph.of(tables, 1000)
        if graph is None:
            continue
        made, found = _counted(program, tables)
        assert sizes(found) == graph.sizes, seed
        shared += max(made.leaves, default=0) > 1
        sums += sum(made.leaves) < len(tables.initial)
    assert shared > 10 and sums > 20


def test_tokens_that_go_round_by_themselves(program: Path) -> None:
    """A thousand of them on a ring of ten places: one place is left, and no marking is looked at."""
    pre = [{i: 1} for i in range(10)]
    post = [{(i + 1) % 10: 1} for i in range(10)]
    made, found = _counted(program, _tables([1000, *[0] * 9], pre, post))
    assert made.leaves == (10,)
    assert sizes(found) == (comb(1009, 9), 10 * comb(1008, 9), 1000, 1000)


def test_what_is_put_further_on_has_not_been_before(program: Path) -> None:
    """The second place of a chain is filled from elsewhere, or has tokens at first: it keeps its own number."""
    chain = ([{0: 1}], [{1: 1}])
    found = _counted(program, _tables([2, 1], *chain))[1]
    assert sizes(found) == (3, 2, 3, 3)
    pre, post = [{0: 1}, {2: 1}], [{1: 1}, {1: 1}]
    found = _counted(program, _tables([1, 0, 1], pre, post))[1]
    assert sizes(found) == (4, 4, 2, 2)


def test_a_place_whose_tokens_follow_may_hold_the_most(program: Path) -> None:
    """Three times what another one holds, and two."""
    pre, post = [{0: 1}, {1: 1, 2: 3}], [{1: 1, 2: 3}, {0: 1}]
    made, found = _counted(program, _tables([2, 0, 2], pre, post))
    assert sum(made.leaves) == 2
    assert sizes(found) == (3, 4, 8, 10)


def test_a_place_that_others_depend_on_stays(program: Path) -> None:
    """The complement of a place is an obstacle where nothing else is needed."""
    pre, post = [{0: 1}, {1: 2}], [{1: 1}, {0: 2}]
    made, found = _counted(program, _tables([3, 0], pre, post))
    assert sizes(found) == (4, 5, 3, 3)
    assert sum(made.leaves) == 2


def test_a_large_kanban_system(program: Path) -> None:
    """Three places of each station are one."""
    found = space(program, kanban(60), seconds=SECONDS, mebibytes=1024, only="diagrams")
    n = 60
    states = comb(n + 3, 3) ** 2 * sum(comb(n - k + 2, 2) ** 2 for k in range(n + 1))
    assert found is not None and found.tokens_in_marking == 4 * n
    assert found.states == states
