"""Transitions that others imply: what is asked of liveness decides it, held against the whole graphs of random nets."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.examined import fireable, truths
from helpers.random_coloured import random_coloured
from helpers.random_tables import Graph, random_tables, restless_tables, sparse_tables
from helpers.thorough import amount
from pn2code.contest.examinations import Asked, Part, asked
from pn2code.contest.formulas import Op
from pn2code.contest.implied import Implied
from pn2code.contest.tables import Tables

MOST = 300


def can_occur(graph: Graph) -> dict[str, set[int]]:
    """Transition -> the markings from which it can occur."""
    return {t: graph.where(Op("E", (Op("F", (fireable(t),)),))) for t in graph.tables.transitions}


def rings(draw: random.Random) -> Tables:
    """Places in rings, some with a step aside: many transitions imply each other."""
    size = draw.randint(2, 6)
    pre: list[dict[int, int]] = [{i: 1} for i in range(size)]
    post: list[dict[int, int]] = [{(i + 1) % size: 1} for i in range(size)]
    for _ in range(draw.randint(0, 3)):
        pre.append({draw.randrange(size): draw.choice((1, 1, 2))})
        post.append({draw.randrange(size): 1 for _ in range(draw.randint(0, 2))})
    initial = tuple(draw.choice((0, 0, 1, 2)) for _ in range(size))
    return Tables(
        initial,
        tuple(pre),
        tuple(post),
        {f"p{p}": (p,) for p in range(size)},
        {f"t{t}": (t,) for t in range(len(pre))},
    )


def joined(draw: random.Random) -> Tables:
    """Some transitions are bindings of one."""
    tables = draw.choice((rings, sparse_tables, random_tables))(draw)
    of: dict[str, tuple[int, ...]] = {"none": ()} if draw.random() < 0.1 else {}
    for t in range(len(tables.pre)):
        name = f"t{draw.randrange(3)}"
        of[name] = (*of.get(name, ()), t)
    return replace(tables, transitions=of)


def coloured(draw: random.Random) -> Tables:
    """Unfolded symmetric nets."""
    return random_coloured(draw).tables()


FAMILIES = (rings, joined, sparse_tables, random_tables, restless_tables, coloured)


@pytest.mark.parametrize("family", FAMILIES)
def test_what_is_implied(family: Callable[[random.Random], Tables]) -> None:
    """What is asked is as true as all; without dead markings a net is live if each transition implies all."""
    less = one = live = 0
    for seed in range(amount(20, 150)):
        tables = family(random.Random(seed))
        graph = Graph.of(tables, MOST)
        if graph is None:
            continue
        where, everywhere = can_occur(graph), len(graph.markings)
        truth = truths(graph)
        for again in (True, False):
            found = Implied(tables, again=again)
            names = found.asked()
            holds = {t: len(w) == everywhere if again else 0 in w for t, w in where.items()}
            assert all(holds.values()) == all(holds[t] for t in names), (seed, again)
            for name, closed in zip(found.names, found.closed, strict=True):
                implied = [t for i, t in enumerate(found.names) if closed >> i & 1]
                assert not holds[name] or all(holds[t] for t in implied), (seed, again, name)
            less += len(names) < len(where)
            if again and found.is_one and where:
                assert truth["Liveness"] is not truth["ReachabilityDeadlock"], seed
                one += 1
        live += truth["Liveness"]
    assert less, "nothing was ever implied"
    assert (live and one) or family is not rings


def test_what_can_occur_with_the_tokens_of_a_binding() -> None:
    """A fork and what joins again, step by step."""
    tables = Tables(
        (1, 0, 0, 0, 0),
        ({0: 1}, {1: 1}, {2: 1}, {3: 1, 4: 1}),
        ({1: 1, 2: 1}, {3: 1}, {4: 1}, {0: 1}),
        {},
        {name: (i,) for i, name in enumerate(("fork", "left", "right", "join"))},
    )
    found = Implied(tables, again=True)
    assert found.is_one and len(found.asked()) == 1
    assert asked_liveness(tables) == Asked(
        "Liveness", (Part("reach", "reach dead"),), is_turned=True
    )


def test_places_that_several_fill() -> None:
    """What all of them imply is implied: c by d, since a and b both lead to it; but neither a nor b."""
    tables = Tables(
        (1, 0, 0),
        ({0: 1}, {0: 1}, {1: 1}, {2: 1}),
        ({1: 1, 2: 1}, {1: 1, 2: 1}, {}, {0: 1}),
        {},
        {name: (i,) for i, name in enumerate("abcd")},
    )
    found = Implied(tables, again=True)
    closed = {
        n: {m for i, m in enumerate("abcd") if found.closed["abcd".index(n)] >> i & 1}
        for n in "abcd"
    }
    assert closed["d"] == set("abcd") and found.is_one


def test_nothing_is_implied_without_colours() -> None:
    """Tokens of a net without its colours may be of different ones."""
    tables = Tables((1,), ({0: 1}, {0: 1}), ({0: 1}, {0: 1}), {}, {"a": (0,), "b": (1,)})
    assert Implied(tables, again=True).is_one
    without = Implied(replace(tables, at_first=frozenset("ab")), again=True)
    assert not without.is_one and without.asked() == ["a", "b"]


def asked_liveness(tables: Tables) -> Asked:
    """The line of the examination."""
    (found,) = asked(tables, "Liveness", Path())
    return found
