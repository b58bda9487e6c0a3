"""Lists on a robot's page: what the script has for them, what it asks of them, and what it cannot have."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from helpers.robots import Cell, replayed
from pn2code.tdl.requests import Fault

EXTRA = """
colset SMALL = int with 0..9;
colset NUMBERS = list INT;
colset SHORT = list INT with 0..2;
colset DIGITS = list SMALL with 0..3;
colset FLAGS = list BOOL with 0..2;
var l, rest : NUMBERS;
var few, fewer : SHORT;
var d : SMALL;
var digits, others : DIGITS;
var seen : FLAGS;
"""


def cell(folder: Path, page: str, channels: tuple[str, ...] = (), toml: str = "") -> Cell:
    # The other side of channels of lists calls its variable so.
    own = next((c.split()[2] for c in channels if c.split()[2] != "INT"), "INT")
    return Cell(folder, page, channels, extra=f"{EXTRA}var x : {own};\n", toml=toml)


def test_a_list_is_gone_along(tmp_path: Path) -> None:
    page = """
    place Idle = 1
    place Todo : NUMBERS
    trans Accept
      in Idle
      in x : l
      out Todo : l
    trans Next
      in Todo : n :: rest
      out Todo : rest
      out y : n
    trans Over
      in Todo : []
      out Idle
    """
    found = cell(tmp_path, page, ("x in NUMBERS", "y out INT"))
    assert found.messages == [] and found.ir is not None
    assert 'input  x "x.robcad" : ints' in found.text
    assert "while count_of(todo) <> 0 loop" in found.body
    assert "write y first_of(todo) todo := rest_of(todo)" in " ".join(found.body.split())
    assert "compute" not in found.body, "the pattern has seen that there is an item"


@pytest.mark.parametrize(
    ("guard", "put", "expected"),
    [
        ("", "hd l", "compute first_of(l)"),
        (" guard [l <> []]", "hd l", ""),
        (" guard [length l > 1]", "hd (tl l)", "compute first_of(rest_of(l))"),
        (" guard [length l > 2]", "List.nth (l, 2)", ""),
        ("", "length l", ""),
    ],
)  # fmt: skip
def test_what_may_not_be_there_is_computed_beforehand(
    tmp_path: Path, guard: str, put: str, expected: str
) -> None:
    page = f"""
    place Idle = 1
    place Held : NUMBERS
    trans Accept
      in Idle
      in x : l
      out Held : l
    trans Go{guard}
      in Held : l
      out y : {put}
      out Idle
    """
    found = cell(tmp_path, page, ("x in NUMBERS", "y out INT"))
    assert found.ir is not None, found.messages
    assert (expected in found.body) if expected else ("compute" not in found.body)


def test_how_long_a_list_may_be_is_asked(tmp_path: Path) -> None:
    page = """
    place Held : SHORT = 1`[]
    place Other : SHORT
    trans Longer
      in x : n
      in Held : few
      out Other : n :: few
    trans Shorter
      in Other : n :: fewer
      out Held : fewer
    """
    found = cell(tmp_path, page, ("x in INT",))
    assert found.ir is not None, found.messages
    stop = "if not count_of(with_first(few, n)) <= 2 then stop"
    assert " ".join(found.body.split()).count(stop) == 1, found.body


def test_items_that_are_in_their_colour_set(tmp_path: Path) -> None:
    page = """
    place Held : DIGITS = 1`[]
    trans Turn
      in x : digits
      in Held : others
      out Held : if length digits > 1 then tl digits else rev digits
    """
    assert cell(tmp_path, page, ("x in DIGITS",)).ir is not None
    page = page.replace("if length digits > 1 then tl digits else rev digits", "digits ^^ others")
    found = cell(tmp_path, page, ("x in DIGITS",))
    assert found.ir is not None, found.messages
    asked = "if not count_of(joined(digits, others)) <= 3 then stop"
    assert asked in " ".join(found.body.split()), found.body


@pytest.mark.parametrize(
    ("put", "asked"),
    [
        ("digits ^^ [n]", "n >= 0 and n <= 9 and count_of(joined(digits, ints(n))) <= 3"),
        ("rev (d :: digits)", "count_of(reversed(with_first(digits, d))) <= 3"),
        (
            "(if a then n :: digits else digits)",
            "(not a or n >= 0 and n <= 9) and count_of(if a then with_first(digits, n) else digits) <= 3",
        ),
        (
            "(if n < 10 then digits ^^ [n] else [])",
            "(not n < 10 or n >= 0) and count_of(if n < 10 then joined(digits, ints(n)) else ints()) <= 3",
        ),
        ("(if n < 10 andalso n >= 0 then [n] else [d])", ""),
        ("(if a then tl digits else rev digits)", ""),
    ],
)  # fmt: skip
def test_lists_that_are_joined_or_chosen(tmp_path: Path, put: str, asked: str) -> None:
    """Beside another value, so that the script has the choice in the expression."""
    page = f"""
    place Held : BOTH = 1`([], 0)
    place Last : SMALL = 1`0
    trans Next
      in x : n
      in z : a
      in Held : (digits, k)
      in Last : d
      out Held : ({put}, k + 1)
      out Last : d
    """
    extra = f"{EXTRA}colset BOTH = product DIGITS * INT;\nvar x : INT;\nvar z : BOOL;\n"
    found = Cell(tmp_path, page, ("x in INT", "z in BOOL"), extra=extra)
    assert found.ir is not None, found.messages
    body = " ".join(found.body.split())
    for whole, own in (("held_1", "digits"), ("last", "d"), ("z", "a")):
        body = re.sub(rf"\b{whole}\b", own, body)
    if asked:
        assert f"if not ({asked}) then stop" in body or f"if not {asked} then stop" in body, body
    else:
        assert "then stop" not in body, body


@pytest.mark.parametrize("put", ["digits ^^ l", "(if a then digits else l)", "l ^^ [d]"])
def test_lists_with_items_of_others_are_refused(tmp_path: Path, put: str) -> None:
    page = f"""
    place Held : DIGITS = 1`[]
    place Last : SMALL = 1`0
    trans Next
      in x : l
      in z : a
      in Held : digits
      both Last : d
      out Held : rev ({put})
    """
    extra = f"{EXTRA}var x : NUMBERS;\nvar z : BOOL;\n"
    found = Cell(tmp_path, page, ("x in NUMBERS", "z in BOOL"), extra=extra)
    assert found.ir is None
    assert "a script cannot ask whether a value is in it" in found.messages[0]
    assert "`if c then item :: l else l`" in found.messages[0]


def test_a_list_that_a_choice_makes_is_what_the_net_makes(tmp_path: Path) -> None:
    page = """
    place Idle = 1
    place Scan : BOTH = 1`([], 0)
    trans Look
      both Idle
      in x : n
      in Scan : (digits, k)
      out Scan : (if n > 4 then digits ^^ [n] else digits, k + n)
      out y : length digits
    """
    extra = f"{EXTRA}colset BOTH = product DIGITS * INT;\nvar x : INT;\n"
    found = Cell(tmp_path, page, ("x in INT", "y out INT"), extra=extra)
    result = replayed(found, [("x", (n,)) for n in (5, 1, 7, 12)])
    assert result.ok, result
    assert isinstance(found.end, Fault), "12 is no digit"
    assert found.end.message.startswith("Look: colour set BOTH of place Scan")


@pytest.mark.parametrize(
    ("put", "asked"),
    [
        ("n :: few", "n >= 0 and n <= 9 and count_of(with_first(few, n)) <= 3"),
        (
            "n + 1 :: 3 :: few",
            "n + 1 >= 0 and n + 1 <= 9 and count_of(with_first(with_first(few, 3), n + 1)) <= 3",
        ),
        ("[n]", "n >= 0 and n <= 9"),
        ("[d, n, d]", "n >= 0 and n <= 9"),
        ("[d, d]", ""),
        ("10 :: few", "10 <= 9 and count_of(with_first(few, 10)) <= 3"),
    ],
)
def test_items_that_are_written_are_asked_one_by_one(tmp_path: Path, put: str, asked: str) -> None:
    page = f"""
    place Held : DIGITS = 1`[]
    place Last : SMALL = 1`0
    trans Next
      in x : n
      in Held : few
      in Last : d
      out Held : {put}
      out Last : d
    """.replace("few", "digits")
    found = cell(tmp_path, page, ("x in INT",))
    assert found.ir is not None, found.messages
    body = " ".join(found.body.split())
    asked = asked.replace("few", "digits")
    if not asked:
        assert "stop" not in body
        return
    assert f"if not ({asked}) then stop" in body or f"if not {asked} then stop" in body, body


def test_items_of_others_stay_unknown(tmp_path: Path) -> None:
    """A list of any numbers, behind an item that can be asked."""
    page = """
    place Held : DIGITS = 1`[]
    trans Next
      in x : l
      in Held : digits
      out Held : 1 :: l
    """
    found = cell(tmp_path, page, ("x in NUMBERS",))
    assert found.ir is None
    assert "a script cannot ask whether a value is in it" in found.messages[0]


def test_a_list_is_no_value_of_a_sensor(tmp_path: Path) -> None:
    page = """
    place Idle = 1
    trans Look
      both Idle
      out y : seen
    """
    found = cell(tmp_path, page, ("y out FLAGS",), '[sensors.eye]\nvariable = "seen"\n')
    assert found.ir is None
    assert "a sensor gives one number, truth value or text" in found.messages[0]
