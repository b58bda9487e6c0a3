"""Mistakes in a cell's net as text: what is said of each, and that nothing is said besides."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load

NET = """standard
colset TUNIT = unit timed;
colset PART = int with 1..3;
colset VERDICT = with good | bad;
colset RESULT = product PART * VERDICT;
var n : PART;
var v : VERDICT;
val patience = 5;
page Top
  place Order : PART = 1`1
  place Answer : RESULT
  subst Robot = Robot (Order -> Order, Answer -> Answer)
page Robot
  place Order port in : PART
  place Answer port out : RESULT
  place Idle : UNIT = ()
  place Timer : TUNIT
  place Busy : PART
  trans Accept
    in Order : n
    in Idle : ()
    out Busy : n
    out Timer : ()@+patience
  trans Report
    guard [v = good]
    in Busy : n
    in Timer : ()
    out Answer : (n, v)
    out Idle : ()
"""
MISTAKES = {
    "a port of no kind": (
        "Order port in :", "Order port inn :", 14, "`inn` is no kind of port", "did you mean `in`?",
    ),
    "a direction without `port`": (
        "Order port in :", "Order in :", 14, "`in` is not expected", "a port is written `port in`",
    ),
    "a colour set without a colon": (
        "port out : RESULT", "port out RESULT", 15, "`RESULT` is not expected", "colon, `: RESULT`",
    ),
    "a name of two words": (
        "place Busy", "place Busy Now", 18, "`Now` is not expected", 'place "Busy Now" : PART',
    ),
    "a place twice": (
        "  place Busy : PART\n", "  place Busy : PART\n  place Busy : PART\n",
        19, "place `Busy` is there twice", "another name",
    ),
    "a marking without `=`": (
        "Idle : UNIT = ()", "Idle : UNIT ()", 16, "`()` is not expected after", "`: UNIT = ()`",
    ),
    "a time in an untimed place": (
        "Timer : TUNIT", "Timer : UNIT", 23, "is not timed", "the timed colour set `TUNIT`",
    ),
    "an arc that is not deeper": (
        "    in Idle", "  in Idle", 21, "an arc belongs to a transition", "deeper than `trans Accept`",
    ),
    "a guard that is not deeper": (
        "    guard", "  guard", 25, "`guard` belongs to a transition", "deeper than `trans Report`",
    ),
    "a transition that is deeper": (
        "  trans Report", "    trans Report", 24, "begins with `trans`", "as deep as `trans Accept`",
    ),
    "a place that is deeper": (
        "  place Busy", "    place Busy", 18, "deeper than that of place `Timer`", "as deep as the",
    ),
    "a place that stands outside": (
        "  place Busy", "place Busy", 18, "begins with `place`", "stand deeper than their `page`",
    ),
    "a misspelt place": ("  place Busy", "  plcae Busy", 18, "begins with `plcae`", "`place`?"),
    "a misspelt transition": (
        "  trans Report", "  trasn Report", 24, "begins with `trasn`", "did you mean `trans`?",
    ),
    "a misspelt page": ("page Robot", "pgae Robot", 13, "begins with `pgae`", "`page`?"),
    "an action without `code`": (
        "    in Timer : ()\n", "    in Timer : ()\n    action (ignore n)\n",
        28, "begins with `action`", "`code action (ignore n)`",
    ),
    "an arc without a direction": (
        "    in Busy : n", "    Busy : n", 26, "begins with `Busy`", "`in Busy : n`",
    ),
    "sockets after `=`": (
        "Robot (Order -> Order,", "Robot (Order = Order,", 12, "no assignment", "Port -> Socket",
    ),
    "a colour set that cannot be read": (
        "int with 1..3", "int 1..3", 3, "`1..3` is not expected", "int with 1..4",
    ),
    "colours after commas": (
        "with good | bad", "with good, bad", 4, "a name is expected", "`with good | bad`",
    ),
    "a variable without a colon": (
        "var v : VERDICT", "var v VERDICT", 7, "the colour set of the variables", "var x, y : PART;",
    ),
    "a misspelt colour": ("v = good", "v = god", 25, "`god` is not declared", "`good`?"),
    "a colour that there is not": (
        "v = good", "v = fine", 25, "`fine` is not declared", "a value of `VERDICT` belongs here: `good`, `bad`",
    ),
    "a misspelt colour on an arc": (
        "(n, v)", "(n, badd)", 28, "`badd` is not declared", "did you mean `bad`?",
    ),
    "a number compared with a colour": (
        "v = good", "n < good", 25, "is `VERDICT`, but `int`", "the left one is `int`",
    ),
    "no standard colour sets": (
        "standard\n", "# standard\n", 16, "unknown colour set `UNIT`", "write `standard`",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKES)
def test_one_mistake_is_one_error_that_says_what_to_do(name: str, tmp_path: Path) -> None:
    right, wrong, line, message, hint = MISTAKES[name]
    assert right in NET
    path = tmp_path / "net.cpnt"
    path.write_text(NET.replace(right, wrong, 1))
    d = Diagnostics()
    assert load(path, d) is None
    (error,) = d.errors
    assert error.origin.line == line, error
    assert message in error.message
    assert hint in error.hint
    rest = [item for item in d.items if item is not error]
    assert all(item.code == "neighbour-wrong" for item in rest), rest
    assert len(rest) <= 1


def test_the_net_without_a_mistake_is_right(tmp_path: Path) -> None:
    path = tmp_path / "net.cpnt"
    path.write_text(NET)
    d = Diagnostics()
    assert load(path, d) is not None
    assert not d.items


def test_a_place_of_another_page_is_named(tmp_path: Path) -> None:
    path = tmp_path / "net.cpnt"
    path.write_text(NET + "  trans More\n    in Feed : n\n" + "page Third\n  place Feed : PART\n")
    d = Diagnostics()
    assert load(path, d) is None
    (error,) = d.errors
    assert "page `Robot` has no place `Feed`" in error.message
    assert "there is one on page `Third`" in error.hint
