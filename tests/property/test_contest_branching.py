"""Formulas of CTL with parts that cost too much: what is not known keeps nothing else from deciding."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.random_tables import Graph, random_branching, random_tables, sparse_tables
from pn2code.contest.engine import Answer, Task, ask, engine
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics

ENDLESS = Tables((0, 1, 0), ({}, {1: 1}), ({0: 1}, {2: 1}), {}, {})
"""Place 0 fills for ever; the token of place 1 can go to place 2, and stays there."""
FILLS = "sum 1 0 1 1000000000"
"""No search comes to the end of whether that stays so."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def said(
    program: Path, tables: Tables, formulas: list[str], seconds: float, seed: int
) -> dict[int, bool | int]:
    """The answers, by the number of the formula."""
    text = tables.text([f"{i} ctl {f}" for i, f in enumerate(formulas)])
    found = ask(program, [Task("ctl", text, seconds, 256, seed)])
    return {a.number: a.value for a in found if isinstance(a, Answer)}


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        (f"EF or 2 AG {FILLS} not sum 1 2 1 0", True),
        (f"EU or 2 AG {FILLS} sum 0 0 not sum 1 2 1 0", True),
        (f"EX or 2 AG {FILLS} not sum 1 2 1 0", True),
        (f"EG EX or 2 EF not sum 1 2 1 0 AG {FILLS}", False),
    ],
)
def test_a_value_that_is_not_known_does_not_stand_in_the_way(
    program: Path, formula: str, value: bool
) -> None:
    """The last one is not known either: it is not answered wrongly."""
    found = said(program, ENDLESS, [formula], 1.0, 1)
    assert found == ({} if formula.startswith("EG") else {0: value})


def test_random_formulas_on_graphs_that_take_several_rounds(program: Path) -> None:
    """With all orders of successors."""
    compared = true = 0
    for seed in range(240):
        draw = random.Random(seed)
        tables = sparse_tables(draw) if seed % 2 else random_tables(draw)
        graph = Graph.of(tables, 400)
        if graph is None or len(graph.markings) < 30:
            continue
        formulas = [random_branching(draw, tables, 5) for _ in range(25)]
        wanted = {i: 0 in graph.where(f) for i, f in enumerate(formulas)}
        for order in range(1, 6):
            texts = list(map(tables.formula, formulas))
            assert said(program, tables, texts, 60.0, order) == wanted, (tables, order)
        compared += len(wanted)
        true += sum(wanted.values())
    assert compared > 150 and 0.2 < true / compared < 0.8, (compared, true)
