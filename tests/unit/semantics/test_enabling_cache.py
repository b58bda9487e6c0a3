"""What is remembered of enabling is what would be found again."""

from __future__ import annotations

import contextlib
from random import Random

import pytest

from helpers.netbuilder import flat
from helpers.random_nets import random_net
from pn2code.semantics.game.demands import Demands
from pn2code.semantics.game.enabling import Enabling
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game, GameError

SURROUNDINGS = """
    net Surroundings
      standard
      globref limit = 1;
      colset INTT = int timed;
      colset DIE = int with 1..6;
      fun low n = n <= !limit
      colset LOW = subset INT by low;
      var n: INT; var l: LOW; var t: INTT; var d: DIE;
      page Top
        place A : INT = 1`1 ++ 1`2 ++ 1`3
        place B : INTT = 1`1@0 +++ 1`2@3
        place C : INT
        place Stop : INT = 1`1
        trans Raise guard [n <= 3] code action (limit := !limit + 1)
          in C : n
        trans Feed guard [IntInf.toInt (step ()) < 4]
          both A : n
          out C : n
        trans Guard guard [low n]
          both A : n
        trans Subset
          both A : l
        trans Counted guard [IntInf.toInt (step ()) mod 2 = n mod 2]
          both A : n
        trans Drawn guard [discrete (0, 1) = 1]
          both A : n
        trans Time guard [IntInf.toInt (time ()) > n]
          both A : n
        trans Later
          in B : t
          out B : t @+ 2
        trans Free
          in Stop : n
          inhibit C :
"""


def walk(net: str, seed: int, steps: int) -> int:
    """Steps of a random run, before each of which memory and search must agree."""
    game = Game(flat(net), seed=seed)
    r = Random(seed)
    for step in range(steps):
        game.marking = game.advance_time(game.marking)
        found = game.enabled()
        search = Enabling(game.net, game.evaluator)
        best = min((game.net.transitions[e.transition].priority for e in found), default=None)
        again = [
            BindingElement.make(t, binding)
            for t in sorted(game.net.transitions, key=lambda t: t.priority)
            if best is None or t.priority <= best
            for binding in search.enabled(t, game.marking)
        ]
        assert found == again, f"step {step}"
        numbers = [t.index for t in game.enabled_transitions(game.marking)]
        assert numbers == list(dict.fromkeys(e.transition for e in again)), f"step {step}"
        if not found:
            return step
        game.fire(r.choice(found), checked=False)
    return steps


@pytest.mark.parametrize("seed", range(4))
def test_references_steps_time_and_chance_are_not_remembered(seed: int) -> None:
    assert walk(SURROUNDINGS, seed, 40) == 40


@pytest.mark.parametrize("seed", range(20))
def test_random_nets(seed: int) -> None:
    with contextlib.suppress(GameError):  # of the net
        walk(random_net(Random(seed)), seed, 15)


def test_a_membership_test_of_a_subset_that_raises_is_an_error_of_the_net() -> None:
    net = flat("""
        net Odd
          standard
          fun odd n = n mod 0 = 1;
          colset ODD = subset INT by odd;
          var k : ODD;
          page Top
            place A : INT = 1`3
            trans T
              in A : k
        """)
    with pytest.raises(GameError, match="the colour set of `k` raised the exception `Div`"):
        Game(net).enabled()


def test_a_full_place_is_not_copied_for_each_binding(monkeypatch: pytest.MonkeyPatch) -> None:
    """Among 10,000 tokens a step took ten times as long: with each of the bindings the place was copied."""
    net = """
        net Full
          standard
          var n, m : INT;
          page Top
            place A : INT = List.tabulate (50, fn i => i)
            place B : INT = 1`1 ++ 2`7
            trans T guard [m = n]
              in A : n
              in A : m + 1
              in B : 7
    """
    game = Game(flat(net), seed=1)
    found = len(game.enabled())
    monkeypatch.delattr(Demands, "take")
    assert found == len(Game(flat(net), seed=1).enabled()) > 0
