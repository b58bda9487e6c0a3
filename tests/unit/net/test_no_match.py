"""Where `Bind` on an input arc means that there is no binding. What it says was asked of the engine of CPN Tools."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.net.no_match import no_match_places
from pn2code.semantics.game.token_game import Game, GameError

NET = """
net G
  standard
  colset SMALL = int with 0..3;
  colset PR = product INT * INT;
  var n, m: INT;
  var s: SMALL;
  fun g n = let val (x :: _) = if n > 1 then [n] else [] in x end;
  page Top
    place P : INT = 1`1
    place D : PR = 1`(1, 1)
    place Q : INT = 1`1 ++ 1`2
    place R : INT
    trans T {guard}
      in {first}
      in Q : {wanted}
      out R : 1
"""


@pytest.mark.parametrize(
    ("guard", "first", "wanted", "is_none"),
    [
        ("", "P : n", "g n", True),
        ("guard [m = n + 0]", "P : n", "g m", True),
        ("guard [m = 1]", "P : n", "g m", True),
        ("", "P : n", "1`n ++ 1`(g 1)", True),
        ("", "D : (n, m)", "g m", True),
        ("", "P : n", "g 1", False),
        ("", "P : n", "g s", False),
        ("", "P : n", "g (n * s)", False),  # CPN Tools does not try the other values
        ("", "D : (1, n)", "g n", False),  # it is found by a part that is known
    ],
)
def test_where_bind_means_no_binding(guard: str, first: str, wanted: str, is_none: bool) -> None:
    net = flat(NET.format(guard=guard, first=first, wanted=wanted))
    (t,) = net.transitions
    assert (t.arcs[1].place in no_match_places(t)) == is_none
    game = Game(net, seed=1)
    if is_none:
        assert not game.enabled()
    else:
        with pytest.raises(GameError, match="Bind"):
            game.enabled()


def test_why_a_binding_is_not_possible() -> None:
    net = flat(NET.format(guard="", first="P : n", wanted="g n"))
    game = Game(net, seed=1)
    (t,) = net.transitions
    (n,) = t.variables
    why = game.enabling.why_disabled(t, game.marking, {n: 1})
    assert why is not None and "Bind" in why
