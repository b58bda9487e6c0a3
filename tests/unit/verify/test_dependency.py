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
from pn2code.structure.relations import Relations
from pn2code.verify.exploring import dependency as module
from pn2code.verify.exploring import updates
from pn2code.verify.exploring.dependency import dependency, recurring
from pn2code.verify.exploring.elements import NotPossibleError
from pn2code.verify.exploring.updates import How

NETS = amount(6, 1000)
MARKINGS = 60
FEWER = amount(25, 60)
"""Markings of nets of which there are many."""


def sets(net: FlatNet, markings: int = MARKINGS) -> int:
    """Checks a net; gives how many sets were less than all that is enabled."""
    game = Game(net, {}, files=Files(None))
    space = state_space(game, max_nodes=markings)
    return check(net, dependency(net), space.nodes, game)


def test_sets_of_random_nets_keep_what_they_promise() -> None:
    net = flat(concurrent(0, NETS))
    smaller = sum(sets(only(net, [number]), FEWER) for number in numbers_of(net))
    assert smaller > FEWER / 3 * NETS


def test_sets_where_counters_are_changed() -> None:
    net = flat(concurrent(0, NETS // 2, counters=3))
    smaller = sum(sets(only(net, [number]), FEWER) for number in numbers_of(net))
    assert smaller > FEWER / 4 * NETS


RULES = """
    net Rules
      colset UNIT = unit;
      colset INT = int;
      var x, y: INT;
      val seen = ref 0;
      place A : INT = 1`1
      place B : INT
      place C : INT = 2`1
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
    ("colset", "zero"),
    [("REAL", "0.0"), ("U", "of_real 0.0"), ("L", "[of_real 0.0]")],
)
def test_who_puts_a_token_back_may_change_its_sign(colset: str, zero: str) -> None:
    text = f"""
        net Signs
          colset REAL = real;
          colset U = union of_real : REAL + other;
          colset L = list U;
          var x, y: {colset};
          place A : {colset} = 1`{zero.replace("0.0", "(~0.0)")}
          place P : {colset} = 1`{zero}
          place Q : {colset}
          trans Left
            in A : x
            in P : x
            out P : x
          trans Right
            in P : y
            out P : y
            out Q : y
    """
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


COUNTERS = """
    net Counters
      standard
      colset SMALL = int with 0..9;
      colset PAIR = product INT * BOOL;
      colset HELD = product REAL * INT;
      fun even n = n mod 2 = 0;
      colset EVEN = subset INT by even;
      var n, m, x: INT;
      val four = 4 : IntInf.int;
      var w: INTINF;
      var e: EVEN;
      var s: SMALL;
      var b: BOOL;
      var r: REAL;
      val seen = ref 0;
      fun twice n = n + n;
      place A : INT = 3`1
      place B : INT = 3`1
      place N : INT = 1`5
      place M : INT = 1`5
      place Two : INT = 2`5
      place Pair : PAIR = 1`(5, true)
      place Small : SMALL = 1`5
      place Wide : INTINF = 1`5
      place Even : EVEN = 1`4
      place Held : HELD = 1`(1.0, 5)
      place D : INT
      trans Left
        in A : x
      trans Right
        in B : x
      trans Over
        in M : n
"""


@pytest.mark.parametrize(
    ("left", "right", "expected"),
    [
        ("in N : n; out N : n + 1", "in N : n; out N : n + 2", set()),
        ("in N : n; out N : n - 1", "in N : n; out N : 1`(n - 2)", set()),
        ("in N : n; out N : n + 1", "in N : n; out N : n - 2", {"Right"}),  # no overflow after it
        ("in N : n; out N : n + x", "in N : m; out N : 1`(x + m)", {"Right"}),
        ("in Wide : w; out Wide : w + four", "in Wide : w; out Wide : 1`(w - four)", set()),
        ("in Even : e; out Even : e + 2", "in Even : e; out Even : e + 2", {"Right"}),
        ("in Even : e; out Even : Int.max (e, 3)", "in Even : e; out Even : 4", {"Right"}),
        ("in N : n; out N : Int.max (n, x)", "in N : n; out N : Int.max (3, n)", set()),
        ("in N : n; out N : Int.max (n, x)", "in N : n; out N : Int.min (3, n)", {"Right"}),
        ("in N : n; out N : n + 1", "in N : n; out N : Int.max (n, 3)", {"Right"}),
        ("in N : n; out N : 7", "in N : n; out N : 7", set()),
        ("in N : n; out N : 7", "in N : n; out N : 8", {"Right"}),
        ("in N : n; out N : 7", "in N : n; out N : n + 1", {"Right"}),
        ("in N : n; out N : x", "in N : n; out N : x", {"Right"}),
        ("in N : n; out N : 1 - n", "in N : n; out N : 1 - n", {"Right"}),
        ("in N : n; out N : 2 * n", "in N : n; out N : 2 * n", {"Right"}),
        ("in N : n; out N : twice n", "in N : n; out N : n + 1", {"Right"}),
        ("in N : n; out N : n + 1 - 1", "in N : n; out N : n + 1", {"Right"}),  # it may overflow
        ("in N : n; out N : n + n", "in N : n; out N : n + 1", {"Right"}),
        ("in N : n; out N : n", "in N : n; out N : n + 1", set()),  # nothing depends on it
        ("in N : n; out N : n; out D : n", "in N : n; out N : n + 1", {"Right"}),
        ("both N : n", "in N : n; out N : n + 1", set()),
        ("both N : n", "in N : n; out N : 2 * n", set()),
        ("both N : n; out D : n", "in N : n; out N : n + 1", {"Right"}),
        ("both N : n; out D : n", "both N : n; out D : n", set()),
        ("both N : x", "in N : n; out N : n + 1", {"Right"}),
        ("both N : 5", "in N : n; out N : n + 1", {"Right"}),
        ("in N : 5; out N : 5", "both N : n; out D : n", set()),
        ("in N : 5", "in N : n; out N : n + 1", {"Right"}),
        ("in N : n; out N : n + 1; both M : n", "in N : n; out N : n + 1", {"Right", "Over"}),
        ("in Two : n; out Two : n + 1", "in Two : n; out Two : n + 1", {"Right"}),
        ("both Two : n; out D : n", "in Two : n; out Two : n + 1", {"Right"}),
        ("both Two : n; out D : n", "in Two : n; out Two : n", set()),  # it is only tested
        ("in Two : n; out Two : n", "in Two : n; out Two : n", set()),
        ("in Two : 4", "in Two : 5", set()),
        ("in Two : 5", "in Two : 5", {"Right"}),
        ("in Two : 5", "out Two : 5", set()),  # more of the same is nothing new
        ("in Two : n", "out Two : 5", {"Right"}),
        ("in Two : 5", "in Two : n", {"Right"}),
        (
            "in Pair : (n, b); out Pair : (n + 1, b)",
            "in Pair : (m, b); out Pair : (m, not b)",
            set(),
        ),
        (
            "in Pair : (n, b); out Pair : (n + 1, not b)",
            "in Pair : (n, b); out Pair : (n, not b)",
            {"Right"},
        ),
        ("both Pair : (n, true)", "in Pair : (m, b); out Pair : (m + 1, b)", set()),
        ("both Pair : (n, true)", "in Pair : (m, b); out Pair : (m, false)", {"Right"}),
        ("in Small : s; out Small : s + 1", "in Small : s; out Small : s + 2", set()),
        ("in Small : s; out Small : s + 1", "in Small : s; out Small : s - 1", {"Right"}),
        ("in N : s; out N : s + 1", "in N : n; out N : n + 1", {"Right"}),  # not any number
        (
            "in Held : (r, n); out Held : (r, n + 1)",
            "in Held : (r, n); out Held : (r, n + 1)",
            {"Right"},
        ),
    ],
)
def test_updates_of_the_only_token(left: str, right: str, expected: set[str]) -> None:
    lines = COUNTERS.splitlines()
    for name, more in (("Left", left), ("Right", right)):
        at = next(i for i, line in enumerate(lines) if f"trans {name}" in line)
        lines[at + 2 : at + 2] = [f"        {arc.strip()}" for arc in more.split(";")]
    assert rivals("\n".join(lines), "Left") == expected


@pytest.mark.parametrize(
    ("where", "expected"),
    [
        ("trans Left guard [n > 0]", {"Right"}),
        ("trans Left code input (n); action ignore n", {"Right"}),
        ("trans Left code action ignore (!seen)", set()),
    ],
)
def test_what_else_depends_on_the_token(where: str, expected: set[str]) -> None:
    text = COUNTERS.replace("trans Left", f"{where}\n        in N : n\n        out N : n + 1")
    text = text.replace("trans Right", "trans Right\n        in N : m\n        out N : m + 1")
    assert rivals(text, "Left") == expected


TENDING = """
    net Tending
      standard
      var n: INT;
      place Feeder = 3
      place Held
      place Left : INT = 1`3
      place Free = 1
      place Done
      trans Feed
        in Feeder : ()
        in Free : ()
        out Held : ()
      trans Stow
        in Held : ()
        in Left : n
        out Left : n - 1
        out Free : ()
      trans Drop
        in Feeder : ()
        in Left : n
        out Left : n - 1
      trans End
        in Left : 0
        out Done : ()
"""


def test_what_is_never_enabled_together_does_not_conflict() -> None:
    """`Left` is as great as the number of tokens on the two other places."""
    assert rivals(TENDING, "End") == set()
    assert rivals(TENDING, "Stow") == set()
    assert rivals(TENDING, "Drop") == {"Feed"}
    assert rivals(TENDING.replace("Left : INT = 1`3", "Left : INT = 1`2"), "Stow") == {"End"}
    assert rivals(TENDING.replace("in Left : 0", "in Left : 1"), "Stow") == {"End"}
    assert rivals(TENDING.replace("out Held : ()", "out Held : 2`()"), "Stow") == {"End"}
    assert "End" in rivals(TENDING.replace("Left : INT = 1`3", "Left : INT = 1`3 ++ 1`0"), "Stow")


def test_a_search_that_may_raise_is_not_excluded() -> None:
    """Its exception does not wait for the tokens without which it is disabled."""
    text = TENDING.replace("trans End", "trans End guard [6 div n > 0]").replace(
        "in Left : 0", "in Left : n\n        inhibit Held\n        in Free : ()"
    )
    assert "End" in rivals(text, "Stow")


def test_what_puts_back_what_it_takes_helps_nobody() -> None:
    net = flat(TENDING)
    index = {t.short: t.index for t in net.transitions}
    left = next(p.index for p in net.places if p.short == "Left")
    member = dependency(net).members[index["End"]]
    assert [(r.place, r.helpers) for r in member.reasons] == [(left, ())]
    assert member.helpers == (index["Stow"], index["Drop"])  # they may make it 0
    member = dependency(net).members[index["Drop"]]
    assert member.helpers == ()


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


def _everything(a: Any, b: Any) -> bool:
    return How.CHANGES not in (a.how, b.how) or How.IDLE in (a.how, b.how)


def _sum(self: Relations, relation: Any, one: int, other: int) -> bool:
    mine, its = self.least[one], self.least[other]
    total = sum(w * (mine.get(p, 0) + its.get(p, 0)) for p, w in relation.tokens.items())
    return total > relation.total


@pytest.mark.parametrize(
    ("of", "name", "wrong", "shown_by"),
    [
        (updates, "_commute", _everything, 2),  # a sum and a maximum
        (module, "is_moved_by", lambda a, b: False, 15),  # guards that see the token
        (Relations, "_is_broken", _sum, 0),  # tokens of both instead of either
    ],
)
def test_wrong_rules_for_counters_are_noticed(
    monkeypatch: pytest.MonkeyPatch, of: Any, name: str, wrong: Any, shown_by: int
) -> None:
    """The net that has shown it comes first; should it change, another one will do."""
    monkeypatch.setattr(of, name, wrong)
    net = flat(concurrent(0, max(NETS, 16), counters=3))
    with pytest.raises(BrokenError):
        for number in sorted(numbers_of(net), key=lambda n: n != shown_by):
            sets(only(net, [number]))


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
