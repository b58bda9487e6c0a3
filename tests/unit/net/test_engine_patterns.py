"""Patterns that CPN Tools binds wrongly, and tuples that it cannot search for: who is warned of them.

What its engine does was asked for each: those without a warning it runs as pn2code does.
"""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.net import engine_search
from pn2code.semantics.game.token_game import Game

NET = """
net Patterns
  standard
  colset P = product INT * INT;
  colset T3 = product INT * INT * INT;
  colset PP = product P * INT;
  colset R = record a : INT * b : INT;
  colset U = union Ua : INT + Ub : P;
  colset L = list INT;
  colset LP = list P;
  colset PL = product INT * L;
  colset TP = product INT * INT timed;
  colset SMALL = int with 1..3;
  colset S2 = product SMALL * SMALL;
  colset MODE = with active | passive;
  colset NODE = product INT * MODE;
  var i, j, k, n : INT;
  var l, m : L;
  var lp : LP;
  var p, q : P;
  var r : R;
  var z, w : SMALL;
  val one = 1;
  fun f n = n + 1;
  page Top
    place A : {colset}
    place J : INT = 1`1
    place K : INT = 1`1
    place N : NODE
    place P1 : P
    trans T guard [{guard}]
      in A : {pattern}
"""
J, K, JK = "      in J : j\n", "      in K : k\n", "      in J : j\n      in K : k\n"
FROM_P = "      in P1 : p\n"


def codes(colset: str, pattern: str, guard: str = "", more: str = "") -> list[str]:
    """The codes of what is said."""
    text = NET.format(colset=colset, pattern=pattern, guard=guard or "true") + more
    return [x.code for x in diagnose(text).items]


@pytest.mark.parametrize(
    ("colset", "pattern", "guard", "more"),
    [
        ("P", "(i, i)", "", ""),
        ("P", "1`(i, i)", "", ""),
        ("P", "2`(i, i)", "", ""),
        ("P", "(i, i)", "i = j", J),
        ("P", "(i, i)", "", "      in J : i\n"),
        ("R", "{a = i, b = i}", "", ""),
        ("T3", "(i, j, i)", "", ""),
        ("T3", "(i, j, i)", "i = 2", ""),
        ("U", "Ub (i, i)", "", ""),
        ("L", "[i, i]", "", ""),
        ("L", "i :: i :: l", "i = 2", ""),
        ("PP", "((i, j), i)", "", ""),
        ("PL", "(i, i :: l)", "", ""),
        ("LP", "(i, i) :: lp", "", ""),
        ("TP", "(i, i) @+ 1", "", ""),
        ("S2", "(z, z)", "", ""),
        ("P", "p", "p = (i, i)", ""),
        ("P", "p", "(i, i) = p", "      in J : i\n"),
        ("P", "(j, k)", "(i, i) = (j, k)", ""),
        ("L", "m", "i :: i :: l = m", ""),
        ("R", "r", "{a = i, b = i} = r", ""),
        ("P", "p", "q = (i, i), q = p", "      in J : i\n"),
    ],
)
def test_a_variable_is_twice(colset: str, pattern: str, guard: str, more: str) -> None:
    """It may take a token whose parts differ, or think that the guard holds."""
    assert codes(colset, pattern, guard, more) == ["pattern-repeats"]


@pytest.mark.parametrize(
    ("colset", "pattern", "guard", "more"),
    [
        ("P", "(i, i)", "i = 2", ""),  # the whole token is known before
        ("P", "(i, i)", "i = f j", J),
        ("L", "[i, i]", "i = 2", ""),
        ("U", "Ub (i, i)", "i = 2", ""),
        ("P", "1`(i, j) ++ 1`(j, i)", "", ""),
        ("P", "1`(i, i) ++ 1`p", "", ""),  # a sum is tested as it is written
        ("P", "k`(i, i)", "", "      in J : i\n      in K : k\n"),
        (
            "NODE",
            "(i, active)",
            "",
            "      in P1 : (i, i)\n",
        ),  # i is found by `active`, then the pair
        ("INT", "i", "p = (i, i)", "      out P1 : p\n"),
        ("P", "p", "p = (i, i), i = 2", ""),
        ("P", "p", "not (p = (i, i))", "      in J : i\n"),
        ("P", "p", "p = (i, i) andalso true", "      in J : i\n"),
        ("P", "p", "case p of (1, n) => true | _ => false", ""),
    ],
)
def test_a_variable_is_twice_and_compared(colset: str, pattern: str, guard: str, more: str) -> None:
    assert "pattern-repeats" not in codes(colset, pattern, guard, more)


@pytest.mark.parametrize(
    ("colset", "pattern", "guard", "more"),
    [
        ("P", "(j + 1, k)", "", JK),
        ("P", "(j, j + 1)", "", J),
        ("P", "(j, 1 + 1)", "", J),
        ("P", "(f j, 2)", "", J),
        ("P", "2`(j + 1, k)", "", JK),
        ("P", "(j + 1, k)", "j = 1", K),
        ("P", "1`(j + 1, k) ++ 1`(3, 3)", "", JK),
        ("P", "(#1 p, #2 p)", "", FROM_P),
        ("R", "{a = j + 1, b = 1}", "", J),
        ("T3", "(j + 1, k, 3)", "", JK),
        ("PP", "((j + 1, k), j)", "", JK),
        ("PL", "(j, [j + 0])", "", J),
        ("TP", "(j + 1, k)", "", JK),
        ("S2", "(z, z + 1)", "", ""),
        ("T3", "(one, i, one)", "", ""),  # a constant is a variable in its pattern, and there twice
        ("T3", "1`(one, one, 2) ++ 1`(one, i, one)", "", ""),
        ("PP", "((one, i), one)", "", ""),
    ],
)
def test_a_component_is_computed(colset: str, pattern: str, guard: str, more: str) -> None:
    """It looks for the token by another component, and cannot compile that."""
    assert codes(colset, pattern, guard, more) == ["engine-code"]


@pytest.mark.parametrize(
    ("colset", "pattern", "guard", "more"),
    [
        ("P", "(j + 1, k)", "j = 1, k = 1", ""),  # the whole token is known before
        ("P", "(j + 1, k)", "j = f n, k = n", "      in J : n\n"),
        ("P", "j`(j + 1, k)", "", JK),
        ("P", "(1, 1 + 1)", "", ""),
        ("P", "1`(1, 1 + 1) ++ 1`(i, 2)", "", ""),
        ("P", "if j = 1 then 1`(j + 1, k) else empty", "", JK),
        ("P", "(i, one)", "", ""),
        ("P", "((i), (2))", "", ""),
        ("L", "[j, k + 1]", "", JK),
        ("U", "Ub (j, j + 1)", "", J),
        ("LP", "[(j + 1, k)]", "", JK),
    ],
)
def test_a_component_is_computed_and_not_searched_for(
    colset: str, pattern: str, guard: str, more: str
) -> None:
    assert codes(colset, pattern, guard, more) == []


def test_of_several_orders_it_is_not_known_which_is_taken() -> None:
    """One that costs as much looks for no token by a part: the engine took that one."""
    text = NET.format(colset="P", pattern="(j, i)", guard="true")
    text += "      in A : 2`(f i, j) ++ 1`(k, 1)\n      in A : (k, i)\n"
    (found,) = (x for x in diagnose(text).items if x.code == "engine-code")
    assert "may be unable to compile" in found.message
    (found,) = diagnose(NET.format(colset="P", pattern="(j + 1, k)", guard="true") + JK).items
    assert "cannot compile" in found.message


def test_computed_parts_of_a_single_arc_bind_nothing() -> None:
    """Nothing is known before: the engine finds no order, although all values could be tried."""
    assert codes("S2", "(z + 1, w)") == ["binding-circle"]


def test_what_cannot_be_found_out_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engine_search, "MOST", 2)
    both = "      in P1 : (i, i)\n"
    assert codes("NODE", "(i, active)", "", both) == ["pattern-repeats"]


def test_here_the_parts_are_equal() -> None:
    text = NET.format(colset="P = 1`(1, 2) ++ 1`(2, 2)", pattern="(i, i)", guard="true")
    (found,) = Game(flat(text)).enabled()
    assert "2" in str(found)
