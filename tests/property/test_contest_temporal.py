"""Formulas of time against the whole graph: rewriting, reduced nets, and all methods together, on random nets."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.random_linear import holds, random_linear, temporal_parts
from helpers.random_tables import Graph, random_branching, random_tables, sparse_tables
from helpers.thorough import amount
from pn2code.contest.engine import Answer, Task, ask, engine
from pn2code.contest.examinations import Asked
from pn2code.contest.formulas import AtMost, Constant, Formula, Op, Tokens
from pn2code.contest.portfolio import answers
from pn2code.contest.rewriting import has_next
from pn2code.contest.stepwise import question, smaller_for
from pn2code.contest.tables import Tables
from pn2code.contest.temporal import Reach, Temporal
from pn2code.diagnostics import Diagnostics

SECONDS = 600.0
"""Ends what hangs; nothing takes that long, on however busy a machine."""
LARGEST = 60
"""Markings."""
MOST_PARTS = 4
"""Of a formula of linear time, since the states that say what holds are two to the power of it."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def nets(seeds: range) -> Iterator[tuple[random.Random, Tables, Graph]]:
    """Random nets with small graphs."""
    for seed in seeds:
        draw = random.Random(seed)
        tables = sparse_tables(draw) if seed % 2 else random_tables(draw)
        graph = Graph.of(tables, LARGEST)
        if graph is not None and len(graph.markings) > 2:
            yield draw, tables, graph


def formulas(draw: random.Random, tables: Tables, kind: str, count: int) -> Iterator[Formula]:
    """Random ones of a kind."""
    while count:
        if kind == "ctl":
            f = random_branching(draw, tables, 4)
        else:
            f = Op("A", (random_linear(draw, tables, 3, draw.choice(("XFGU", "FGU"))),))
            if len(temporal_parts(f.parts[0])) > MOST_PARTS:
                continue
        count -= 1
        yield f


def truth(graph: Graph, kind: str, f: Formula) -> bool:
    """Whether a formula holds."""
    return 0 in graph.where(f) if kind == "ctl" else holds(graph, f)


@pytest.mark.parametrize("kind", ["ctl", "ltl"])
def test_what_is_left_of_a_formula_says_the_same(kind: str) -> None:
    """With some answers of the graph put in, in any order; often nothing is left."""
    decided = made = 0
    for draw, tables, graph in nets(range(amount(40, 120))):
        for f in formulas(draw, tables, kind, 6):
            wanted = truth(graph, kind, f)
            t = Temporal(tables, kind, f)
            while True:
                assert truth(graph, kind, t.formula) == wanted, (tables, f, t.formula)
                reach = [w for w in t.wanted if isinstance(w, Reach)]
                if not reach or draw.random() < 0.2:
                    break
                asked = draw.choice(reach)
                t.learn(asked, bool(graph.where(asked.condition)))
                if asked in t.wanted:
                    break
            decided += t.value is not None
            made += 1
    assert made > amount(80, 200) and 0.3 < decided / made < 0.95


@pytest.mark.parametrize("kind", ["ctl", "ltl"])
def test_reduced_nets(program: Path, kind: str) -> None:
    """The engine says of the reduced net what is so in the graph of the net as it is."""
    true = made = joined = 0
    for draw, tables, graph in nets(range(1000, 1000 + amount(70, 220))):
        texts, wanted = [], {}
        for f in formulas(draw, tables, kind, 4):
            smaller = smaller_for(tables, kind, f, until=time.monotonic() + SECONDS)
            if smaller is None:
                continue
            n = len(texts)
            wanted[n] = truth(graph, kind, f)
            texts.append((smaller[0], f"{n} {smaller[1]}"))
            joined += not has_next(f)
        for n, (net, text) in enumerate(texts):
            found = list(
                ask(program, [Task(kind, net.text([text]), SECONDS, 256, draw.randrange(1, 9))])
            )
            assert len(found) == 1 and isinstance(found[0], Answer)
            assert (found[0].value != (kind == "ltl")) == wanted[n], (tables, text)
        made += len(wanted)
        true += sum(wanted.values())
    assert made > 60 and joined > 20 and 0.1 < true / made < 0.9


def test_linear_time_is_what_the_tableau_says(program: Path) -> None:
    """The automata and the engine, on formulas that nothing has made simpler."""
    for draw, tables, graph in nets(range(2000, 2000 + amount(25, 50))):
        found = list(formulas(draw, tables, "ltl", 5))
        texts = [f"{i} {question(tables, 'ltl', f, {})}" for i, f in enumerate(found)]
        said = list(
            ask(program, [Task("ltl", tables.text(texts), SECONDS, 256, draw.randrange(1, 9))])
        )
        assert {a.number: not a.value for a in said if isinstance(a, Answer)} == {
            i: holds(graph, f) for i, f in enumerate(found)
        }, tables


@pytest.mark.parametrize(
    ("kind", "only"),
    [
        ("ctl", ""),
        ("ltl", ""),
        ("ctl", "diagrams"),
        ("ltl", "diagrams"),
        ("ctl", "ctl"),
        ("ltl", "ltl"),
    ],
)
def test_methods(program: Path, kind: str, only: str) -> None:
    """Together and alone."""
    for draw, tables, graph in nets(range(3000, 3010)):
        asked = [
            Asked(f"f{i}", formula=f, kind=kind)
            for i, f in enumerate(formulas(draw, tables, kind, 4))
        ]
        found = answers(program, tables, asked, seconds=SECONDS, only=only)
        assert {r.name: r.value for r in found} == {
            a.name: truth(graph, kind, a.formula) for a in asked if a.formula is not None
        }, tables


@pytest.mark.parametrize("only", ["structure", "walk", "explore", "reach"])
def test_methods_that_only_help(program: Path, only: str) -> None:
    """They know what can be reached, and say no more than that decides."""
    known = 0
    for draw, tables, graph in nets(range(4000, 4004)):
        for kind in ("ctl", "ltl"):
            asked = {f"f{i}": f for i, f in enumerate(formulas(draw, tables, kind, 4))}
            lines = [Asked(name, formula=f, kind=kind) for name, f in asked.items()]
            for r in answers(program, tables, lines, seconds=0.5, only=only):
                assert r.value == truth(graph, kind, asked[r.name]), (tables, r)
                known += 1
    assert known > 5


def test_two_negations_are_none() -> None:
    """The answer to what is asked decides."""
    tables = Tables((1, 0), ({0: 1},), ({1: 1},), {"p": (0,), "q": (1,)}, {"t": (0,)})
    p = AtMost(Constant(1), Tokens(("p",)))
    for kind in ("ctl", "ltl"):
        t = Temporal(tables, kind, Op("A", (Op("G", (Op("not", (Op("not", (p,)),)),)),)))
        (asked,) = t.wanted
        t.learn(asked, True)
        assert t.value is False


def test_what_is_wanted_later_is_asked(program: Path) -> None:
    """A question that comes up when another one is answered, after the last round."""
    draw = random.Random(1)
    for tables in (sparse_tables(random.Random(seed)) for seed in range(5000, 5012)):
        graph = Graph.of(tables, LARGEST)
        if graph is None:
            continue
        for f in formulas(draw, tables, "ltl", 2):
            lines = [Asked("f", formula=f, kind="ltl")]
            (result,) = answers(program, tables, lines, seconds=SECONDS)
            assert result.value == truth(graph, "ltl", f), tables
