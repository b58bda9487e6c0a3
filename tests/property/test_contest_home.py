"""Home markings that are proved, and what they say of formulas, against the whole graph of random nets."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.random_tables import Graph, random_branching, random_condition
from helpers.table_families import FAMILIES, kanban
from helpers.thorough import amount
from pn2code.contest import home
from pn2code.contest.engine import engine
from pn2code.contest.examinations import Asked, asked
from pn2code.contest.formulas import AtMost, Constant, Formula, Op, Tokens
from pn2code.contest.home import is_home
from pn2code.contest.portfolio import answers
from pn2code.contest.rewriting import path
from pn2code.contest.tables import Tables
from pn2code.contest.temporal import Reach, Temporal
from pn2code.diagnostics import Diagnostics

SECONDS = 600.0
"""Ends what hangs."""


def circuits(draw: random.Random) -> Tables:
    """Parts that go round, with resources that some steps take and later ones give back, or that are lost."""
    initial: list[int] = [draw.randrange(1, 3) for _ in range(draw.randrange(1, 3))]
    resources = len(initial)
    pre: list[dict[int, int]] = []
    post: list[dict[int, int]] = []
    for _ in range(draw.randrange(1, 4)):
        first, length = len(initial), draw.randrange(2, 5)
        initial += [draw.randrange(1, 3)] + [0] * (length - 1)
        taken, given = draw.randrange(resources), draw.randrange(resources)
        for i in range(length):
            pre.append({first + i: 1})
            post.append({first + (i + 1) % length: 1})
        pre[-length][taken] = 1
        post[-1][taken if draw.random() < 0.9 else given] = 1
        if draw.random() < 0.5:  # a step back, or a leap
            pre.append({first + draw.randrange(1, length): 1})
            post.append({first + draw.randrange(length): 1})
    if draw.random() < 0.2:
        pre.append({draw.randrange(len(initial)): 1})
        post.append({draw.randrange(len(initial)): 1})
    names = {f"p{i}": (i,) for i in range(len(initial))}
    moves = {f"t{i}": (i,) for i in range(len(pre))}
    return Tables(tuple(initial), tuple(pre), tuple(post), names, moves)


def cases(seeds: range) -> Iterator[tuple[random.Random, Tables, Graph]]:
    """Nets with small graphs."""
    for seed in seeds:
        draw = random.Random(seed)
        tables = circuits(draw)
        graph = Graph.of(tables, 400)
        if graph is not None:
            yield draw, tables, graph


def leads_home(graph: Graph) -> bool:
    """Whether each marking leads to the initial one."""
    before: list[list[int]] = [[] for _ in graph.markings]
    for i, after in enumerate(graph.successors):
        for j in after:
            before[j].append(i)
    found, todo = {0}, [0]
    while todo:
        new = set(before[todo.pop()]) - found
        found |= new
        todo += new
    return len(found) == len(graph.markings)


def proved(tables: Tables) -> bool:
    """Whether it is found to be a home marking."""
    return is_home(tables, time.monotonic() + SECONDS)


def test_what_is_proved_is_so() -> None:
    found = homes = others = 0
    for _, tables, graph in cases(range(amount(25, 400))):
        is_so, is_proved = leads_home(graph), proved(tables)
        assert is_so or not is_proved, tables
        found += is_proved
        homes += is_so
        others += not is_so
    assert found > 0.5 * homes > 5 and others > 5


@pytest.mark.parametrize("family", FAMILIES)
def test_families(family: str) -> None:
    tables = FAMILIES[family]()
    graph = Graph.of(tables, 2000)
    assert graph is not None
    assert leads_home(graph) or not proved(tables)


def test_formulas_say_the_same() -> None:
    """With some answers of the graph put in, in any order."""
    changed = 0
    for draw, tables, graph in cases(range(1000, 1000 + amount(40, 300))):
        if not leads_home(graph):
            continue
        for _ in range(6):
            f = random_branching(draw, tables)
            wanted = 0 in graph.where(f)
            t, plain = Temporal(tables, "ctl", f), Temporal(tables, "ctl", f)
            t.learn_home()
            changed += t.formula != plain.formula or t.wanted != plain.wanted
            while True:
                assert (0 in graph.where(t.formula)) == wanted, (tables, f, t.formula)
                if not t.wanted or draw.random() < 0.2:
                    break
                question = draw.choice(t.wanted)
                is_reach = isinstance(question, Reach)
                answer = graph.where(question.condition if is_reach else question.formula)
                t.learn(question, bool(answer) if is_reach else 0 in answer)
                if question in t.wanted:
                    break
    assert changed > 10


def with_a_beginning(draw: random.Random, tables: Tables) -> Tables:
    """With a token that makes some steps once, the last of which brings another one."""
    first, length = len(tables.initial), draw.randrange(1, 4)
    initial = (*tables.initial, 1, *(0 for _ in range(length)))
    pre = [*tables.pre, *({first + i: 1} for i in range(length))]
    post: list[dict[int, int]] = [dict(a) for a in tables.post]
    post += [{first + i + 1: 1} for i in range(length)]
    if draw.random() < 0.5:
        post[-1][draw.randrange(first)] = 1
    names = {f"p{i}": (i,) for i in range(len(initial))}
    moves = {f"t{i}": (i,) for i in range(len(pre))}
    return Tables(initial, tuple(pre), tuple(post), names, moves)


def begun(seeds: range) -> Iterator[tuple[random.Random, Tables, Graph]]:
    """Nets of which some never come back to their initial marking."""
    for draw, tables, graph in cases(seeds):
        if draw.random() < 0.5:
            yield draw, tables, graph
        else:
            other = with_a_beginning(draw, tables)
            larger = Graph.of(other, 800)
            if larger is not None:
                yield draw, other, larger


def nested(draw: random.Random, tables: Tables) -> Formula:
    """A formula with EF p or AG p within another operator of time."""
    inner = path(*draw.choice(("EF", "AG")), random_condition(draw, tables))
    both = Op(draw.choice(("and", "or")), (inner, random_condition(draw, tables)))
    return path(draw.choice("AE"), draw.choice("FGX"), both)


def test_each_marking_leads_to_a_drained_one() -> None:
    found = 0
    for _, tables, graph in begun(range(2000, 2000 + amount(40, 400))):
        f = home.drained(tables)
        if f is not None:
            found += 1
            somewhere = path("E", "F", f)
            assert graph.where(somewhere) == set(range(len(graph.markings))), (tables, f)
    assert found > 20


def test_what_is_drained_says_the_same_of_formulas() -> None:
    """With some answers of the graph put in, in any order."""
    decided = 0
    for draw, tables, graph in begun(range(3000, 3000 + amount(50, 1500))):
        drained = home.drained(tables)
        if drained is None:
            continue
        for _ in range(6):
            f = draw.choice((random_branching, nested))(draw, tables)
            wanted = 0 in graph.where(f)
            t = Temporal(tables, "ctl", f)
            before = set(t.wanted)
            t.learn_drained(drained)
            new = set(t.wanted) - before
            while True:
                assert (0 in graph.where(t.formula)) == wanted, (tables, f, t.formula)
                if not t.wanted or draw.random() < 0.1:
                    break
                question = draw.choice([q for q in t.wanted if q in new] or t.wanted)
                is_reach = isinstance(question, Reach)
                answer = graph.where(question.condition if is_reach else question.formula)
                now = t.formula
                t.learn(question, bool(answer) if is_reach else 0 in answer)
                decided += question in new and t.formula != now
                new.discard(question)
                if question in t.wanted:
                    break
    assert decided > 20, decided


def test_formulas_of_a_large_net_that_never_comes_back() -> None:
    """Some 10^40 markings of Kanban, and a token that leaves its place for ever."""
    tables = with_a_beginning(random.Random(1), kanban(10**6))
    filled = next(p for p, n in enumerate(tables.initial) if n > 1)
    few = AtMost(Tokens((f"p{filled}",)), Constant(999_999))
    f = path("A", "G", path("E", "F", Op("not", (few,))))
    assert not proved(tables)
    with engine(Diagnostics()) as program:
        assert program is not None
        line = Asked("0", kind="ctl", formula=f)
        (found,) = answers(program, tables, [line], seconds=SECONDS)
    assert found.value is True


def test_large_nets_are_live() -> None:
    """Some 10^40 markings of Kanban; what is proved is that each part can be led out of it."""
    tables = kanban(10**6)
    assert proved(tables)
    with engine(Diagnostics()) as program:
        assert program is not None
        lines = asked(tables, "Liveness", Path())
        (found,) = answers(program, tables, lines, seconds=SECONDS)
    assert found.value is True


def test_without_a_drain_nothing_is_said() -> None:
    """A token that goes round in a net that has a token everywhere."""
    tables = Tables((1, 1), ({0: 1}, {1: 1}), ({1: 1}, {0: 1}), {}, {})
    assert home.drain(tables) == [] and not proved(tables)
