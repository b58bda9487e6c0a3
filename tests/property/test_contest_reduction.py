"""Structural reductions against the whole graph: what is reachable in visible places, and deadlocks, on random nets."""

from __future__ import annotations

import random
import time
from collections import Counter
from functools import cache

import pytest

from helpers.graph_equivalence import same_branching, same_steps, same_traces
from helpers.random_tables import Graph, sparse_tables
from helpers.thorough import amount
from pn2code.contest.conditions import AtMost, Dead
from pn2code.contest.reduction.net import Goal, Net
from pn2code.contest.reduction.reduce import RULES, Rule, apply_all, reduced_for
from pn2code.contest.tables import Tables

NETS = amount(750, 1500)
LARGEST = 1500
SMALL = 60
"""Markings of graphs that are compared path by path."""
SAME = {
    Goal.LINEAR: same_traces,
    Goal.BRANCHING: same_branching,
    Goal.STEPS: same_steps,
}
"""For formulas of time: when two graphs look the same."""


def graph_of(tables: Tables) -> Graph | None:
    return Graph.of(tables, LARGEST)


def seen(net: Net, graph: Graph, visible: list[int]) -> list[tuple[int, ...]]:
    """The tokens of visible places in each marking, worked out from the reduced net."""
    at = {p: i for i, p in enumerate(net.marking)}
    values = [net.value(p) for p in visible]
    return [
        tuple(v.constant + sum(n * m[at[q]] for q, n in v.factors.items()) for v in values)
        for m in graph.markings
    ]


def as_tables(net: Net) -> Tables:
    at = {p: i for i, p in enumerate(net.marking)}
    pre = tuple({at[p]: n for p, n in arcs.items()} for arcs in net.pre.values())
    post = tuple({at[p]: n for p, n in net.post[t].items()} for t in net.pre)
    return Tables(tuple(net.marking.values()), pre, post, {}, {})


def check(tables: Tables, graph: Graph, goal: Goal, visible: list[int], rules: list[Rule]) -> None:
    net = Net(tables, visible, goal)
    apply_all(net, rules, time.monotonic() + 600.0)
    for ends, arcs in ((net.takers, net.pre), (net.putters, net.post)):
        assert {(p, t) for p in ends for t in ends[p]} == {(p, t) for t in arcs for p in arcs[t]}
    after = graph_of(as_tables(net))
    assert after is not None, tables
    if goal in SAME:
        labels = [tuple(m[p] for p in visible) for m in graph.markings]
        pair = ((labels, graph.successors), (seen(net, after, visible), after.successors))
        assert SAME[goal](pair), (tables, visible)
    elif goal is Goal.DEADLOCK:
        assert any(not s for s in graph.successors) == any(not s for s in after.successors), tables
    else:
        before = {tuple(m[p] for p in visible) for m in graph.markings}
        assert before == set(seen(net, after, visible)), (tables, visible)


@cache
def random_nets(seeds: range) -> list[tuple[random.Random, Tables, Graph]]:
    found = []
    for seed in seeds:
        draw = random.Random(seed)
        tables = sparse_tables(draw)
        graph = graph_of(tables)
        if graph is not None and len(graph.markings) > 2:
            found.append((draw, tables, graph))
    return found


def test_all_rules_together() -> None:
    nets = random_nets(range(NETS))
    assert len(nets) > NETS // 4
    for draw, tables, graph in nets:
        visible = draw.sample(range(len(tables.initial)), draw.choice((1, 1, 2)))
        check(tables, graph, Goal.REACHABILITY, visible, list(RULES))
        if len(graph.markings) <= SMALL:
            for goal in SAME:
                check(tables, graph, goal, visible, [r for r in RULES if goal in r.keeps])
        rules = [r for r in RULES if Goal.DEADLOCK in r.keeps]
        check(tables, graph, Goal.DEADLOCK, [], rules)


@pytest.mark.parametrize("goal", list(Goal))
def test_each_rule_alone(goal: Goal) -> None:
    """Each rule occurs, and keeps what it says."""
    used: Counter[str] = Counter()
    rules = [r for r in RULES if goal in r.keeps]
    for i, (_, tables, graph) in enumerate(random_nets(range(NETS, 2 * NETS))):
        if goal in SAME and len(graph.markings) > SMALL:
            continue
        visible = [] if goal is Goal.DEADLOCK else [i % len(tables.initial)]
        for rule in rules:
            if rule.apply(Net(tables, visible, goal)):
                used[rule.name] += 1
                check(tables, graph, goal, visible, [rule])
    assert {r.name for r in rules} == used.keys()


def test_rules_that_keep_no_deadlocks_are_not_used_for_them() -> None:
    """A step that changes nothing is no deadlock."""
    tables = Tables((1,), ({0: 1},), ({0: 1},), {}, {})
    until = time.monotonic() + 600.0
    assert len(reduced_for(tables, [Dead()], until=until).tables.pre) == 1
    assert not reduced_for(tables, [AtMost(((0, 1),), 0)], until=until).tables.pre
