"""Explorers compute without tests for overflow where nothing can overflow, and with them everywhere else."""

from __future__ import annotations

import pytest

from helpers.netbuilder import flat
from pn2code.diagnostics import Diagnostics
from pn2code.verify.exploring.programs import Sizes, generated

NET = """
net Numbers
  standard
  colset K = int with 0..9;
  colset L = int with ~5..5;
  colset P = product K * L;
  colset BIG = int with 0..1073741823;
  var k : K; var l, m : L; var n : INT; var big : BIG;
  val seven = 7;
  globref r = 1;
  place A : P = 1`(3, 2)
  place B : INT = 1`12
  place C : BIG = 1`4
  place D : K
  place E : L
"""


def program(*lines: str) -> str:
    d = Diagnostics()
    net = flat(
        "\n".join([NET, "  trans T guard [n >= 0]" if "n" in lines else "  trans T", *lines])
    )
    files = generated(net, {}, Sizes.start(net, {}), d)
    assert files is not None and not d.has_errors
    (text,) = (f.text for f in files if f.path == "net.c")
    return text


@pytest.mark.parametrize(
    ("written", "place", "printed"),
    [
        ("(k + 2) mod 10", "D", "(b->k + 2) % 10"),
        ("k - 3 - ~4", "E", "b->k - 3 - -4"),
        ("(k * seven + 1) div 8", "D", "/ 8"),
        ("if k > 3 then 0 else l", "E", "b->l"),
        ("~l", "E", "-b->l"),
    ],
)
def test_what_cannot_overflow_is_computed_by_c(written: str, place: str, printed: str) -> None:
    text = program("    in A : (k, l)", f"    out {place} : {written}")
    assert printed in text
    assert "pn_int_" not in text.partition("T_fire")[2].partition("\n}")[0]


@pytest.mark.parametrize(
    ("written", "kept"),
    [
        ("l mod 10", "pn_int_mod("),  # of what is negative C has another remainder
        ("k div l", "pn_int_div("),
        ("k mod 0", "pn_int_mod("),
        ("k + !r", "pn_int_add("),
        ("k * 536870912", "pn_int_mul("),
        ("k + (k * 1000000) * 1000000", "pn_int_mul("),
    ],
)
def test_what_may_overflow_or_raise_is_tested(written: str, kept: str) -> None:
    assert kept in program("    in A : (k, l)", f"    out B : {written}")


def test_the_largest_numbers() -> None:
    assert "pn_int_add(" in program("    in C : big", "    out B : big + 1")
    assert "b->big - 1" in program("    in C : big", "    out B : big - 1")


def test_nothing_is_known_of_what_a_code_segment_gives() -> None:
    text = program("    in B : n", "    out D : k + 1").replace(" ", "")
    assert "pn_int_add(" not in text  # `k` is drawn from its colour set
    lines = ("    in B : n", "    out B : k + 1")
    d = Diagnostics()
    net = flat("\n".join([NET, "  trans T code input (n); output (k); action n", *lines]))
    files = generated(net, {}, Sizes.start(net, {}), d)
    assert files is not None and any("pn_int_add(cx, b->k, 1)" in f.text for f in files)


def test_a_search_that_looks_whether_a_value_is_of_the_colour_set_knows_nothing_of_it() -> None:
    d = Diagnostics()
    net = flat("\n".join([NET, "  trans T guard [k + 1 > 4]", "    in B : k", "    out D : k"]))
    files = generated(net, {}, Sizes.start(net, {}), d)
    assert files is not None and any("pn_int_add(cx, b.k, 1)" in f.text for f in files)


def test_a_value_within_the_colour_set_is_not_looked_at_again() -> None:
    assert (
        "check("
        not in program("    in A : (k, l)", "    out D : (k + 1) mod 10").partition("T_fire")[2]
    )
    assert "D_check(" in program("    in A : (k, l)", "    out D : k + 1").partition("T_fire")[2]
