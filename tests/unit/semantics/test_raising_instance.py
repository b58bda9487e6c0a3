"""An exception in a search for bindings: of which instance of a page the transition is."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.simulate.run import Failure

NET = """
net Twice
  standard
  colset T = INT timed;
  var n: INT;
  fun only (a, x) = if a = 2 then hd (nil : INT list) else x;
  page Top
    place In : T = 1`1@5
    subst B = Sub (In -> In)
    subst A = Sub (In -> In)
  page Sub
    place In port in : T
    trans Take guard [{guard}]
      in In : {wanted}
"""


@pytest.mark.parametrize(
    ("guard", "wanted"),
    [
        ("only (inst (), n) > 0", "n"),
        ("true", "1`n ++ only (inst (), 0)`n"),
        ("true", "n@+only (inst (), 0)"),
    ],
)
def test_it_is_that_of_the_search(guard: str, wanted: str) -> None:
    """The simulation by the token game named the first instance and no transition."""
    game = Game(flat(NET.format(guard=guard, wanted=wanted)))
    with pytest.raises(GameError, match="Empty") as raised:
        game.enabled_transitions(game.advance_time(game.marking))
    row = Failure.of(raised.value).row()
    assert (row["page"], row["instance"], row["transition"]) == ("Sub", 2, "Take")
    assert row["binding"] is None
