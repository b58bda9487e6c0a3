"""How large integers may become, and which arithmetic may raise an Overflow."""

from __future__ import annotations

from dataclasses import replace

import pytest

from helpers.netbuilder import flat
from pn2code.net.flat import FlatNet
from pn2code.net.guard_order import unsure
from pn2code.net.magnitudes import ANY, Magnitudes, of_json

NET = """
net N
  standard
  colset S = int with 0..9;
  colset I = index i with 1..1000;
  colset H = int with 0..32768;
  colset L = list S;
  colset P = product INT * S;
  var n, m, k : INT;
  var s, t : S;
  var h : H;
  var j : I;
  var l : L;
  val base = 7;
  val hidden = ref 5;
  fun twice x = x + x;
  fun high (a, b) = twice a * b;
  fun sum nil = 0 | sum (x :: r) = x + sum r;
  fun down x = if x < 1 then 0 else down (x - 1);
  fun apply f x = f x;
  page Q
    place A : INT = 1`5
    place B : INT = 1`1073741823
    place C : INT = 1`1
    place D : S = 1`1
    place E : H = 1`32768
    place F : L = 1`[1]
    place G : I = 1`i(3)
    place O : INT
    trans Count
      guard [n < 20]
      in C : n
      out C : n + 1
    trans T
      guard [k > 3, %s]
      in A : n
      in B : m
      in C : k
      in D : s
      in E : h
      in F : l
      in G : j
      out O : 1
"""


def overflows(guard: str, measured: list[float] | None = None) -> bool:
    net: FlatNet = flat(NET % guard)
    t = net.transitions[1]
    return Magnitudes(net, measured).raising(t).raise_in(t.guards[1])


@pytest.mark.parametrize(
    "guard",
    [
        "n + 1 > 0",
        "n * n - base > 0",
        "m mod 5 + 1 > 0",
        "m div 2 + 1 > 0",
        "m + 0 > 0",
        "s * s * s > 0",
        "h * 32767 > 0",
        "twice (twice n) > 0",
        "high (n, n) > 0",
        "length l + length l > 0",
        "List.all (fn x => x + 1 > 0) l",
        "apply (fn x => x + 1) n > 0",
        "apply twice s > 0",
        "List.length (List.map (fn x => x * x) l) > 0",
        "(case l of x :: _ => x + 1 | nil => 0) > 0",
        "(let val y = n + 1 in y + y end) > 0",
    ],
)
def test_what_cannot_overflow(guard: str) -> None:
    assert not overflows(guard)


@pytest.mark.parametrize(
    "guard",
    [
        "m + m > 0",
        "m + 1 > 0",
        "~m - 2 > 0",
        "m * 2 > 0",
        "h * h > 0",
        "twice m > 0",
        "high (n, m) > 0",
        "k + 1 > 0",
        "~(m - n - m) > 0 andalso abs (m + n) > 0",
        "!hidden + 1 > 0",
        "sum l > 0",
        "down n = 0",
        "length l * 5 > 0",
        "apply twice m > 0",
        "List.exists (fn x => x + m > 0) l",
        "foldl op + 0 l > 0",
        "(case m of 0 => 0 | x => x + 1) > 0",
        "(let fun f x = x + 1 in f m end) > 0",
        "IntInf.toInt (IntInf.fromInt m * IntInf.fromInt m) > 0",
        'Int.fromString "99999999999" = NONE',
    ],
)
def test_what_may_overflow(guard: str) -> None:
    assert overflows(guard)


def test_markings_bound_what_the_colour_set_does_not() -> None:
    assert overflows("k + 1 > 0")
    assert not overflows("k + 1 > 0", [5, ANY, 20, ANY, ANY, ANY, ANY, ANY])
    assert overflows("k + m > 0", [5, ANY, 20, ANY, ANY, ANY, ANY, ANY])
    assert not overflows("k + m > 0", [5, 7, 20, ANY, ANY, ANY, ANY, ANY])


def test_equations_give_values_beyond_the_colour_set() -> None:
    """CPN Tools does not look whether `t` is one of its colour set then."""
    net = flat(NET % "t = m, t + 1 > 0, k > 5")
    asked = Magnitudes(net).raising(net.transitions[1])
    assert any(map(asked.raise_in, net.transitions[1].guards))
    net = flat(NET % "t = s, t + 1 > 0, k > 5")
    asked = Magnitudes(net).raising(net.transitions[1])
    assert not any(map(asked.raise_in, net.transitions[1].guards))


def test_a_warning_is_for_other_exceptions() -> None:
    net = flat(NET % "n > 9, m + m > 0")
    assert not unsure(net)
    (found,) = unsure(net, Magnitudes(net))
    assert found.raises.span.text == "m + m > 0"


def test_integers_have_the_bits_of_the_program() -> None:
    net = flat(NET % "n > 9, m + m > 0")
    wide = replace(net, program=replace(net.program, int_bits=64))
    assert unsure(net, Magnitudes(net)) and not unsure(wide, Magnitudes(wide))


def test_integers_of_json() -> None:
    assert of_json([["a", -7], {"x": 3, "y": None}, True, "999"]) == 7
