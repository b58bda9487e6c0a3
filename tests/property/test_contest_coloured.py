"""The contest's examinations of coloured nets, read from PNML, against the nets unfolded and explored in Python."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from helpers.coloured_families import FAMILIES
from helpers.examined import bound, examined, sizes, truths
from helpers.random_coloured import random_coloured
from helpers.random_tables import Graph
from helpers.thorough import amount
from pn2code.contest import portfolio
from pn2code.contest.engine import engine
from pn2code.contest.examinations import asked
from pn2code.contest.portfolio import answers
from pn2code.contest.space import space
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.semantics.evaluation.constants import compute
from pn2code.unfold.plain import plain
from pn2code.unfold.unfold import unfold

SECONDS = 600.0
"""Ends what hangs; nothing takes that long, on however busy a machine."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def read(path: Path) -> Tables:
    """The net as the command reads it, by both ways of unfolding, which agree."""
    d = Diagnostics()
    net = front.load(path, d, compute=compute)
    assert net is not None, [str(x) for x in d]
    found, named = plain(net), unfold(net, d)
    assert found is not None, "every net of the contest is plain"
    assert named is not None
    tables = Tables.of_plain(net, found)
    assert tables == Tables.of(named)
    return tables


@pytest.mark.parametrize("family", [*FAMILIES][:: amount(2, 1)])
def test_a_coloured_net(program: Path, family: str, tmp_path: Path) -> None:
    net = FAMILIES[family]()
    path = tmp_path / "model.pnml"
    path.write_text(net.pnml(), encoding="utf-8")
    tables, own = read(path), net.tables()
    graph = Graph.of(own, 20_000)
    assert graph is not None
    lines, expected = examined(random.Random(family), graph, tables)
    found = {a.name: a.value for a in answers(program, tables, lines, seconds=SECONDS)}
    assert found == expected
    found_space = space(program, tables, seconds=SECONDS, mebibytes=1024)
    assert sizes(found_space) == graph.sizes


@pytest.mark.parametrize("first", [0, 20])
def test_random_nets_are_read_as_they_are_meant(first: int, tmp_path: Path) -> None:
    path, compared = tmp_path / "model.pnml", 0
    for seed in range(first, first + 20):
        net = random_coloured(random.Random(seed))
        graph = Graph.of(net.tables(), 60)
        if graph is None:
            continue
        path.write_text(net.pnml(), encoding="utf-8")
        found = Graph.of(read(path), 60)
        assert found is not None
        assert (len(found.markings), found.arcs) == (len(graph.markings), graph.arcs), seed
        assert truths(found) == truths(graph), seed
        compared += 1
    assert compared > 5


def test_what_structural_methods_have_no_time_for_is_left_to_the_engine(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tables = FAMILIES["resources"]().tables()
    made: list[int] = []
    monkeypatch.setattr(portfolio, "_MAKING", 0.0)
    monkeypatch.setattr(portfolio, "question", lambda *_: made.append(1))
    lines = [asked(tables, "ReachabilityDeadlock", tmp_path)[0], bound(tables, "Has")]
    found = {a.name: a.value for a in answers(program, tables, lines, seconds=SECONDS)}
    assert found == {"ReachabilityDeadlock": False, "Has": 2}
    assert not made


def test_the_text_of_a_net_follows_its_arcs() -> None:
    tables = Tables((1,), ({0: 1},), ({},), {"p": (0,)}, {"t": (0,)})
    assert tables.text(["x"]) == "1 1\n1\n1 0 1 0\n1\nx\n"
    other = replace(tables, post=({0: 2},))
    assert other.text([]) == "1 1\n1\n1 0 1 1 0 2\n0\n"
    assert tables.text([]) == "1 1\n1\n1 0 1 0\n0\n"
