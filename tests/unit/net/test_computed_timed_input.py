"""Timed multi-sets on input arcs that are computed: taken as the engine of CPN Tools was seen to take them."""

from __future__ import annotations

import pytest

from helpers.netbuilder import diagnose, flat
from pn2code.semantics.game.token_game import Game

NET = """
net Timed
  standard
  colset T = int timed;
  var k : INT;
  val w5 = 1`3@+5;
  fun three n = 1`n@+3;
  fun now n = 1`n@+0;
  fun sum n = 1`n@+0 +++ 1`(n+1)@+0;
  fun late (n, d) = 1`n@+d;
  fun down n = if n > 9 then down (n - 9) else if n > 5 then down (n - 2) else if n > 3 then down (n - 1) else 1`n@+0;
  fun even 0 = 1`3@+0 | even n = odd (n - 1) and odd 0 = empty | odd n = even (n - 1);
  fun slow 0 = 1`3@+1 | slow n = quick (n - 1) and quick 0 = empty | quick n = slow (n - 1);
  page Main
    place A : T = {initial}
    place B : T
    place K : INT = 1`3
    trans X
      {kind} A : {inscription}
      in K : k
      out B : 1`k@+1
"""
EARLY = "1`3@2+++1`4@5+++1`3@9"


@pytest.mark.parametrize(
    ("initial", "kind", "inscription", "time", "left"),
    [
        (EARLY, "in", "if k = 3 then 1`3@+0 else empty", 2, "1`3@9+++ 1`4@5"),
        (EARLY, "both", "if k = 3 then 1`3@+0 else 1`4@+0", 2, "1`3@9+++ 1`3@2+++ 1`4@5"),
        (EARLY, "in", "now k", 2, "1`3@9+++ 1`4@5"),
        (EARLY, "both", "now k", 2, "1`3@9+++ 1`3@2+++ 1`4@5"),
        (EARLY, "in", "if k = 3 then empty else 1`3@+0", 0, "1`3@9+++ 1`3@2+++ 1`4@5"),
        (EARLY, "in", "case k of 3 => 1`4@+0 | _ => empty", 5, "1`3@9+++ 1`3@2"),
        (EARLY, "in", "let val x = k in (1`x ++ 1`4)@+0 end", 5, "1`3@9"),
        (EARLY, "in", "now k +++ 1`4@+0", 5, "1`3@9"),
        (EARLY, "in", "down (k + 20)", 2, "1`3@9+++ 1`4@5"),
        (EARLY, "in", "odd k", 2, "1`3@9+++ 1`4@5"),
    ],
)
def test_what_is_taken_and_when(
    initial: str, kind: str, inscription: str, time: int, left: str
) -> None:
    game = Game(flat(NET.format(initial=initial, kind=kind, inscription=inscription)))
    if not game.enabled():
        assert game.advance()
    (one,) = game.enabled()
    game.fire(one)
    assert game.marking.time == time
    assert game.marking_text("Main.A").replace("\n", " ") == left


@pytest.mark.parametrize(
    "inscription",
    ["w5", "three k", "quick k", "if k = 3 then 1`3@+3 else empty", "sum k", "now k +++ 1`4@+3", "late (k, 2)",
     "List.map (fn x => x) (1`k@+1)",
     "if k = 3 then 1`3@+3 else 1`4@+1 +++ 1`3@+0"],
)  # fmt: skip
def test_what_is_not_told_apart(inscription: str) -> None:
    (error,) = diagnose(NET.format(initial=EARLY, kind="in", inscription=inscription)).errors
    assert error.code == "unsupported-timed-input"
