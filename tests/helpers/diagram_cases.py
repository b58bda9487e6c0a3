"""Random nets and questions for decision diagrams, next to the whole graph; what differs is said."""

from __future__ import annotations

import random
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from helpers.explored import SANITIZERS
from helpers.random_linear import holds, random_linear, temporal_parts
from helpers.random_tables import (
    Graph,
    random_branching,
    random_condition,
    random_tables,
    restless_tables,
)
from pn2code.base.resources import cnative_folder
from pn2code.contest.engine import Answer, Space, Task, ask
from pn2code.contest.formulas import Formula, Op, Tokens
from pn2code.contest.stepwise import question
from pn2code.contest.tables import Tables
from pn2code.emission import c_flags

SECONDS = 600.0
"""Never needed: all come to their end."""
MEBIBYTES = 256
MOST = 400
"""Markings of a graph that is compared."""
FORMULAS = 10
MOST_PAIRS = 3000
"""Of a marking and what holds in it."""


@dataclass(frozen=True, slots=True)
class Case:
    """A net with its graph, and an order of its places."""

    draw: random.Random
    tables: Tables
    graph: Graph
    order: list[int]


def sanitized_engine(folder: Path) -> Path:
    """The engine under the sanitizers for addresses and undefined behaviour."""
    compiler = shutil.which("gcc") or shutil.which("cc")
    assert compiler is not None
    root = cnative_folder() / "src"
    sources = [*(root / "tables").glob("*.c"), *(root / "symbolic").glob("*.c")]
    command = [compiler, c_flags.STANDARD, *SANITIZERS, *map(str, sources), "-lm", "-pthread"]
    path = folder / "tables"
    done = subprocess.run([*command, "-o", str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return path


def case(seed: int) -> Case | None:
    """A random net; None if its graph is too large, or has hardly any markings."""
    draw = random.Random(seed)
    tables = restless_tables(draw) if seed % 3 else random_tables(draw)
    graph = Graph.of(tables, MOST)
    if graph is None or len(graph.markings) < 3:
        return None
    places = range(len(tables.initial))
    return Case(draw, tables, graph, draw.sample(places, len(places)))


def questions(c: Case) -> tuple[list[str], dict[int, bool | int]]:
    """Of all kinds, with what is so: those of branching time first."""
    tables, graph = c.tables, c.graph
    formulas = [random_branching(c.draw, tables, 4) for _ in range(FORMULAS)]
    asked = [tables.ctl(i, f) for i, f in enumerate(formulas)]
    wanted: dict[int, bool | int] = {i: 0 in graph.where(f) for i, f in enumerate(formulas)}
    for n in range(FORMULAS, FORMULAS + 6):
        condition = random_condition(c.draw, tables)
        asked.append(tables.reach(n, condition))
        wanted[n] = bool(graph.where(condition))
    for n in range(FORMULAS + 6, FORMULAS + 8):
        tokens = Tokens(tuple(c.draw.sample(sorted(tables.places), 2)))
        asked.append(tables.bound(n, tokens))
        wanted[n] = max(graph.value(tokens, m) for m in graph.markings)
    asked.append(f"{FORMULAS + 8} reach dead")
    wanted[FORMULAS + 8] = any(not s for s in graph.successors)
    for f in linear_formulas(c, 5):
        n = len(asked)
        asked.append(f"{n} {question(tables, 'ltl', f, {})}")
        wanted[n] = not holds(graph, f)
    return asked, wanted


def linear_formulas(c: Case, count: int) -> list[Formula]:
    """Of linear time; the graph is so small that the tableau of each fits."""
    found: list[Formula] = []
    while len(found) < count:
        f = Op("A", (random_linear(c.draw, c.tables, 3, c.draw.choice(("XFGU", "FG"))),))
        if len(c.graph.markings) << len(temporal_parts(f.parts[0])) < MOST_PAIRS:
            found.append(f)
    return found


def sizes(c: Case) -> Space:
    """Those of the graph."""
    return Space(*c.graph.sizes, None, "DECISION_DIAGRAMS")


def difference(program: Path, c: Case, asked: list[str], wanted: dict[int, bool | int]) -> str:
    """How the diagrams differ from the graph; "" if they agree.

    The seed says which of the two ways for formulas of branching time comes first.
    """
    for seed in (1, 2):
        task = Task("diagrams", c.tables.text(asked, c.order), SECONDS, MEBIBYTES, seed)
        found = {a.number: a.value for a in ask(program, [task]) if isinstance(a, Answer)}
        for n, text in enumerate(asked):
            if found.get(n) != wanted[n]:
                return f"`{text}` is {found.get(n)}, not {wanted[n]} (seed {seed})"
    counted = list(ask(program, [Task("sizes", c.tables.text([], c.order), SECONDS, MEBIBYTES)]))
    return "" if counted == [sizes(c)] else f"{counted} is not {sizes(c)}"
