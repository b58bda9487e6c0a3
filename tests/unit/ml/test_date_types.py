"""Types of the library's dates: what a net calls `Date.month` is what `Date.month` gives."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

VALUES = {
    "year (of_day 11323)": "2001",
    "if month (of_day 11323) = Date.Jan then 1 else 0": "1",
    "case weekday (of_day 11323) of Date.Mon => 1 | Date.Tue => 2 | _ => 0": "1",
    "if same (of_day 3, of_day 3) then 1 else 0": "1",
}
"""What the engine of CPN Tools gives for each, too: it compares dates."""


@pytest.mark.parametrize("value", VALUES)
def test_named_types_of_dates(value: str) -> None:
    net = flat(
        "net Dates\n  standard\n"
        "  fun of_day n = Date.fromTimeUniv (Time.fromReal (86400.0 * real n)) : Date.date;\n"
        "  fun year (d : Date.date) = Date.year d;\n"
        "  fun month d = Date.month d : Date.month;\n"
        "  fun weekday (d : Date.date) : Date.weekday = Date.weekDay d;\n"
        "  fun same (a : Date.date, b) = a = b;\n"
        f"  page Top\n    place P : INT = 1`({value})\n"
    )
    assert str(places(net, Game(net, seed=1).marking)[0]["marking"]) == f"1`{VALUES[value]}"
