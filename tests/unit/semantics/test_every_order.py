"""Whether a search for bindings raises an exception in whatever order the conditions are asked."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.every_order import raises_in_every_order
from pn2code.semantics.game.token_game import Game

NET = """
net N
  standard
  colset L = list INT;
  colset LATER = list INT timed;
  var l, r : L;
  var n, m, k : INT;
  fun one (x :: _) = let val [y] = [x, x] in y end | one [] = 0;
  page Q
    place P : L = 1`[]
    place P2 : L = 1`[] ++ 1`[1]
    place A : INT = 1`1
    place B : INT = 1`2
    place E : INT
    place W : LATER = 1`[]@+5
    trans T%s
%s
"""


@pytest.mark.parametrize(
    ("guard", "arcs", "expected"),
    [
        ("hd l > 0", "P : l", True),
        ("hd l > 0, n > 0", "P : l|A : n", True),
        ("hd l > 0, n > 1", "P : l|A : n", False),
        ("n > 1, hd l > 0", "P : l|A : n", False),
        ("hd l > 0", "P : l|E : n", False),
        ("hd l > 0", "P : l|A : 2", False),
        ("hd l > 0", "P : l|A : n|B : n", False),
        ("hd l > 0", "P : l|inhibit A", False),
        ("hd l > 0", "W : l", False),
        ("hd l > 0", "P : 2`l", False),
        ("hd l > hd r", "P : 1`l ++ 1`r", False),  # there is one token
        ("hd l > hd r", "P2 : 1`l ++ 1`r", True),
        ("m = hd l, m > 0", "P : l", True),
        ("m = hd l, m > 0", "P : l|A : m", True),
        ("m = hd l, m > 5", "P : l|A : m", False),  # it may be the value of a token
        ("m = hd l, n = m", "P : l|A : n", False),
        ("m = hd l, m = n, length l > 0", "P : l|A : n", False),
        ("", "P : l|A : hd l", True),
        ("", "P : l|E : hd l", False),
        ("", "P : l|A : 2`(hd l)", False),
        ("", "P : l|A : n|A : hd l", False),  # two are wanted
        ("hd l > 0, hd r > 0", "P : l|P2 : r", True),  # both are empty
        ("one r > 0, hd l > 0", "P : l|P2 : r", False),  # `Bind`, or false
    ],
)
def test_what_no_order_avoids(guard: str, arcs: str, expected: bool) -> None:
    inputs = [x if x.startswith("inhibit") else f"in {x}" for x in arcs.split("|")]
    text = NET % (f" guard [{guard}]" if guard else "", "\n".join(f"      {x}" for x in inputs))
    net = flat(text)
    game = Game(net, {}, files=Files(None))
    assert raises_in_every_order(game.enabling, net.transitions[0], game.marking) == expected
