"""Which transitions depend on which: sets that are closed with the table keep what they promise, rule by rule."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from helpers.concurrent_nets import concurrent
from helpers.netbuilder import flat
from helpers.stubborn import BrokenError, check
from helpers.thorough import amount
from helpers.unions import numbers_of, only
from pn2code.net.flat import FlatNet
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game
from pn2code.verify.exploring import dependency as module
from pn2code.verify.exploring.dependency import dependency, recurring
from pn2code.verify.exploring.elements import NotPossibleError

NETS = amount(16, 1000)
MARKINGS = 60


def sets(net: FlatNet) -> int:
    """Checks a net; gives how many sets were less than all that is enabled."""
    game = Game(net, {}, files=Files(None))
    space = state_space(game, max_nodes=MARKINGS)
    return check(net, dependency(net), space.nodes, game)


def test_sets_of_random_nets_keep_what_they_promise() -> None:
    net = flat(concurrent(0, NETS))
    smaller = sum(sets(only(net, [number])) for number in numbers_of(net))
    assert smaller > 20 * NETS


RULES = """
    net Rules
      colset UNIT = unit;
      colset INT = int;
      var x, y: INT;
      val seen = ref 0;
      place A : INT = 1`1
      place B : INT
      place C : INT = 1`1
      place D : INT
      place Free = 1
      trans Left
        in A : x
        out B : x
      trans Right
        in C : x
        out D : x
"""


def rivals(text: str, name: str) -> set[str]:
    """The transitions that belong to a set with this one when it is enabled."""
    net = flat(text)
    index = {t.name.rpartition(".")[2]: t.index for t in net.transitions}
    found = dependency(net).members[index[name]].rivals
    return {own for own, i in index.items() if i in found}


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ("", "", set()),
        ("in Free : ()", "in Free : ()", {"Right"}),
        ("in Free : ()", "both Free : ()", {"Right"}),
        ("both Free : ()", "in Free : ()", {"Right"}),
        ("both Free : ()", "both Free : ()", set()),
        ("in Free : ()", "out Free : ()", set()),  # more of the same is nothing new
        ("out Free : ()", "in Free : ()", set()),
        ("both D : y", "", {"Right"}),  # another binding
        ("inhibit D", "", {"Right"}),
        ("inhibit C", "", set()),  # they are never enabled together
        ("reset C", "", {"Right"}),
        ("reset D", "", {"Right"}),
        ("in Free : ()", "reset Free", {"Right"}),
    ],
)
def test_rivals_of_an_enabled_transition(left: str, right: str, expected: set[str]) -> None:
    lines = RULES.splitlines()
    for name, more in (("Left", left), ("Right", right)):
        at = next(i for i, line in enumerate(lines) if f"trans {name}" in line)
        lines[at + 1 : at + 1] = [f"        {more}"] if more else []
    assert rivals("\n".join(lines), "Left") == expected


SIGNS = """
    net Signs
      colset UNIT = unit;
      colset REAL = real;
      colset U = union of_real : REAL + other;
      colset L = list U;
      colset PAIR = product REAL * UNIT;
      place A = 1
      place C = 1
      place P : COLSET
      trans Left
        in A : ()
        out P : ZERO
      trans Right
        in C : ()
        out P : OTHER
"""
"""Of equal zeros a place keeps the sign of the first."""


@pytest.mark.parametrize(
    ("colset", "zero"),
    [("REAL", "0.0"), ("L", "[of_real 0.0]"), ("PAIR", "(0.0, ())")],
)
def test_who_puts_a_zero_first_matters(colset: str, zero: str) -> None:
    text = SIGNS.replace("COLSET", colset).replace("ZERO", zero)
    text = text.replace("OTHER", zero.replace("0.0", "(~0.0)"))
    assert rivals(text, "Left") == {"Right"} and rivals(text, "Right") == {"Left"}


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ("seen := 1", "seen := 2", {"Right"}),
        ("seen := 1", "ignore (!seen)", {"Right"}),
        ("ignore (!seen)", "seen := 1", {"Right"}),
        ("ignore (!seen)", "ignore (!seen)", set()),
        ("ignore 1", "seen := 1", set()),
    ],
)
def test_code_segments_meet_at_references_only(left: str, right: str, expected: set[str]) -> None:
    text = RULES.replace("trans Left", f"trans Left code action {left}")
    text = text.replace("trans Right", f"trans Right code action {right}")
    assert rivals(text, "Left") == expected


def test_reasons_why_a_transition_is_disabled() -> None:
    net = flat(
        RULES + "      trans Both\n        in B : x\n        in D : 2`3\n        inhibit A\n"
    )
    index = {t.name.rpartition(".")[2]: t.index for t in net.transitions}
    places = {p.short: p.index for p in net.places}
    member = dependency(net).members[index["Both"]]
    assert {(r.place, r.least, r.helpers) for r in member.reasons} == {
        (places["B"], 1, (index["Left"],)),
        (places["D"], 2, (index["Right"],)),
        (places["A"], 0, (index["Left"],)),
    }
    assert member.helpers == (index["Left"], index["Right"])


def test_a_search_that_may_raise_has_no_reason_to_be_without() -> None:
    text = RULES + "      trans Both guard [6 div x > 1]\n        in B : x\n        in D : y\n"
    member = dependency(flat(text)).members[-1]
    assert member.reasons == ()
    assert len(member.helpers) == 2


def test_less_urgent_transitions_that_enable_more_urgent_ones_spoil() -> None:
    text = RULES.replace("trans Left", "trans Left priority 2000")
    text += "      trans Soon priority 100\n        in B : x\n"
    net = flat(text)
    spoiling = {t.short for t in net.transitions if dependency(net).members[t.index].is_spoiling}
    assert spoiling == {"Left"}


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda s: s.replace("out B : x", "out B : discrete (1, 3)"), "`Top.Left` draws"),
        (lambda s: s.replace("INT = int;", "INT = int timed;"), "timed"),
        (
            lambda s: s.replace("out B : x", "out B : IntInf.toInt (step ())"),
            "`Top.Left` asks for the number of steps",
        ),
    ],
)
def test_what_stands_in_the_way_is_named(change: Callable[[str], str], why: str) -> None:
    with pytest.raises(NotPossibleError, match=why):
        dependency(flat(change(RULES)))


def test_each_rule_is_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without tests of what others take, the sets of random nets promise too much."""
    whole: Any = module._Relation._conflicts

    def less(mine: Any, other: Any, *, is_single: bool) -> bool:
        is_asked = other.takes and mine.takes
        return not is_asked and whole(mine, other, is_single=is_single)

    monkeypatch.setattr(module._Relation, "_conflicts", staticmethod(less))
    with pytest.raises(BrokenError):
        test_sets_of_random_nets_keep_what_they_promise()


@pytest.mark.parametrize(
    ("consumed", "expected"),
    [
        ([[{1}], [{0}]], 1),  # a cycle of two
        ([[{0}]], 1),  # it takes what it puts
        ([[set()], [{0}]], 0),  # nothing refills the first
        ([[]], 1),  # it takes nothing
        ([[{1}, set()], [{0}]], 0),  # a cycle that uses something up
        ([[{1, 3}], [{0}], [{3}], [{2}]], 2),
    ],
)
def test_one_of_each_cycle_is_recurring(consumed: list[list[set[int]]], expected: int) -> None:
    found = recurring([[frozenset(m) for m in own] for own in consumed], len(consumed))
    assert len(found) == expected
