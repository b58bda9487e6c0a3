"""The structural methods and the portfolio with them, against the whole graph of random nets."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.random_tables import Graph, random_condition, random_tables
from helpers.thorough import amount
from pn2code.contest.engine import engine
from pn2code.contest.examinations import Asked, Part
from pn2code.contest.formulas import Tokens
from pn2code.contest.portfolio import answers
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


def nets(seeds: range) -> Iterator[tuple[Tables, list[Asked], dict[str, bool | int]]]:
    """Random nets with questions and their answers."""
    for seed in seeds:
        draw = random.Random(seed)
        tables = random_tables(draw)
        graph = Graph.of(tables)
        if graph is not None and len(graph.markings) > 2:
            yield tables, *questions(draw, tables, graph)


def questions(
    draw: random.Random, tables: Tables, graph: Graph
) -> tuple[list[Asked], dict[str, bool | int]]:
    asked = [Asked("dead", (Part("reach", "reach dead"),))]
    wanted: dict[str, bool | int] = {"dead": any(not s for s in graph.successors)}
    for i in range(4):
        f = random_condition(draw, tables)
        asked.append(Asked(f"f{i}", (Part("reach", f"reach {tables.formula(f)}"),)))
        wanted[f"f{i}"] = bool(graph.where(f))
    for i in range(2):
        tokens = Tokens(tuple(draw.sample(sorted(tables.places), 2)))
        asked.append(Asked(f"b{i}", (Part("bound", tables.bound(0, tokens).split(" ", 1)[1]),)))
        wanted[f"b{i}"] = max(graph.value(tokens, m) for m in graph.markings)
    return asked, wanted


def test_the_structure_alone(program: Path) -> None:
    """It does not know everything; what it says is so."""
    known = all_ = 0
    for tables, asked, wanted in nets(range(amount(60, 150))):
        for result in answers(program, tables, asked, seconds=SECONDS, only="structure"):
            assert wanted[result.name] == result.value, (tables, result)
            known += 1
        all_ += len(wanted)
    assert known > 0.5 * all_


def test_all_methods_together(program: Path) -> None:
    for tables, asked, wanted in nets(range(300, 300 + amount(20, 40))):
        found = {r.name: r.value for r in answers(program, tables, asked, seconds=SECONDS)}
        assert found == wanted, tables


def test_a_hint_decides(program: Path) -> None:
    """A question of another kind that nobody answers is decided by one of reachability."""
    tables = Tables((1,), ({0: 1},), ({},), {}, {})
    open_ = (Part("other", "none"),)
    asked = [
        Asked("a", open_, decides=False, value=False, hints=((Part("reach", "reach dead"), True),)),
        Asked(
            "b", open_, decides=False, value=False, hints=((Part("reach", "reach dead"), False),)
        ),
    ]
    found = {
        r.name: r.value for r in answers(program, tables, asked, seconds=2.0, only="structure")
    }
    assert found == {"a": False}
