"""A variable takes only what is in its colour set: a script asks that where the place may hold more, or is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.robots import Cell, replayed
from pn2code.tdl.requests import Fault

EXTRA = """
  colset SMALL = int with 0..3;
  colset TINY = int with 1..2;
  colset SHARE = real with 0.0..1.0;
  colset TWO = product INT * INT;
  colset BOTH = product TINY * INT;
  colset EVEN = subset INT by (fn i => i mod 2 = 0);
  colset LOW = string with "a".."z";
  var small : SMALL;  var tiny : TINY;  var share : SHARE;  var two : BOTH;  var even : EVEN;  var low : LOW;
"""
PAGE = """
    place Idle = 1
    trans Go
      both Idle
      in x : {taken}
      out y : 1
"""
ASKED = {
    "wider place": ("INT", "small", "small >= 0 and small <= 3"),
    "wider range": ("SMALL", "tiny", "tiny >= 1 and tiny <= 2"),
    "the same": ("SMALL", "small", ""),
    "narrower place": ("TINY", "small", ""),
    "no range": ("SMALL", "k", ""),
    "reals": ("REAL", "share", "share >= 0.0 and share <= 1.0"),
    "component": ("TWO", "(k, tiny)", "tiny >= 1 and tiny <= 2"),
    "whole": ("TWO", "two", "two_1 >= 1 and two_1 <= 2"),
}


@pytest.mark.parametrize("what", ASKED)
def test_what_is_asked(what: str, tmp_path: Path) -> None:
    colset, taken, condition = ASKED[what]
    extra = f"{EXTRA}  var x : {colset};\n"
    cell = Cell(tmp_path, PAGE.format(taken=taken), (f"x in {colset}", "y out INT"), extra=extra)
    assert cell.messages == []
    found = [line.strip() for line in cell.body.splitlines() if line.strip().startswith("if ")]
    assert found == ([f"if {condition} then"] if condition else [])


@pytest.mark.parametrize(("colset", "taken"), [("INT", "even"), ("STRING", "low")])
def test_what_cannot_be_asked(colset: str, taken: str, tmp_path: Path) -> None:
    cell = Cell(tmp_path, PAGE.format(taken=taken), (f"x in {colset}", "y out INT"), extra=EXTRA)
    (message,) = cell.messages
    assert "error[unsupported-robot-expression]" in message
    assert f"variable `{taken}` takes only what is in colour set `{taken.upper()}`" in message


def test_a_value_that_a_guard_gives(tmp_path: Path) -> None:
    page = PAGE.format(taken="k").replace("trans Go", "trans Go guard [small = k + 1]")
    cell = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=EXTRA)
    assert cell.messages == []
    assert "if k + 1 >= 0 and k + 1 <= 3 then" in cell.body


def test_a_script_stops_where_the_net_does(tmp_path: Path) -> None:
    cell = Cell(tmp_path, PAGE.format(taken="small"), ("x in INT", "y out INT"), extra=EXTRA)
    result = replayed(cell, [("x", (3,)), ("x", (4,))])
    # Two messages that are sent, one that is taken, and its answer.
    assert result.ok and result.steps == 4, result
    assert isinstance(cell.end, Fault) and "nothing can happen with small = 4" in cell.end.message
