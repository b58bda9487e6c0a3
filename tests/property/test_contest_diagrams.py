"""Decision diagrams against the whole graph, worked out in Python: random nets, any order of the levels, sanitizers."""

from __future__ import annotations

from itertools import count, islice
from pathlib import Path

import pytest

from helpers.diagram_cases import (
    FORMULAS,
    MEBIBYTES,
    SECONDS,
    case,
    difference,
    questions,
    sanitized_engine,
)
from helpers.table_families import philosophers
from helpers.thorough import amount
from pn2code.contest.engine import Answer, Space, Task, ask
from pn2code.contest.tables import Tables

pytestmark = pytest.mark.cc

NETS = amount(12, 60)
"""`./dev fuzz --diagrams N` takes more."""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The engine under the sanitizers."""
    return sanitized_engine(tmp_path_factory.mktemp("engine"))


def asked(program: Path, method: str, text: str) -> list[Answer | Space]:
    """What the engine says of a net."""
    return list(ask(program, [Task(method, text, SECONDS, MEBIBYTES)]))


def test_all_is_as_in_the_graph(program: Path) -> None:
    true, dead, most = 0, 0, 0
    for c in islice(filter(None, map(case, count())), NETS):
        texts, wanted = questions(c)
        assert not difference(program, c, texts, wanted), c.tables
        true += sum(wanted[i] for i in range(FORMULAS))
        dead += wanted[FORMULAS + 8]
        most = max(most, *map(max, c.graph.markings))
    assert 0.2 < true / (FORMULAS * NETS) < 0.8 and 0 < dead < NETS, "the questions decide"
    assert most > 8, "some places hold many tokens"


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


@pytest.mark.parametrize(("places", "fits"), [(8, True), (16, False)])
def test_memory_is_limited(program: Path, places: int, fits: bool) -> None:
    """What does not fit ends, and nothing is said."""
    tables = Tables(
        tuple(range(1, places + 1)),
        tuple({p: 1} for p in range(places)),
        tuple({(p * 7 + 3) % places: 1} for p in range(places)),
        {},
        {},
    )
    assert bool(list(ask(program, [Task("sizes", tables.text([]), SECONDS, 2)]))) == fits


def test_sums_that_no_number_holds_are_not_known(program: Path) -> None:
    """The other questions are answered all the same."""
    tables = Tables((1 << 30,) * 40, ({0: 1 << 30},), ({},), {}, {"t": (0,)})
    large = f"sum 40 {' '.join(f'{p} 1000000000' for p in range(40))}"
    text = tables.text([f"0 bound {large} 0", f"1 reach {large} 5", "2 bound sum 1 3 1 0"])
    found = asked(program, "diagrams", text)
    assert found == [Answer(2, 1 << 30, True, "DECISION_DIAGRAMS")]


def test_nets_that_are_hardly_there(program: Path) -> None:
    nothing = asked(program, "sizes", Tables((), (), (), {}, {}).text([]))
    assert nothing == [Space(1, 0, 0, 0, None, "DECISION_DIAGRAMS")]
    resting = asked(program, "sizes", Tables((0, 3), ({},), ({},), {}, {}).text([]))
    assert resting == [Space(1, 1, 3, 3, None, "DECISION_DIAGRAMS")]


def test_what_many_transitions_do_is_one_step(program: Path) -> None:
    """Philosophers, of whom all may have taken one fork: with one transition after the other it would take hours."""
    tables = philosophers(1500)
    text = tables.text(["0 reach dead", "1 ctl AG EX true", "2 ctl EX EX not dead"])
    found = asked(program, "diagrams", text)
    assert {a.number: a.value for a in found if isinstance(a, Answer)} == {
        0: True,
        1: False,
        2: True,
    }


def test_an_order_without_all_places_is_refused(program: Path) -> None:
    tables = Tables((1, 0), ({0: 1},), ({1: 1},), {}, {})
    for order in ([0, 0], [0], [0, 2]):
        with pytest.raises(RuntimeError, match="the engine for tables"):
            asked(program, "sizes", tables.text([], order))
