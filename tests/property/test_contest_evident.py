"""What the form of a formula about one marking says is so in every marking."""

from __future__ import annotations

import random

import pytest

from helpers.random_tables import Graph, random_condition, random_tables
from pn2code.contest.evident import evident
from pn2code.contest.formulas import AtMost, Constant, Fireable, Formula, Op, Tokens, Truth
from pn2code.contest.rewriting import branching

T, TU = Fireable(("t",)), Fireable(("t", "u"))
P, PQ = Tokens(("p",)), Tokens(("p", "q"))


def no(f: Formula) -> Formula:
    return Op("not", (f,))


def both(*parts: Formula) -> Formula:
    return Op("and", parts)


def one(*parts: Formula) -> Formula:
    return Op("or", parts)


@pytest.mark.parametrize(
    ("f", "value"),
    [
        (one(T, no(T)), True),
        (both(T, no(TU)), False),
        (both(TU, no(T)), None),
        (one(TU, no(T)), True),
        (one(T, no(TU)), None),
        (no(one(both(T, no(T)), both(TU, no(TU)))), True),
        (one(one(T, AtMost(P, PQ)), T), True),
        (AtMost(PQ, P), None),
        (AtMost(Tokens(("p", "p")), P), None),
        (AtMost(Constant(0), P), True),
        (AtMost(Constant(1), P), None),
        (AtMost(P, Constant(-1)), False),
        (AtMost(Constant(3), Constant(2)), False),
        (both(Truth(True), T, one(T, T)), None),
        (both(), True),
        (both(one(T, no(AtMost(P, P))), no(T)), None),
    ],
)
def test_forms(f: Formula, value: bool | None) -> None:
    assert evident(f) is value
    assert evident(no(f)) is (None if value is None else not value)


def test_a_formula_of_time_is_decided_by_it() -> None:
    f = Op("A", (Op("G", (one(no(T), TU),)),))
    assert branching(f, lambda _: None) == Truth(True)


def test_it_is_so_in_all_markings() -> None:
    decided = 0
    for seed in range(60):
        draw = random.Random(seed)
        tables = random_tables(draw)
        graph = Graph.of(tables, 200)
        for _ in range(40 if graph else 0):
            f = random_condition(draw, tables, 3)
            value = evident(f)
            assert graph is not None
            if value is not None:
                decided += 1
                assert graph.where(f) == (set(range(len(graph.markings))) if value else set()), f
    assert decided > 50
