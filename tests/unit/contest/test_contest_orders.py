"""Orders of the places of diagrams: which ones there are, and for how long each is tried."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from helpers.coloured_families import shared_memory
from pn2code.contest import diagrams
from pn2code.contest.diagrams import TRIED, Diagrams, as_written
from pn2code.contest.engine import Task, ask, engine
from pn2code.contest.space import space
from pn2code.contest.tables import Tables
from pn2code.diagnostics import Diagnostics

EXPENSIVE = 0.0
"""A patience that is over before anything is whole."""


def processes(cells: int) -> Tables:
    """Philosophers, each written with its fork, as a tool does that knows of processes."""
    pre: list[dict[int, int]] = []
    post: list[dict[int, int]] = []
    for i in range(cells):
        own, fork, next_ = 3 * i, 3 * i + 2, (3 * i + 5) % (3 * cells)
        pre += [{own: 1, fork: 1, next_: 1}, {own + 1: 1}]
        post += [{own + 1: 1}, {own: 1, fork: 1, next_: 1}]
    places = {f"p{i}": (i,) for i in range(3 * cells)}
    transitions = {f"t{i}": (i,) for i in range(2 * cells)}
    return Tables((1, 0, 1) * cells, tuple(pre), tuple(post), places, transitions)


def test_the_order_of_the_file_is_tried_early_and_upside_down() -> None:
    found = Diagrams(processes(40)).orders[:TRIED]
    assert list(range(120)) in found
    assert list(range(120))[::-1] in found


def test_colours_stay_together() -> None:
    places = {"idle": (0, 1, 2), "busy": (3, 4, 5), "lock": (6,)}
    net = Tables((1, 1, 1, 0, 0, 0, 1), (), (), places, {})
    assert as_written(net) == [0, 3, 6, 1, 4, 2, 5]


def test_colours_together_make_a_small_diagram(tmp_path: Path) -> None:
    """Place by place a diagram has to remember what all processors do."""
    net = shared_memory(7).tables()
    with engine(Diagnostics()) as program:
        assert program is not None
        nodes = []
        for order in (list(range(len(net.initial))), Diagrams(net).orders[2]):
            file = tmp_path / "net"
            file.write_text(net.text(["0 reach dead"], order), encoding="ascii")
            command = [str(program), str(file), "diagrams", "600", "1024", "1"]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            nodes.append(int(done.stdout.split()[1]))
    assert nodes[1] * 5 < nodes[0], nodes


def test_each_order_is_tried_until_diagrams_are_whole() -> None:
    diagrams = Diagrams(processes(8))
    assert [o for o, _ in diagrams.tries(1, range(TRIED), 10.0)] == [1, 0, 2, 3, 1]
    tried = diagrams.tries(0, range(TRIED), 10.0)
    assert list(tried) == [(0, None)], "the others were tried for as long before"
    tried = diagrams.tries(0, range(TRIED), 100.0)
    assert next(tried) == (0, 10.0)
    assert next(tried) == (1, 10.0)
    diagrams.note_whole(1)
    assert list(tried) == [(1, None)]
    assert list(diagrams.tries(2, range(TRIED), 100.0)) == [(1, None)]


def test_without_places_there_is_nothing_to_try() -> None:
    assert not list(Diagrams(Tables((), (), (), {}, {})).tries(0, range(TRIED), 1.0))


def test_diagrams_that_are_not_whole_are_given_up_and_whole_ones_are_told() -> None:
    net = processes(60)
    whole: list[str] = []

    def asked(patience: float | None, name: str) -> int:
        text = net.text(["0 reach dead"], list(range(180)))
        note = partial(whole.append, name)
        task = Task("diagrams", text, 600.0, 512, patience=patience, on_whole=note)
        return len(list(ask(program, [task])))

    with engine(Diagnostics()) as program:
        assert program is not None
        assert asked(EXPENSIVE, "given up") == 0
        assert asked(None, "all of the time") == 1
        assert asked(500.0, "enough") == 1
    assert whole == ["all of the time", "enough"]


def test_each_order_has_a_glance_before_markings_are_counted_for_longer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(diagrams, "_IMPROVING_S", 0.05)
    net = processes(8)
    improved = 0
    for lane in Diagrams(net).sizes(100.0, 64):
        tasks = list(lane)
        texts = [t.text for t in tasks]
        is_improved = len(texts) > 8 and _order(texts[-1]) == _order(texts[-2])[::-1]
        several = len(texts) - (7 if is_improved else 4)
        assert several > 3, "not only the most promising ones"
        assert len(set(texts[:several])) == several
        assert all(t.seconds < 5.0 for t in tasks[:several])
        if not is_improved:
            assert texts[several:] == [*texts[:3], texts[0]]
            assert sum(t.seconds for t in tasks) <= 100.0
            assert tasks[-1].seconds > 25.0
            continue
        improved += 1
        assert texts[several] == texts[0]
        better, turned = (_order(t) for t in texts[-2:])
        assert turned == better[::-1]
        assert sorted(better) == sorted(_order(texts[0]))
        assert all(t.seconds > 20.0 for t in tasks[-2:])
        assert tasks[-6].seconds < 17.0, "a third of the time for each search"
    assert improved


def _order(text: str) -> list[str]:
    """Of the places, in the engine's own words."""
    (line,) = (line for line in text.splitlines() if line.startswith("order "))
    return line.split()[1:]


def test_a_net_without_places_has_one_order_to_count_with() -> None:
    tasks = [list(lane) for lane in Diagrams(Tables((), (), (), {}, {})).sizes(10.0, 64)]
    assert [len(lane) for lane in tasks] == [1, 0]


def test_no_order_is_made_better_when_the_sizes_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Diagrams] = []
    sizes = Diagrams.sizes

    def noted(self: Diagrams, seconds: float, mebibytes: int) -> list[Iterator[Task]]:
        made.append(self)
        return sizes(self, seconds, mebibytes)

    monkeypatch.setattr(Diagrams, "sizes", noted)
    with engine(Diagnostics()) as program:
        assert program is not None
        found = space(program, processes(2), seconds=600.0, mebibytes=256)
    assert found is not None
    assert [d.is_over.is_set() for d in made] == [True]
