"""`verify` of nets in which an Overflow is raised in some order of conditions alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NET = """
    net N
      standard
      colset S = int with 0..9;
      var n, m, k : INT;
      var s : S;
      fun twice x = x + x;
      page Top
        place A : INT = 1`1
        place B : INT = 1`%s
        place C : S = 1`3
        place Go : INT = 1`0
        place O : INT
        trans Step
          guard [k < %d]
          in Go : k
          out Go : k + 1
        trans T
          guard [%s]
          in A : n
          in B : m
          in C : s
          in Go : k
          out O : n
"""
GOOD = "always { size (Mark.Top'Go 1) <= 1 }"
LARGE = "1073741823"


def verified(folder: Path, guard: str, token: str, *options: str, steps: int = 2) -> Any:
    path = write(NET % (token, steps, guard), folder / "n.cpn")
    arguments = ["verify", str(path), "-o", str(folder / "runs"), *options]
    done = CliRunner().invoke(app, [*arguments, "--json"])
    text = CliRunner().invoke(app, arguments)
    assert text.exit_code == done.exit_code
    return done.exit_code, json.loads(done.stdout), text.stdout.replace("\n", " ")


@pytest.mark.parametrize(
    ("guard", "raises"),
    [
        ("n > 5, m + m > 0", "m + m > 0"),
        ("n > 5, twice m > 0", "twice m > 0"),
        ("n > 5, m * s > 0", "m * s > 0"),
        ("n > 5, ~m - 2 < 0", "~m - 2 < 0"),
    ],
)
def test_an_overflow_in_another_order_is_no_yes(tmp_path: Path, guard: str, raises: str) -> None:
    """CPN Tools stops with Overflow in all of these but `m * s`, where it happens to ask in the order here."""
    for options in ((), ("--property", GOOD)):
        code, row, text = verified(tmp_path, guard, LARGE, *options)
        assert code == 3 and row["error"] is None
        raised = row["other_orders"]["raised"]
        assert (raised["transition"], raised["raises"]) == ("Top.T", raises)
        assert raised["message"] == "Overflow" and "raises `Overflow`" in text


@pytest.mark.parametrize(
    ("guard", "token"),
    [
        ("n > 5, m + m > 0", "536870911"),
        ("n > 5, s * s + 1 > 0", LARGE),  # by the colour set
        ("n > 5, k * 1000 > 0", LARGE),  # by the markings
    ],
)
def test_small_integers_need_no_second_look(tmp_path: Path, guard: str, token: str) -> None:
    code, row, text = verified(tmp_path, guard, token)
    assert code == 0 and row["other_orders"] is None and "Verdict: COMPLETE" in text


def test_markings_that_are_not_listed_are_looked_at_again(tmp_path: Path) -> None:
    """More colours than are told of a bound: the greatest is not known."""
    code, row, _ = verified(tmp_path, "n > 5, k * 1000 > 0", LARGE, steps=300)
    assert code == 0
    assert row["other_orders"] == {"harmless": True, "why": "", "raised": None, "of_cell": False}


def test_a_part_of_the_markings_is_looked_at_again(tmp_path: Path) -> None:
    """It decides the property, and what the rest holds is not known."""
    seen = ("--property", "ctl EF { size (Mark.Top'Go 1) = 1 }", "--max-states", "1")
    code, row, _ = verified(tmp_path, "n > 5, m + m > 0", LARGE, *seen)
    assert code == 3 and not row["complete"] and not row["other_orders"]["harmless"]


def test_an_overflow_does_not_hide_a_value_outside_the_colour_set(tmp_path: Path) -> None:
    guard = "n > 5, n > 0, s = m, s + 1 > 0"
    text = NET.replace("in C : s", "in C : 3")
    path = write(text % (LARGE, 2, guard), tmp_path / "n.cpn")
    done = CliRunner().invoke(app, ["verify", str(path), "-o", str(tmp_path / "runs")])
    assert done.exit_code == 3 and "Verdict: NOT KNOWN" in done.stdout
    assert "of `Top.T` Overflow" not in done.stdout
