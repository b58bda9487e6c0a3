"""Questions about the same net share it, its equation, and what the engine is told of it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from queue import SimpleQueue

import pytest

from pn2code.contest import structural
from pn2code.contest.conditions import AtMost, Condition
from pn2code.contest.engine import Said
from pn2code.contest.formulas import Fireable, Op
from pn2code.contest.reduction.net import Goal, Net
from pn2code.contest.reduction.reduce import Reduced
from pn2code.contest.structural import Question, Structural
from pn2code.contest.tables import Tables

PLACES = 100


def ring() -> Tables:
    moves = range(PLACES)
    return Tables(
        (1, *[0] * (PLACES - 1)),
        tuple({i: 1} for i in moves),
        tuple({(i + 1) % PLACES: 1} for i in moves),
        {},
        {},
    )


def asked(number: int) -> Question:
    return Question(number, "bound", AtMost(((number, 1),), 0), 0)


def made(questions: list[Question]) -> Structural:
    said: Said = SimpleQueue()
    return Structural(ring(), questions, said, time.monotonic() + 600.0)


def without_places(count: int) -> Reduced:
    """As if reductions had removed some places, with what they take part in."""
    net = Net(ring(), {0}, Goal.REACHABILITY)
    for p in range(PLACES - count, PLACES):
        for t in [*net.takers[p], *net.putters[p]]:
            net.remove_transition(t)
        net.remove_place(p)
    return Reduced(net)


def test_a_net_has_one_equation(monkeypatch: pytest.MonkeyPatch) -> None:
    begun = []
    real = structural.StateEquation
    monkeypatch.setattr(structural, "StateEquation", lambda *a: begun.append(a) or real(*a))
    questions = [asked(n) for n in range(5)]
    net = ring()
    for q in questions:
        q.smaller = structural.Smaller(net, q.condition)
    made(questions)._pass(10.0)
    assert len(begun) == 1
    assert len({id(q.smaller.equation) for q in questions if q.smaller}) == 1


@pytest.mark.parametrize(("gone", "is_shared"), [(0, True), (2, True), (20, False)])
def test_a_net_that_is_hardly_smaller_for_one_question_is_not_its_own(
    monkeypatch: pytest.MonkeyPatch, gone: int, is_shared: bool
) -> None:
    def reduced_for(tables: Tables, asked: Sequence[Condition], *, until: float) -> Reduced:
        assert asked and until and tables.pre
        return without_places(0 if len(asked) > 1 else gone)

    monkeypatch.setattr(structural, "reduced_for", reduced_for)
    questions = [asked(n) for n in range(3)]
    made(questions)._reduce_all()
    nets = {id(q.smaller.tables) for q in questions if q.smaller}
    assert len(nets) == (1 if is_shared else 3)


def test_many_bindings_are_ranges_for_the_engine() -> None:
    names = {"few": tuple(range(7)), "many": tuple(range(7, 2000)), "odd": tuple(range(1, 2000, 2))}
    net = Tables((1,), ({0: 1},) * 2000, ({0: 1},) * 2000, {}, names)
    few, many, odd, all_ = (
        Fireable((x,)) if x else Fireable(("many", "few")) for x in ("few", "many", "odd", "")
    )
    asked = net.ctl(0, Op("not", (Op("and", (many, few, odd, all_, many)),)))
    words = net.text([asked]).splitlines()[-1]
    odd_ones = f"enabled 1000 {' '.join(map(str, names['odd']))}"
    wanted = "0 ctl not and 5 among 1993 1 7 1993 enabled 7 0 1 2 3 4 5 6 "
    assert words == f"{wanted}{odd_ones} among 2000 1 0 2000 among 1993 1 7 1993"


def test_a_list_that_begins_as_another_one_does_not_become_its_ranges() -> None:
    names = {"a": tuple(range(1000)), "b": (*range(999), 9990)}
    net = Tables((1,), ({0: 1},) * 9991, ({0: 1},) * 9991, {}, names)
    asked = [net.ctl(0, Fireable(("a",))), net.ctl(1, Fireable(("b",)))]
    assert net.text(asked).splitlines()[-2:] == [
        "0 ctl among 1000 1 0 1000",
        "1 ctl among 1000 2 0 999 9990 1",
    ]
