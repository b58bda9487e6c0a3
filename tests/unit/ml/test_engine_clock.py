"""The clock of CPN Tools under its inner name: `CPN'Time` has what `ModelTime` has."""

from __future__ import annotations

from helpers.netbuilder import diagnose, flat
from pn2code.semantics.game.token_game import Game

NET = """
net N
  standard
  place P : STRING = 1`(EXPRESSION)
"""


def test_the_inner_name_is_another_name() -> None:
    expression = "CPN'Time.toString (CPN'Time.add (time (), CPN'Time.fromInt 2))"
    game = Game(flat(NET.replace("EXPRESSION", expression)))
    assert game.marking_text("Top.P") == '1`"2"'


def test_the_clock_itself_is_refused_with_what_to_write() -> None:
    for structure in ("CPN'Time", "ModelTime"):
        text = f"{structure}.toString (!{structure}.model_time)"
        (e,) = diagnose(NET.replace("EXPRESSION", text)).errors
        assert e.code == "unsupported-function"
        assert e.hint is not None and "write `time ()`" in e.hint
