"""Variables and places hold only what is in their colour sets: a script asks where it is not known, or is refused."""

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


KEEPS = """
    place Idle = 1
    place Kept : {colset} = 1`{initial}
    trans Go
      both Idle
      in x : k
      in Kept : {taken}
      out Kept : {put}
      out y : 1
"""
PUT = {
    "more": ("SMALL", "0", "small", "small + 1", "small + 1 <= 3"),
    "less": ("SMALL", "3", "small", "small - k", "small - k >= 0 and small - k <= 3"),
    "on a way": ("SMALL", "0", "small", "if small < 3 then small + 1 else 0", ""),
    "the rest": ("SMALL", "0", "small", "(small + k) mod 4", ""),
    "the same": ("SMALL", "0", "small", "small", ""),
    "a message": ("SMALL", "0", "small", "k", "k >= 0 and k <= 3"),
    "a component": ("BOTH", "(1, 0)", "(tiny, h)", "(tiny, k)", ""),
    "another component": ("BOTH", "(1, 0)", "(tiny, h)", "(k, h)", "k >= 1 and k <= 2"),
    "a part": ("BOTH", "(1, 0)", "two", "(#1 two, k)", ""),
    "reals": ("SHARE", "0.0", "share", "share * 2.0", "share * 2.0 >= 0.0 and share * 2.0 <= 1.0"),
    "a constant string": ("LOW", '"a"', "low", '"b"', ""),
    "a subset": ("EVEN", "0", "even", "even", ""),
}


@pytest.mark.parametrize("what", PUT)
def test_what_is_asked_of_a_token_that_is_put(what: str, tmp_path: Path) -> None:
    colset, initial, taken, put, condition = PUT[what]
    page = KEEPS.format(colset=colset, initial=initial, taken=taken, put=put)
    cell = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=EXTRA + "  var h : INT;\n")
    assert cell.messages == []
    found = [line.strip() for line in cell.body.splitlines() if line.strip().startswith("if ")]
    if condition:
        shown = f"({condition})" if " and " in condition else condition
        assert found == [f"if not {shown} then"]
        assert f"colour set {colset} of place Kept does not have" in cell.body
        # It stops before anything of the transition is visible.
        assert cell.body.index("stop") < cell.body.index("mark")
    else:
        assert not [line for line in found if line.startswith("if not")]
        assert "does not have" not in cell.body


@pytest.mark.parametrize(
    ("colset", "initial", "taken", "put"),
    [("EVEN", "0", "even", "k"), ("LOW", '"a"', "low", 'low ^ "b"'), ("LOW", '"a"', "low", '"B"')],
)
def test_what_cannot_be_asked_of_a_token(
    colset: str, initial: str, taken: str, put: str, tmp_path: Path
) -> None:
    page = KEEPS.format(colset=colset, initial=initial, taken=taken, put=put)
    cell = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=EXTRA)
    (message,) = cell.messages
    assert "error[unsupported-robot-expression]" in message
    assert f"what is put here has to be in colour set `{colset}`" in message


def test_a_message_that_its_channel_does_not_have(tmp_path: Path) -> None:
    page = PAGE.format(taken="k").replace("out y : 1", "out y : k")
    extra = EXTRA + "  var x : INT;\n"
    cell = Cell(tmp_path, page, ("x in INT", "y out SMALL"), extra=extra)
    assert "if not (k >= 0 and k <= 3) then" in cell.body


def test_the_result_of_a_code_segment_may_be_anything(tmp_path: Path) -> None:
    """CPN Tools does not ask whether it is in the colour set of the variable."""
    page = KEEPS.format(colset="SMALL", initial="0", taken="h", put="small")
    page = page.replace("trans Go", "trans Go code input (k); output (small); action k")
    cell = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=EXTRA + "  var h : INT;\n")
    assert cell.messages == []
    assert "if not (k >= 0 and k <= 3) then" in cell.body


def test_a_script_stops_at_a_colour_that_its_own_place_does_not_have(tmp_path: Path) -> None:
    page = KEEPS.format(colset="SMALL", initial="0", taken="small", put="small + k")
    cell = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=EXTRA)
    result = replayed(cell, [("x", (3,)), ("x", (1,))])
    assert result.ok and result.steps == 4, result
    assert isinstance(cell.end, Fault)
    assert cell.end.message == "Go: colour set SMALL of place Kept does not have 4"
