"""What follows from formulas of time, and what they follow from, against the whole graph of random nets."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from helpers.random_linear import holds, random_linear, temporal_parts
from helpers.random_tables import Graph, random_branching, random_tables, sparse_tables
from pn2code.contest.approximation import follows, is_nested, outline, suffices
from pn2code.contest.formulas import Formula, Op
from pn2code.contest.rewriting import is_plain
from pn2code.contest.tables import Tables
from pn2code.contest.temporal import Reach, Temporal

LARGEST = 40
"""Markings."""
MOST_PARTS = 4
"""Of a formula of linear time, since the states that say what holds are two to the power of it."""


def drawn(kind: str, seeds: range) -> Iterator[tuple[random.Random, Tables, Graph, Formula]]:
    """Random nets with small graphs, and a formula for each."""
    for seed in seeds:
        draw = random.Random(seed)
        tables = sparse_tables(draw) if seed % 2 else random_tables(draw)
        graph = Graph.of(tables, LARGEST)
        if graph is None or len(graph.markings) < 3:
            continue
        f = random_branching(draw, tables, 4)
        if kind == "ltl":
            f = Op("A", (random_linear(draw, tables, 3, draw.choice(("XFGU", "FGU"))),))
            if len(temporal_parts(f.parts[0])) > MOST_PARTS:
                continue
        yield draw, tables, graph, f


def truth(graph: Graph, kind: str, f: Formula) -> bool:
    """Whether a formula holds."""
    return 0 in graph.where(f) if kind == "ctl" else holds(graph, f)


def test_bounds_of_branching_time_in_every_marking() -> None:
    """Each one that is not trivial lies on its side of the formula."""
    strict = 0
    for _, tables, graph, f in drawn("ctl", range(300)):
        where = graph.where(f)
        for below in (suffices(f), outline(f, is_upper=False)):
            assert graph.where(below) <= where, (tables, f, below)
        for above in (follows(f), outline(f, is_upper=True)):
            assert graph.where(above) >= where, (tables, f, above)
            strict += where < graph.where(above) < set(range(len(graph.markings)))
    assert strict > 10


def test_bounds_of_linear_time() -> None:
    """What is weaker holds where the formula does, and what is stronger only there."""
    for _, tables, graph, f in drawn("ltl", range(300, 500)):
        above, below = outline(f, is_upper=True), outline(f, is_upper=False)
        assert not is_nested(above) and not is_nested(below)
        assert not (holds(graph, f) and not holds(graph, above)), (tables, f)
        assert not (holds(graph, below) and not holds(graph, f)), (tables, f)
        assert is_plain(follows(f)) and is_plain(suffices(f))


@pytest.mark.parametrize("kind", ["ctl", "ltl"])
def test_answers_that_only_help(kind: str) -> None:
    """All of them put in, a formula says the same, and some are decided without having been asked."""
    decided = made = 0
    for draw, tables, graph, f in drawn(kind, range(1000, 1400)):
        t = Temporal(tables, kind, f)
        wanted = truth(graph, kind, f)
        was_open = t.value is None
        while sides := [w for w in t.wanted if w.is_side]:
            w = draw.choice(sides)
            is_so = (
                bool(graph.where(w.condition))
                if isinstance(w, Reach)
                else truth(graph, kind, w.formula)
            )
            t.learn(w, is_so)
            assert w not in t.wanted
            assert truth(graph, kind, t.formula) == wanted, (tables, f, t.formula)
        decided += was_open and t.value is not None
        made += was_open
    assert made > 40 and decided > 10, (made, decided)
