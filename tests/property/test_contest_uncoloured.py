"""Coloured nets that are not unfolded: the net without colours and the token game, against the graph in Python."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from queue import SimpleQueue

import pytest

from helpers import pnml_nets as pnml
from helpers.coloured_families import FAMILIES, shared_memory
from helpers.coloured_nets import ColouredNet, all_, less, times
from helpers.examined import examined
from helpers.random_coloured import random_coloured
from helpers.random_linear import holds
from helpers.random_tables import Graph, random_condition
from helpers.thorough import amount
from pn2code.base.deadline import Deadline
from pn2code.contest.asking import Asking, is_large
from pn2code.contest.engine import Answer, Said, engine
from pn2code.contest.formulas import AtMost, Constant, Fireable, Op, Tokens, Truth
from pn2code.contest.playing import Play, Sought, follow
from pn2code.contest.portfolio import answers
from pn2code.contest.tables import Tables
from pn2code.contest.uncoloured import uncoloured
from pn2code.contest.weaker import weaker
from pn2code.diagnostics import Diagnostics
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.constants import compute
from pn2code.semantics.game.token_game import Game
from pn2code.unfold.plain import TooLargeError

LONG_S = 600.0
"""Nothing takes that long: what is asked is known sooner."""
SHORT_S = 0.6
"""So long all is asked, of which some is never known."""


@pytest.fixture(scope="module")
def program() -> Iterator[Path]:
    """The engine."""
    with engine(Diagnostics()) as found:
        assert found is not None
        yield found


def loaded(net: ColouredNet, folder: Path) -> FlatNet:
    """The net as the front end reads it."""
    path = folder / "model.pnml"
    path.write_text(net.pnml(), encoding="utf-8")
    found = front.load(path, Diagnostics(), compute=compute)
    assert found is not None
    return found


def test_the_net_without_colours(tmp_path: Path) -> None:
    net = loaded(shared_memory(), tmp_path)
    tables = uncoloured(net, Game(net))
    assert tables is not None
    number = {name: p for name, (p,) in tables.places.items()}
    assert [tables.initial[number[p]] for p in ("Active", "Queue", "Memory", "Bus")] == [3, 0, 3, 1]
    (other,) = tables.transitions["other"]
    assert tables.pre[other] == {number[p]: 1 for p in ("Queue", "Memory", "Bus")}
    assert tables.post[other] == {number["Other"]: 1}
    assert tables.at_first == frozenset({"ask"})


def test_arcs_that_move_more_or_fewer_tokens_have_no_net_without_colours(tmp_path: Path) -> None:
    made = shared_memory()
    sorts, variables = made.sorts, made.variables
    for term, expected in ((less(all_("P"), "x"), 2), (less(times(1, "x"), "y"), None)):
        transitions = [("t", None, {"Active": "x", "Memory": "y"}, {"Queue": term})]
        net = loaded(ColouredNet(sorts, variables, made.places, transitions), tmp_path)
        tables = uncoloured(net, Game(net))
        assert (tables is None) == (expected is None)
        if tables is not None:
            assert tables.post == ({tables.places["Queue"][0]: expected},)


def test_that_nothing_is_enabled_is_not_asked() -> None:
    few, able = AtMost(Tokens(("p",)), Constant(1)), Fireable(("t",))
    assert weaker(Op("and", (few, able))) == Op("and", (few, able))
    assert weaker(Op("and", (few, Op("not", (able,))))) == few
    assert weaker(Op("not", (Op("and", (few, able)),))) == Truth(True)
    assert weaker(Op("not", (Op("or", (few, able)),))) == Op("not", (few,))


@pytest.mark.parametrize("family", ["shared_memory", "quasi_certificate", "vending", "resources"])
def test_no_answer_is_wrong(program: Path, family: str, tmp_path: Path) -> None:
    made = FAMILIES[family]()
    graph = Graph.of(made.tables(), 20_000)
    assert graph is not None
    net = loaded(made, tmp_path)
    game = Game(net)
    tables = uncoloured(net, game)
    assert tables is not None
    lines, expected = examined(random.Random(family), graph, tables)
    found = answers(program, tables, lines, seconds=SHORT_S, game=game)
    for answer in found:
        assert answer.value == expected[answer.name], answer


def test_runs_decide_formulas_of_one_operator(tmp_path: Path) -> None:
    """With dead initial markings among the nets: nothing comes after these, in linear time they themselves."""
    decided, dead = 0, 0
    for seed in range(amount(12, 24)):
        draw = random.Random(seed)
        made = random_coloured(draw)
        graph = Graph.of(made.tables(), 60)
        if graph is None or not graph.markings[0]:
            continue
        dead += not graph.successors[0]
        net = loaded(made, tmp_path)
        game = Game(net)
        tables = uncoloured(net, game)
        assert tables is not None
        for number in range(16):
            of, operator = draw.choice("EA"), draw.choice("XFGU")
            parts = [random_condition(draw, tables, 1) for _ in range(1 + (operator == "U"))]
            f = Op(of, (Op(operator, tuple(parts)),))
            is_linear = of == "A" and number % 2 == 1
            said: Said = SimpleQueue()
            sought = Sought(0, lambda sight: False, followed=follow(tables, f), is_linear=is_linear)
            play = Play(game, partial(list, [sought]), said, time.monotonic() + LONG_S)
            for is_even in (False, True):
                play.play(20, is_even=is_even)
            expected = not holds(graph, f) if is_linear else 0 in graph.where(f)
            while not said.empty():
                answer = said.get()
                assert isinstance(answer, Answer) and answer.value == expected, (seed, f)
                decided += 1
    assert decided > 50 and dead


def test_what_cannot_be_unfolded_is_asked_without_colours(program: Path, tmp_path: Path) -> None:
    net = loaded(shared_memory(), tmp_path)

    def unfolded(net: FlatNet) -> Tables | None:
        raise TooLargeError("more than 3 places")

    said: list[str] = []

    def lines(examination: str) -> list[str]:
        asking = Asking(
            program, examination, tmp_path, Deadline.after(LONG_S), mebibytes=1024, only="", say=said.append
        )  # fmt: skip
        return [line.partition(" TECHNIQUES")[0] for line in asking.of_net(net, unfolded)]

    assert lines("OneSafe") == ["FORMULA OneSafe FALSE"]
    assert lines("QuasiLiveness") == ["FORMULA QuasiLiveness TRUE"]
    assert lines("StateSpace") == ["CANNOT_COMPUTE"]
    assert said == ["not unfolded: more than 3 places"] * 3


def test_a_colour_set_without_bounds_is_no_obstacle(program: Path, tmp_path: Path) -> None:
    three = '<numberconstant value="3"><integer/></numberconstant>'
    text = pnml.net(
        pnml.place("P", "N", pnml.number(1, three)),
        pnml.place("Q", "N"),
        pnml.transition("t"),
        pnml.arc("P", "t", pnml.number(1, pnml.var("n"))),
        pnml.arc("t", "Q", pnml.number(1, pnml.var("n"))),
        declarations=pnml.named("N", "<integer/>") + pnml.variable("n", "N"),
    )
    net = pnml.flat(text, tmp_path)
    asking = Asking(
        program, "QuasiLiveness", tmp_path, Deadline.after(LONG_S), mebibytes=1024, only="", say=print
    )  # fmt: skip
    (line,) = asking.of_net(net, lambda net: None)
    assert line.startswith("FORMULA QuasiLiveness TRUE")


def test_small_nets_are_unfolded_at_once(tmp_path: Path) -> None:
    net = loaded(shared_memory(), tmp_path)
    assert not is_large(net, Game(net))
