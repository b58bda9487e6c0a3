"""Decision diagrams against the whole graph, worked out in Python: random nets, any order of the levels, sanitizers."""

from __future__ import annotations

import random
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers.explored import SANITIZERS
from helpers.random_tables import (
    Graph,
    random_branching,
    random_condition,
    random_tables,
    restless_tables,
)
from pn2code.base.resources import cnative_folder
from pn2code.contest.engine import Answer, Space, Task, ask
from pn2code.contest.formulas import Tokens
from pn2code.contest.tables import Tables

pytestmark = pytest.mark.cc

NETS = 60
SECONDS = 60.0
"""Never needed: all come to their end."""
MEBIBYTES = 256


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The engine under the sanitizers for addresses and undefined behaviour."""
    path = tmp_path_factory.mktemp("engine") / "tables"
    compiler = shutil.which("gcc") or shutil.which("cc")
    assert compiler is not None
    root = cnative_folder() / "src"
    sources = [*(root / "tables").glob("*.c"), *(root / "symbolic").glob("*.c")]
    command = [compiler, "-std=c11", *SANITIZERS, *map(str, sources), "-lm", "-pthread"]
    done = subprocess.run([*command, "-o", str(path)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return path


def nets() -> Iterator[tuple[random.Random, Tables, Graph]]:
    """Random nets with small graphs; some have tokens that were not there at the beginning."""
    found = 0
    for seed in range(20 * NETS):
        draw = random.Random(seed)
        tables = restless_tables(draw) if seed % 3 else random_tables(draw)
        graph = Graph.of(tables, 400)
        if graph is not None and len(graph.markings) > 2:
            found += 1
            yield draw, tables, graph
        if found == NETS:
            return


def any_order(draw: random.Random, tables: Tables) -> list[int]:
    """The places, shuffled."""
    return draw.sample(range(len(tables.initial)), len(tables.initial))


def asked(program: Path, method: str, text: str) -> list[Answer | Space]:
    """What the engine says; it must come to its end, without a word from the sanitizers."""
    found = list(ask(program, [Task(method, text, SECONDS, MEBIBYTES)]))
    assert found, "it said nothing"
    return found


def test_answers_are_those_of_the_graph(program: Path) -> None:
    true, dead, most = 0, 0, 0
    for draw, tables, graph in nets():
        conditions = [random_condition(draw, tables) for _ in range(6)]
        sums = [Tokens(tuple(draw.sample(sorted(tables.places), 2))) for _ in range(2)]
        formulas = [random_branching(draw, tables, 4) for _ in range(10)]
        questions = [tables.reach(i, f) for i, f in enumerate(conditions)]
        questions += [tables.bound(6 + i, s) for i, s in enumerate(sums)]
        questions.append("8 reach dead")
        questions += [tables.ctl(9 + i, f) for i, f in enumerate(formulas)]
        wanted: dict[int, bool | int] = {i: bool(graph.where(f)) for i, f in enumerate(conditions)}
        wanted |= {
            6 + i: max(graph.value(s, m) for m in graph.markings) for i, s in enumerate(sums)
        }
        wanted[8] = any(not s for s in graph.successors)
        wanted |= {9 + i: 0 in graph.where(f) for i, f in enumerate(formulas)}
        text = tables.text(questions, any_order(draw, tables))
        found = asked(program, "diagrams", text)
        assert {a.number: a.value for a in found if isinstance(a, Answer)} == wanted, tables
        true += sum(1 for i in range(10) if wanted[9 + i])
        dead += wanted[8]
        most = max(most, *map(max, graph.markings))
    assert 0.2 < true / (10 * NETS) < 0.8 and 0 < dead < NETS, "the questions decide something"
    assert most > 8, "some places hold many tokens"


def test_sizes_are_those_of_the_graph(program: Path) -> None:
    for draw, tables, graph in nets():
        found = asked(program, "sizes", tables.text([], any_order(draw, tables)))
        in_place, in_marking = max(map(max, graph.markings)), max(map(sum, graph.markings))
        sizes = (len(graph.markings), graph.arcs, in_place, in_marking)
        assert found == [Space(*sizes, None, "DECISION_DIAGRAMS")], tables


def test_numbers_of_any_length(program: Path) -> None:
    """Places that do not know of each other, each with two markings: a number with 302 digits, and as many arcs."""
    cells = 1000
    tables = Tables(
        (1, 0) * cells,
        tuple({2 * i: 1} for i in range(cells)),
        tuple({2 * i + 1: 1} for i in range(cells)),
        {},
        {},
    )
    found = asked(program, "sizes", tables.text([]))
    assert found == [Space(2**cells, cells * 2 ** (cells - 1), 1, cells, None, "DECISION_DIAGRAMS")]


@pytest.mark.parametrize("weight", [1, 1 << 29], ids=["time", "tokens"])
def test_a_net_without_an_end_is_not_known(program: Path, weight: int) -> None:
    """A place that fills for ever: time or tokens come to their end, and nothing is said."""
    tables = Tables((1, 0), ({0: 1},), ({0: 1, 1: weight},), {}, {"t": (0,)})
    for method in ("sizes", "diagrams"):
        text = tables.text(["0 bound sum 1 1 1 0", "1 reach not sum 1 1 1 1"])
        assert not list(ask(program, [Task(method, text, 0.3, MEBIBYTES)]))


def test_no_places_and_no_transitions(program: Path) -> None:
    """Sizes of nets that are hardly there."""
    assert asked(program, "sizes", Tables((), (), (), {}, {}).text([]))[0] == Space(
        1, 0, 0, 0, None, "DECISION_DIAGRAMS"
    )
    assert asked(program, "sizes", Tables((0, 3), ({},), ({},), {}, {}).text([]))[0] == Space(
        1, 1, 3, 3, None, "DECISION_DIAGRAMS"
    )


def test_an_order_without_all_places_is_refused(program: Path) -> None:
    tables = Tables((1, 0), ({0: 1},), ({1: 1},), {}, {})
    for order in ([0, 0], [0], [0, 2]):
        with pytest.raises(RuntimeError, match="the engine for tables"):
            list(ask(program, [Task("sizes", tables.text([], order), SECONDS, MEBIBYTES)]))
