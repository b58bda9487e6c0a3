"""The state equation against the whole graph of random nets: what it proves is so, and its certificates are checked."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Iterator

import pytest
import scipy.optimize

from helpers.random_tables import Graph, random_condition, random_tables
from helpers.thorough import amount
from pn2code.contest import certificates, conditions
from pn2code.contest.conditions import AtMost, Dead
from pn2code.contest.equation import StateEquation, wait_for_solver
from pn2code.contest.tables import Tables

NETS = amount(30, 150)


def later() -> float:
    return time.monotonic() + 600.0


def nets(seeds: range) -> Iterator[tuple[random.Random, Tables, Graph]]:
    for seed in seeds:
        draw = random.Random(seed)
        tables = random_tables(draw)
        graph = Graph.of(tables)
        if graph is not None and len(graph.markings) > 2:
            yield draw, tables, graph


def test_what_is_excluded_is_not_reachable() -> None:
    excluded = unreachable = 0
    for draw, tables, graph in nets(range(NETS)):
        equation = StateEquation(tables)
        for _ in range(6):
            formula = random_condition(draw, tables)
            condition = conditions.parsed(tables.formula(formula), tables.pre)
            where = graph.where(formula)
            assert where == {
                i for i, m in enumerate(graph.markings) if conditions.holds(condition, m)
            }
            unreachable += not where
            if equation.excludes(condition, later()):
                excluded += 1
                assert not where, (tables, formula)
        is_dead = any(not s for s in graph.successors)
        assert not (equation.excludes(Dead(), later()) and is_dead), tables
    assert excluded > 0.8 * unreachable


def test_bounds() -> None:
    exact = asked = 0
    for draw, tables, graph in nets(range(NETS, 2 * NETS)):
        equation = StateEquation(tables)
        for _ in range(4):
            places = draw.sample(range(len(tables.initial)), 2)
            factors = {places[0]: draw.choice((1, 2)), places[1]: draw.choice((1, 1, -1))}
            most = max(sum(n * m[p] for p, n in factors.items()) for m in graph.markings)
            found = equation.bound(factors, later())
            assert found is None or found >= most, tables
            asked += 1
            exact += found == most
        for p, most in equation.most.items():
            assert most >= max(m[p] for m in graph.markings), tables
    assert exact > 0.6 * asked


def test_a_marked_trap_stays_marked() -> None:
    """Two tokens become one: the equation alone would let that happen twice."""
    tables = Tables((2,), ({0: 2},), ({0: 1},), {}, {})
    equation = StateEquation(tables)
    assert equation.excludes(AtMost(((0, 1),), 0), later())
    assert equation.traps == [AtMost(((0, -1),), -1)]
    assert not equation.excludes(AtMost(((0, 1),), 1), later())


def test_steps_that_cannot_begin() -> None:
    """Two transitions that each need what the other fills: the equation alone would let them fill r."""
    tables = Tables((0, 0, 0), ({0: 1}, {1: 1}), ({1: 1, 2: 1}, {0: 1}), {}, {})
    equation = StateEquation(tables)
    assert equation.bound({2: 1}, later()) is None
    assert equation.excludes(AtMost(((2, -1),), -1), later())
    begun = StateEquation(Tables((1, 0, 0), tables.pre, tables.post, {}, {}))
    assert not begun.excludes(AtMost(((2, -1),), -1), later())
    assert begun.guide == {0: 1}


def test_certificates_that_prove_nothing_are_refused() -> None:
    """Whatever is drawn: what passes is true."""
    passed = 0
    for draw, tables, graph in nets(range(2 * NETS, 3 * NETS)):
        effects = StateEquation(tables).effects
        places = range(len(tables.initial))
        for _ in range(60):
            rows = [
                AtMost(tuple((p, draw.choice((-1, 1))) for p in places), draw.randint(-4, 2))
                for _ in range(2)
            ]
            factors = [draw.choice((-1, 0, 1, 1)) for _ in rows]
            weight = {p: draw.choice((-1, 0, 0, 1)) for p in places}
            if certificates.is_refuted(rows, factors, weight, tables.initial, effects):
                passed += 1
                assert not any(all(r.holds(m) for r in rows) for m in graph.markings)
            wanted = {p: draw.choice((0, 1)) for p in places}
            claimed = certificates.bound(wanted, weight, 1, tables.initial, effects)
            if claimed is not None:
                assert all(
                    sum(n * m[p] for p, n in wanted.items()) <= claimed for m in graph.markings
                )
    assert passed > 20


def test_a_certificate_that_cannot_be_rounded_is_solved_exactly() -> None:
    """The weights of the places have denominators that no rounding finds."""
    p, q = 7919, 7907
    tables = Tables((p * q - 1, 0, 0), ({0: p}, {1: q}), ({1: q + 2}, {2: p + 8}), {}, {})
    most = (p * q - 1) * (q + 2) * (p + 8) // (p * q)
    equation = StateEquation(tables)
    assert equation.bound({2: 1}, later()) == most
    assert equation.excludes(AtMost(((2, -1),), -most - 1), later())


def test_the_end_waits_for_the_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    """A program that ends while HiGHS runs is ended by it with an error; nothing new begins after the end."""
    begun, may_go_on, done = threading.Event(), threading.Event(), threading.Event()
    solve = scipy.optimize.linprog

    def slow(*args: object, **options: object) -> object:
        begun.set()
        may_go_on.wait(600.0)
        done.set()
        return solve(*args, **options)

    monkeypatch.setattr(scipy.optimize, "linprog", slow)
    is_over = threading.Event()
    searching = StateEquation(Tables((2,), ({0: 2},), ({0: 1},), {}, {}), is_over)
    condition = AtMost(((0, 1),), 0)
    thread = threading.Thread(target=searching.excludes, args=(condition, later()))
    thread.start()
    assert begun.wait(600.0)
    is_over.set()
    threading.Timer(0.05, may_go_on.set).start()
    wait_for_solver()
    assert done.is_set()
    thread.join()
    begun.clear()
    assert not searching.excludes(condition, later()) and not begun.is_set()
