"""What a step changes can be taken back and made again, token by token, with the signs of zeros."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from helpers import netbuilder
from pn2code.play.changes import FEW, Changes, Colours, Whole, applied, weight
from pn2code.semantics.game.marking import Marking
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.data import zero_signs

MANY = """
net Many
  standard
  colset T = int timed;
  var n, m : INT;
  page Top
    place A : INT = List.tabulate (30, fn i => i)
    place B : INT
    place C : T = List.tabulate (30, fn i => i)
    place D : REAL = [0.0, ~0.0, 1.5]
    place E : T
    trans Move
      in A : n
      out B : n mod 7
      in C : m
      out E : 1`(m div 3) @+ (n mod 5)
    trans Back
      in B : n
      out A : n + 1
      both D : if n mod 2 = 0 then 1`0.0 else 1`(~0.0)
"""


@pytest.mark.parametrize("seed", range(2))
def test_a_walk_can_be_taken_back(seed: int) -> None:
    net = netbuilder.flat(MANY)
    game, changes, chance = Game(net), Changes.of(net), random.Random(seed)
    seen: list[Marking] = [game.marking]
    made = []
    for _ in range(60):
        game.advance()
        game.fire(chance.choice(game.enabled()))
        made.append(changes.between(seen[-1], game.marking))
        seen.append(game.marking)
    marking = game.marking
    for back in range(len(made) - 1, -1, -1):
        marking = applied(marking, made[back], back=True)
        assert marking.places == seen[back].places
    for i, change in enumerate(made):
        marking = applied(marking, change)
        assert marking.places == seen[i + 1].places
    kinds = {type(c) for change in made for c in change}
    assert kinds == {Whole, Colours}


def test_zeros_keep_their_signs() -> None:
    net = netbuilder.flat(MANY)
    start = Game(net).marking
    place = next(p.index for p in net.places if p.short == "D")
    places = list(start.places)
    tokens = list(places[place])
    other = type(places[place]).of([-t if t == 0.0 else t for t in tokens])  # type: ignore[arg-type, operator]
    places[place] = other
    after = Marking(start.time, tuple(places))
    made = Changes.of(net).between(start, after)
    signs = [list(zero_signs(t)) for t in applied(start, made).places[place]]
    assert signs == [list(zero_signs(t)) for t in other]


def test_a_large_place_is_not_copied(tmp_path: Path) -> None:
    net = netbuilder.flat(MANY)
    game = Game(net)
    before = game.marking
    game.fire(next(e for e in game.enabled()))
    made = Changes.of(net).between(before, game.marking)
    large = [c for c in made if isinstance(c, Colours)]
    assert large and all(len(c.rows) == 1 for c in large)
    assert len(list(before.places[large[0].place])) > FEW
    assert weight(made) < 10_000
