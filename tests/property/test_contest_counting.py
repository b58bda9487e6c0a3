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
from pn2code.contest.counted import Counted
from pn2code.contest.counting import smaller
from pn2code.contest.engine import Space, Task, ask, engine
from pn2code.contest.reduction.net import Affine
from pn2code.contest.space import space
from pn2code.contest.tables import Tables
from pn2code.contest.units import units_of
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
    return made, _sizes(program, made)


def _sizes(program: Path, made: Counted) -> Space | None:
    text = made.text(range(len(made.drawn.initial)))
    found = list(ask(program, [Task("sizes", text, SECONDS, 256)]))
    assert all(isinstance(f, Space) for f in found)
    return next((f for f in found if isinstance(f, Space)), None)


def automata(draw: random.Random) -> Tables:
    """Processes with a state each, which move alone or two at once, and look at the states of others."""
    first = [0]
    for _ in range(draw.randint(2, 4)):
        first.append(first[-1] + draw.randint(2, 4))
    initial = [0] * first[-1]
    for p in first[:-1]:
        initial[p + draw.randint(0, 1)] = 1
    pre: list[dict[int, int]] = []
    post: list[dict[int, int]] = []
    for _ in range(draw.randint(4, 12)):
        some = draw.sample(range(len(first) - 1), draw.choice((1, 1, 2)))
        taken = {draw.randrange(first[k], first[k + 1]): 1 for k in some}
        put = {draw.randrange(first[k], first[k + 1]): 1 for k in some}
        p = draw.randrange(first[-1])
        if draw.random() < 0.4 and p not in taken and p not in put:
            taken[p] = put[p] = 1
        pre.append(taken)
        post.append(put)
    return _tables(initial, pre, post)


def test_random_nets(program: Path) -> None:
    shared = sums = 0
    for seed in range(60):
        draw = random.Random(seed)
        tables = (circuits, automata, random_tables, restless_tables)[seed % 4](draw)
        graph = Graph.of(tables, 1000)
        if graph is None:
            continue
        made, found = _counted(program, tables)
        assert sizes(found) == graph.sizes, seed
        shared += max(made.leaves, default=0) > 1
        sums += sum(made.leaves) < len(tables.initial)
    assert shared > 10 and sums > 20


def test_random_automata_as_values(program: Path) -> None:
    """Nothing is made smaller; each place of its own, or in a unit."""
    units = 0
    for seed in range(30):
        tables = automata(random.Random(seed))
        graph = Graph.of(tables)
        assert graph is not None
        places = len(tables.initial)
        found = units_of(tables, time.monotonic() + SECONDS)
        total = Affine(0, dict.fromkeys(range(places), 1))
        sums = (Affine(1, {0: 2, places - 1: -1}),)
        made = Counted.of(tables, (1,) * places, tuple(range(places)), total, sums, found)
        states, arcs, in_place, in_marking = graph.sizes
        most = max(1 + 2 * m[0] - m[-1] for m in graph.markings)
        expected = states, arcs, max(in_place, most), in_marking
        assert sizes(_sizes(program, made)) == expected, seed
        assert sizes(_sizes(program, made.without_units())) == expected, seed
        units += len(found)
    assert units > 60


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


def test_one_of_several_places_is_a_value(program: Path) -> None:
    """Two processes of three states, one of which needs the other one to be in its first state, or in its last."""
    pre = [{0: 1, 3: 1}, {1: 1, 5: 1}, {2: 1}, {3: 1}, {4: 1, 0: 1}, {5: 1}]
    post = [{1: 1, 3: 1}, {2: 1, 5: 1}, {0: 1}, {4: 1}, {5: 1, 0: 1}, {3: 1}]
    tables = _tables([1, 0, 0, 1, 0, 0], pre, post)
    graph = Graph.of(tables)
    made, found = _counted(program, tables)
    assert graph is not None and sizes(found) == graph.sizes
    assert sorted(map(len, made.units)) == [2, 3] and len(made.drawn.initial) == 2


def test_a_large_kanban_system(program: Path) -> None:
    """Three places of each station are one."""
    found = space(program, kanban(60), seconds=SECONDS, mebibytes=1024, only="diagrams")
    n = 60
    states = comb(n + 3, 3) ** 2 * sum(comb(n - k + 2, 2) ** 2 for k in range(n + 1))
    assert found is not None and found.tokens_in_marking == 4 * n
    assert found.states == states
