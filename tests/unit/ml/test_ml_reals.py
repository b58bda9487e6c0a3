"""Which types may have reals in their values."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.ml.core.reals import may_hold_reals
from pn2code.ml.core.types import INT, REAL, TFun, TVar

NET = """
    net Types
      colset UNIT = unit;
      colset INT = int;
      colset BOOL = bool;
      colset REAL = real;
      colset WORD = with left | right;
      colset SPEED = union slow + exactly : REAL;
      colset COUNT = union none + number : INT;
      colset INTS = list INT;
      colset SPEEDS = list SPEED;
      colset PAIR = product INT * SPEED;
      colset RECORD = record a : INT * b : INTS;
      colset FEW = subset INTS with [[1], [2]];
      place P : COLSET
"""


@pytest.mark.parametrize(
    ("colset", "expected"),
    [
        ("UNIT", False),
        ("INT", False),
        ("BOOL", False),
        ("REAL", True),
        ("WORD", False),
        ("SPEED", True),
        ("COUNT", False),
        ("INTS", False),
        ("SPEEDS", True),
        ("PAIR", True),
        ("RECORD", False),
        ("FEW", False),
    ],
)
def test_colour_sets(colset: str, expected: bool) -> None:
    net = flat(NET.replace("COLSET", colset))
    assert may_hold_reals(net.places[0].colset.type, net.program.datatypes) is expected


DECLARED = """
    net Types
      datatype 'a tree = leaf | node of 'a tree * 'a * 'a tree;
      datatype shape = point | circle of real | group of shape list;
      datatype colour = red | mixed of colour * colour;
      val whole = node (leaf, 1, leaf);
      val broken = node (leaf, 1.0, leaf);
      val shapes = [point];
      val colours = SOME red;
"""


@pytest.mark.parametrize(
    ("name", "expected"),
    [("whole", False), ("broken", True), ("shapes", True), ("colours", False)],
)
def test_data_types(name: str, expected: bool) -> None:
    program = flat(DECLARED).program
    found = program.globals[name]
    assert may_hold_reals(found.type, program.datatypes) is expected


def test_what_is_not_known_may() -> None:
    assert may_hold_reals(TVar(0), {}) and may_hold_reals(TFun(INT, INT), {})
    assert may_hold_reals(REAL, {}) and not may_hold_reals(INT, {})
