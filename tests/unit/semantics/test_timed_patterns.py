"""`v@s` in patterns: to CPN Tools `@` is the constructor of timed tokens."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

NET = """
    net Stamps
      colset INT = int timed;
      fun stamp txs = let val (v@s) = ms_to_col txs in IntInf.toInt s end
      fun both (v@s) = v + IntInf.toInt s
      fun latest [] = 0 | latest ((v@s) :: rest) = Int.max (IntInf.toInt s, latest rest)
      fun firsts tokens = List.map (fn v@_ => v) tokens
      place A : INT = 1`(%s)
"""


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("stamp (1`3@7)", 7),
        ("both (3@7)", 10),
        ("latest (1`3@7 +++ 1`4@9)", 9),
        ("List.length (firsts [3@7, 4@9])", 2),
        ("case 5@6 of 5@s => IntInf.toInt s | _ => 0", 6),
    ],
)
def test_value(text: str, value: int) -> None:
    net = flat(NET % text)
    (row,) = places(net, Game(net).marking)
    assert row["marking"] == f"1`{value}@0"
