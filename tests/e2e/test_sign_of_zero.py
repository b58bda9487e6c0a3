"""The two zeros are equal, but `1.0 / x` and texts tell them apart: markings that differ in the sign are two nodes."""

from __future__ import annotations

import pytest

from helpers.explored import Explorers, agrees
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc


# What holds a zero, the two inscriptions that make it, the one that takes it, and a guard that sees the sign.
HOLDERS = {
    "a real": ("REAL", "0.0", "~1.0 * 0.0", "x", "1.0 / x < 0.0"),
    "its text": ("REAL", "0.0", "~ 0.0", "x", 'Real.toString x = "~0.0"'),
    "a product": ("PAIR", "(1, 0.0)", "(1, ~0.0)", "(n, x)", "Real.signBit x"),
    "a list": ("REALS", "[0.0, 0.0]", "[0.0, ~0.0]", "[y, x]", "1.0 / x < 0.0"),
    "a union": ("EITHER", "Some 0.0", "Some ~0.0", "Some x", "1.0 / x < 0.0"),
    "a timed product": ("LATER", "(1, 0.0)", "(1, ~0.0)", "(n, x)", "1.0 / x < 0.0"),
}


def choice(holder: str) -> str:
    """Either of the two zeros comes into a place; what follows depends on its sign."""
    colset, plus, minus, taken, guard = HOLDERS[holder]
    return f"""
        net Zeros
          standard
          colset PAIR = product INT * REAL;
          colset LATER = product INT * REAL timed;
          colset REALS = list REAL;
          colset EITHER = union Some: REAL + None;
          var x, y: REAL; var n: INT;
          page Top
            place Start : UNIT = 1`()
            place Held : {colset}
            place Seen : UNIT
            trans Plus
              in Start : ()
              out Held : {plus}
            trans Minus
              in Start : ()
              out Held : {minus}
            trans See guard [{guard}]
              in Held : {taken}
              out Seen : ()
    """


@pytest.mark.parametrize("width", [0, 4])
@pytest.mark.parametrize("holder", HOLDERS)
def test_both_zeros_are_looked_at(explorers: Explorers, holder: str, width: int) -> None:
    net = flat(choice(holder))
    assert agrees(explorers, net, width=width) == "same"
    found = explorers.explore(net, width=width)
    assert (found.report["nodes"], found.report["dead_count"]) == (4, 2)
    assert found.report["fired"] == [1, 1, 1]


def test_what_is_there_first_stays(explorers: Explorers) -> None:
    """In one place both are one token, whose sign is that of the first: two orders, two markings."""
    net = flat("""
        net Order
          standard
          var x: REAL;
          page Top
            place A : UNIT = 1`()
            place B : UNIT = 1`()
            place Held : REAL
            place Seen : UNIT
            trans Plus
              in A : ()
              out Held : 0.0
            trans Minus
              in B : ()
              out Held : ~1.0 * 0.0
            trans See guard [1.0 / x < 0.0]
              in Held : x
              out Seen : ()
    """)
    assert agrees(explorers, net) == "same"
    assert explorers.explore(net).report["nodes"] == 9


def test_a_zero_in_a_reference(explorers: Explorers) -> None:
    net = flat("""
        net Kept
          standard
          globref last = 0.0;
          page Top
            place Start : UNIT = 1`()
            place Between : UNIT
            place Seen : UNIT
            trans Plus code action (last := 0.0)
              in Start : ()
              out Between : ()
            trans Minus code action (last := ~1.0 * 0.0)
              in Start : ()
              out Between : ()
            trans See guard [1.0 / !last < 0.0]
              in Between : ()
              out Seen : ()
    """)
    assert agrees(explorers, net) == "same"
    assert explorers.explore(net).report["nodes"] == 4


TIMED = {
    "a real": ("REAL", "{z}", "x"),
    "a product": ("PAIR", "(1, {z})", "(n, x)"),
    "a record": ("RECORD", "{{a = {z}, b = 1}}", "{a = x, b = n}"),
    "a list": ("REALS", "[1.5, {z}]", "[y, x]"),
    "a union": ("EITHER", "Some {z}", "Some x"),
    "what is no number": ("PAIR2", "(0.0 / 0.0, {z})", "(y, x)"),
}


@pytest.mark.parametrize(
    ("holder", "stamps"),
    [*((holder, (1, 2)) for holder in TIMED), ("a real", (2, 1)), ("a union", (1, 1))],
)
def test_zeros_of_other_stamps_keep_their_signs(
    explorers: Explorers, holder: str, stamps: tuple[int, int]
) -> None:
    """In both orders in which they are put, and taken one after the other."""
    colset, token, taken = TIMED[holder]
    first, second = stamps
    net = flat(f"""
        net Stamps
          standard
          colset PAIR = product INT * REAL timed;
          colset PAIR2 = product REAL * REAL timed;
          colset RECORD = record a: REAL * b: INT timed;
          colset REALS = list REAL timed;
          colset EITHER = union Some: REAL + None timed;
          colset REAL = real timed;
          colset TEXT = string;
          var x, y: REAL; var n: INT;
          page Top
            place A : UNIT = 1`()
            place B : UNIT = 1`()
            place Held : {colset}
            place Seen : TEXT
            trans Plus
              in A : ()
              out Held : {token.format(z="0.0")} @+ {first}
            trans Minus
              in B : ()
              out Held : {token.format(z="(~1.0 * 0.0)")} @+ {second}
            trans Take
              in Held : {taken}
              out Seen : Real.toString x
    """)
    assert agrees(explorers, net) == "same"
