"""How long an answer takes where the script goes round along a list, or as often as a number says."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.small_cell import NET, TOML, write
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.verdict.opened import read
from pn2code.verify.controller.replies import Replies

COLSETS = """  colset FEW = int with 0..4;
  colset DIGITS = list FEW with 0..6;
  colset PAIR = product DIGITS * FEW;
  var l, rest: DIGITS;
  var f, g, h: FEW;
"""
ROUND = """    trans Again
      in Loop : {taken}
      out Loop : {put}
      code action drill ()
"""


def replies(folder: Path, colset: str, start: str, steps: str, end: str) -> Replies:
    """Of the small cell, whose robot goes round among places of its own before it reports."""
    net = NET.replace("  val MOVE", f"{COLSETS}  val MOVE", 1)
    report = net[net.index("    trans Report") :]
    begin = f"    trans Begin\n      in Over : ()\n      out Loop : {start}\n"
    over = report.replace("in Over : ()", f"in Loop : {end}")
    assert over != report
    places = f"    place Loop : {colset}\n    place Between : {colset}\n"
    net = net.replace(report, places + begin + steps + over)
    d = Diagnostics()
    opened = read(write(folder, net, TOML), {}, d)
    assert opened is not None and opened.config is not None, [x.message for x in d.errors]
    partition = divide(opened.flat, opened.config, d)
    assert partition is not None, [x.message for x in d.errors]
    return Replies.of(partition, opened.config)


@pytest.mark.parametrize(
    ("colset", "start", "taken", "put", "end", "seconds"),
    [
        ("DIGITS", "[1, 2]", "f :: rest", "rest", "[]", 7),
        ("DIGITS", "[1, 2]", "f :: g :: rest", "rest", "[]", 4),
        ("DIGITS", "[1, 2]", "f :: g :: rest", "h :: rest", "[]", 7),
        ("FEW", "3", "f", "f - 1", "0", 5),
        ("FEW", "3", "f", "f + 1", "0", 5),
        ("PAIR", "([1], 2)", "(f :: rest, g)", "(rest, h)", "([], g)", 7),
        ("PAIR", "([1], 2)", "(l, f)", "(l, f - 1)", "(l, 0)", 5),
    ],
)
def test_what_a_token_counts_ends_the_round(
    colset: str, start: str, taken: str, put: str, end: str, seconds: float, tmp_path: Path
) -> None:
    found = replies(tmp_path, colset, start, ROUND.format(taken=taken, put=put), end)
    assert found.late == ""
    assert f"take at most {seconds} s" in found.premise


@pytest.mark.parametrize(
    ("colset", "start", "taken", "put", "end"),
    [
        ("DIGITS", "[1, 2]", "f :: rest", "g :: rest", "[]"),
        ("DIGITS", "[1, 2]", "f :: rest", "rev (f :: rest)", "[]"),
        ("DIGITS", "[1, 2]", "l", "tl l ^^ l", "[]"),
        ("FEW", "3", "f", "g", "0"),
        ("FEW", "3", "f", "f", "0"),
        ("INT", "3", "n", "n - 1", "0"),
        ("PAIR", "([1], 2)", "(f :: rest, g)", "(f :: rest, h)", "([], g)"),
    ],
)
def test_what_counts_nothing_has_no_bound(
    colset: str, start: str, taken: str, put: str, end: str, tmp_path: Path
) -> None:
    found = replies(tmp_path, colset, start, ROUND.format(taken=taken, put=put), end)
    assert "`Again` occurs again and again without a message" in found.late


BOTH_WAYS = """    trans Down
      in Loop : f :: rest
      out Between : {down}
      code action drill ()
    trans Up
      in Between : {taken}
      out Loop : {up}
      code action drill ()
"""


@pytest.mark.parametrize(
    ("down", "taken", "up", "seconds"),
    [
        ("rest", "l", "l", 14),
        ("f :: rest", "g :: l", "l", 14),
        ("rest", "l", "1 :: l", None),
        ("f :: rest", "l", "l", None),
    ],
)
def test_rounds_of_several_places(
    down: str, taken: str, up: str, seconds: float | None, tmp_path: Path
) -> None:
    """Steps that count nothing come once between those that do."""
    steps = BOTH_WAYS.format(down=down, taken=taken, up=up)
    found = replies(tmp_path, "DIGITS", "[1, 2]", steps, "[]")
    assert ("" if seconds is None else f"take at most {seconds} s") in found.premise
    assert bool(found.late) == (seconds is None)
