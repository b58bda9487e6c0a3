"""Type variables written in an inscription stand for any type, as in the engine of CPN Tools."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose

NET = """
net Variables
  standard
  colset INTT = int timed;
  colset L = list INT;
  var x, y : INT;
  page Top
    place A : INT = {initial}
    place B : INTT
    place C : L = {lists}
    trans T guard [{guard}] delay @+{delay} code input (x); output (y); action {action};
      in A : {inward}
      out B : {value}
"""
GOOD = {
    "initial": "1`0", "lists": "1`[1]", "guard": "true", "action": "x", "delay": "1", "inward": "x", "value": "x",
}  # fmt: skip
SAME = "(fn (b : 'a) => b)"


@pytest.mark.parametrize(
    ("part", "text", "code"),
    [
        ("initial", "3 : 'a", "type-variable"),
        ("initial", "(if true then 3 else raise Empty : 'a)", "type-variable"),
        ("lists", "1`([] : 'a list)", "type-variable"),
        ("guard", f"{SAME} true", "type-variable"),
        ("guard", "([] : 'a list) = []", "not-an-equality-type"),
        ("action", f"{SAME} x", "type-variable"),
        ("delay", f"({SAME} 3)", "type-variable"),
        ("inward", "(x : 'a)", "type-variable"),
        ("value", f"{SAME} x", "type-variable"),
        ("value", f"x@+({SAME} 3)", "type-variable"),
        ("initial", "1`(length ([] : 'a list))", ""),
        ("lists", "1`(let fun f (x : 'a) = [x] in f 3 end)", ""),
        ("guard", "length ([] : 'a list) = 0", ""),
        ("guard", "([] : ''a list) = []", ""),
        ("action", "let val f = fn (b : 'a) => b in f x end", ""),
    ],
)
def test_a_type_variable_is_no_certain_type(part: str, text: str, code: str) -> None:
    found = diagnose(NET.format(**(GOOD | {part: text})))
    assert [e.code for e in found.errors] == ([code] if code else [])
