"""Tokens for places that nobody reads: a script leaves out what it cannot compute, where nothing can go wrong there."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.robots import Cell

EXTRA = """
  colset SMALL = int with 0..3;
  colset INTS = list INT;
  colset SMALLS = list SMALL;
  colset PAIR = product SMALL * SMALLS;
  colset PAIRS = list PAIR;
  colset KIND = with left | right;
  exception Odd;
  var small : SMALL;  var kind : KIND;  var ints : INTS;
  fun told n = "part " ^ Int.toString n;
  fun odd n = if n mod 2 = 0 then n else raise Odd;
  fun named k = case k of left => "l" | right => "r";
"""
PAGE = """
    place Idle = 1
    place Log : {colset}
    trans Go
      both Idle
      in x : {taken}
      out Log : {put}
      out y : 1
"""
LEFT_OUT = {
    "a text": ("STRING", "small", "told small"),
    "a list": ("PAIRS", "small", "[(small, [small]), (small, [])]"),
    "a list of a colour set": ("SMALLS", "small", "[small, 2, small]"),
    "a part": ("PAIR", "small", "(small, [small])"),
    "an alternative": ("SMALLS", "small", "if small > 1 then [small] else []"),
    "all constructors": ("STRING", "kind", "named kind"),
}
REFUSED = {
    "head of a list": ("INT", "small", "hd (List.tabulate (small, fn u => u))"),
    "an exception": ("INT", "small", "odd small"),
    "a sum that is too large": ("PAIRS", "k", "[(if k + 1 > 0 then 1 else 0, [])]"),
    "not in the colour set": ("SMALLS", "small", "List.map (fn u => u + 1) [small]"),
    "a list that grows": ("SMALLS", "small", "small :: List.tabulate (2, fn u => u)"),
}


COMPUTED = {
    "a list": ("INTS", "small", "[small, small + 1]", "compute small + 1"),
    "a sum that may be too large": ("INTS", "k", "[k + 1]", "compute k + 1"),
    "an item that may be too large": ("SMALLS", "small", "[small + 1]", "if not small + 1 <= "),
    "the head of a list": ("INT", "k", "hd (if k > 0 then [k] else [])", "compute first_of("),
}
"""Lists that scripts have."""


@pytest.mark.parametrize("what", COMPUTED)
def test_lists_that_scripts_have_are_computed(what: str, tmp_path: Path) -> None:
    colset, taken, put, expected = COMPUTED[what]
    place = {"small": "SMALL", "k": "INT"}[taken]
    page = PAGE.format(colset=colset, taken=taken, put=put)
    cell = Cell(
        tmp_path, page, (f"x in {place}", "y out INT"), extra=f"{EXTRA}  var x : {place};\n"
    )
    assert cell.messages == [] and expected in cell.body


@pytest.mark.parametrize("what", LEFT_OUT)
def test_what_surely_has_a_value_is_left_out(what: str, tmp_path: Path) -> None:
    colset, taken, put = LEFT_OUT[what]
    place = {"small": "SMALL", "kind": "KIND"}[taken]
    page = PAGE.format(colset=colset, taken=taken, put=put)
    cell = Cell(
        tmp_path, page, (f"x in {place}", "y out INT"), extra=f"{EXTRA}  var x : {place};\n"
    )
    assert cell.messages == []
    assert "compute" not in cell.body and "stop" not in cell.body


@pytest.mark.parametrize("what", REFUSED)
def test_what_may_raise_an_exception_is_refused(what: str, tmp_path: Path) -> None:
    """The transition does not occur in the net then; the script went on."""
    colset, taken, put = REFUSED[what]
    place = {"small": "SMALL", "k": "INT"}[taken]
    page = PAGE.format(colset=colset, taken=taken, put=put)
    cell = Cell(
        tmp_path, page, (f"x in {place}", "y out INT"), extra=f"{EXTRA}  var x : {place};\n"
    )
    (message,) = cell.messages
    assert "error[unsupported-robot-" in message
    assert (
        "Nobody reads place `Log`, but where the net raises an exception the script would go on"
        in message
    )
