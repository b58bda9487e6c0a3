"""Conditions that an expression has a value, against the equality of the values themselves."""

from __future__ import annotations

from itertools import count, product

import pytest

from helpers.netbuilder import load
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import TCon
from pn2code.semantics.game.token_game import Game
from pn2code.verify.controller.equals import Equals, NoPatternError

NET = """
net values
  standard
  colset BIG = intinf;
  colset COLOUR = with red | green | blue;
  colset PAIR = product INT * REAL;
  colset POSE = record x:REAL * y:REAL * on:BOOL;
  colset LIST = list PAIR;
  colset EITHER = union None + Some:POSE + Two:LIST;
  colset TEXT = string;
  colset U = unit;
  val v_INT = [0, 5, ~5]; val v_BIG : BIG list = [0, 123456789012345678]; val v_COLOUR = [red, blue];
  val v_PAIR = [(1, 0.0), (1, 2.5), (2, 2.5)]; val v_LIST = [[], [(1, 1.0)], [(1, 1.0), (1, 1.0)], [(1, 1.5)]];
  val v_POSE = [{x = 1.0, y = 2.0, on = true}, {x = 1.0, y = 2.0, on = false}, {x = 2.0, y = 1.0, on = true}];
  val v_EITHER = [None, Some {x = 1.0, y = 2.0, on = true}, Some {x = 1.0, y = 3.0, on = true}, Two [], Two [(1, 1.0)]];
  val v_TEXT = ["", "a", "b\\n"]; val v_BOOL = [true, false]; val v_REAL = [0.0, 1.0E~300, ~2.5]; val v_U = [()];
  val f = [fn x => x + 1];
  page Top
    place P : INT
"""


KINDS = ("INT", "BIG", "COLOUR", "PAIR", "LIST", "POSE", "EITHER", "TEXT", "BOOL", "REAL", "U")


@pytest.fixture(scope="module")
def game() -> Game:
    net, d = load(NET)
    assert net is not None, [e.message for e in d.errors]
    return Game(net)


@pytest.mark.parametrize("kind", KINDS)
def test_all_pairs(game: Game, kind: str) -> None:
    symbol = game.net.program.globals[f"v_{kind}"]
    values = game.evaluator.globals[symbol.uid]
    assert isinstance(symbol.type, TCon) and isinstance(values, tuple)
    (item,) = symbol.type.args
    equals = Equals(game.net.program, count(1 << 30))
    variable = core.Symbol(1 << 29, "x", item)
    span = game.net.program.declarations[-1].span
    assert span is not None
    for a, b in product(values, repeat=2):
        condition = equals.condition(core.Var(variable, item, span), a)
        assert game.evaluator.value(condition, {variable: b}) is (a == b), (a, b)
        both = [condition, condition]
        assert game.evaluator.value(equals.all(both, span), {variable: b}) is (a == b)
        assert game.evaluator.value(equals.none(both), {variable: b}) is (a != b)
    assert game.evaluator.value(equals.all([], span), {}) is True


def test_functions_have_no_pattern(game: Game) -> None:
    symbol = game.net.program.globals["f"]
    (value,) = game.evaluator.globals[symbol.uid]  # type: ignore[misc]
    (item,) = symbol.type.args  # type: ignore[union-attr]
    span = game.net.program.declarations[-1].span
    assert span is not None
    equals = Equals(game.net.program, count(1 << 30))
    with pytest.raises(NoPatternError, match="int -> int"):
        equals.condition(core.Var(symbol, item, span), value)
