"""`inst ()` in inscriptions: each instance of a page has its own number in them."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.ml.core.terms import Lit
from pn2code.net.instance_numbers import mentioned
from pn2code.semantics.game.token_game import Game

NET = """
net Numbered
  standard
  colset SEEN = product INT * INT;
  var n, k: INT;
  fun twice x = 2 * x;
  page Top
    place In : INT = 1`1 ++ 1`2
    place Out : SEEN
    subst B = Sub (In -> In, Out -> Out)
    subst A = Sub (In -> In, Out -> Out)
  page Sub
    place In port in : INT
    place Out port out : SEEN
    place Own : INT = {marking}
    trans Take guard [{guard}] code input (n); output (k); action {action};
      in In : n
      out Out : (k, {value})
"""


def net(
    *,
    marking: str = "empty",
    guard: str = "n = inst ()",
    action: str = "inst ()",
    value: str = "inst ()",
) -> str:
    return NET.format(marking=marking, guard=guard, action=action, value=value)


@pytest.mark.parametrize(
    ("value", "one", "two"),
    [
        ("inst ()", 1, 2),
        ("twice (inst ())", 2, 4),
        ("let fun own x = x * inst () in own 10 end", 10, 20),
        ("let val own = fn x => x * inst () val more = own 10 in more + own 1 end", 11, 22),
        ("hd (map inst [()])", 1, 2),
        ("List.foldr (fn (x, sum) => x * inst () + sum) 0 [1, 2]", 3, 6),
        ("case inst () of 1 => 0 | m => m", 0, 2),
    ],
)
def test_what_it_is_where_it_stands(value: str, one: int, two: int) -> None:
    game = Game(flat(net(value=value, action=value)))
    while game.enabled():
        game.fire(game.enabled()[0])
    assert game.marking_text("Top.Out") == f"1`({one},{one})++\n1`({two},{two})"


def test_behind_flattening_it_is_a_number() -> None:
    made = flat(net())
    assert not mentioned(made.transitions) and not mentioned(made.places)
    first, second = made.transitions
    assert first.guards != second.guards
    assert first.code is not None and isinstance(first.code.action, Lit)
    plain = flat(net(guard="n > 0", action="n", value="n"))
    assert plain.transitions[0].guards[0] is plain.transitions[1].guards[0]  # shared, as before


def test_an_initial_marking_has_it_with_a_warning() -> None:
    made = flat(net(marking="1`(inst () * 100)"))
    game = Game(made)
    own = [p for p in made.places if p.short == "Own"]
    found = {p.instance_number: game.marking_text(p.name) for p in own}
    assert found == {1: "1`100", 2: "1`200"}
    (warning,) = diagnose(net(marking="1`(inst ())")).items
    assert warning.code == "initial-marking-instance" and "`Own`" in warning.message


@pytest.mark.parametrize(
    "declaration",
    ["fun own () = inst ();", "val own = inst;", "fun own x = let val n = inst () in n + x end;"],
)
def test_a_declaration_has_none(declaration: str) -> None:
    text = net().replace("fun twice x = 2 * x;", declaration + " fun twice x = 2 * x;")
    (error,) = diagnose(text).errors
    assert error.code == "unsupported-function" and "`inst`" in error.message
    assert "give it to a function as an argument" in str(error.hint)


def test_a_priority_has_none() -> None:
    (error,) = diagnose(net().replace("guard [", "priority inst () guard [")).errors
    assert error.code == "unsupported-function"


@pytest.mark.parametrize("own", ["fun inst () = 9;", "val inst = fn () => 9;"])
def test_a_net_may_have_its_own(own: str) -> None:
    made = flat(net(guard="n = inst () - 8").replace("fun twice x = 2 * x;", own))
    assert made.transitions[0].guards == made.transitions[1].guards
