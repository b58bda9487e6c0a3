"""The state space around a marking, and the way to a dead one."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.played import marking, of, session
from helpers.shown import PAIR
from pn2code.play import nearby
from pn2code.play.trouble import Trouble
from pn2code.semantics.game.graph import state_space
from pn2code.semantics.game.token_game import Game


def test_the_whole_of_a_small_space(root: Path, tmp_path: Path) -> None:
    game = of(root / "examples/philosophers/philosophers.cpn", tmp_path)
    whole = state_space(Game(game.net))
    found = nearby.around(game, 50, 400)
    assert found.why == ""
    assert [n.marking for n in found.nodes] == list(whole.nodes)
    assert {(a.source, a.element, a.target) for a in found.arcs} == {
        (a.source, a.element, a.target) for a in whole.arcs
    }
    assert [i for i, n in enumerate(found.nodes) if n.is_dead] == list(whole.dead)


def test_limits_are_told(root: Path, tmp_path: Path) -> None:
    game = of(root / "examples/philosophers/philosophers.cpn", tmp_path)
    near = nearby.around(game, 1, 400)
    assert near.why == "depth" and {n.depth for n in near.nodes} == {0, 1}
    assert all(n.is_open for n in near.nodes[1:]) and not near.nodes[0].is_open
    few = nearby.around(game, 50, 5)
    assert few.why == "nodes" and len(few.nodes) == 5


def test_each_node_can_be_visited(root: Path, tmp_path: Path) -> None:
    game = of(root / "examples/philosophers/philosophers.cpn", tmp_path)
    game.step()
    here = game.history.position
    found = nearby.around(game, 4, 60)
    for number in (3, len(found.nodes) - 1):
        nearby.follow(game, nearby.path(found, number))
        assert game.game.marking == found.nodes[number].marking
        assert game.history.position == here + found.nodes[number].depth
        game.go(here)


def test_the_shortest_way_to_a_dead_marking(root: Path, tmp_path: Path) -> None:
    game = of(root / "examples/philosophers/philosophers.cpn", tmp_path)
    way = nearby.to_dead(game, 10_000, lambda n, t: None)
    assert len(way) == 3
    nearby.follow(game, way)
    assert not game.game.enabled()


def test_no_dead_marking_is_told(tmp_path: Path) -> None:
    game = session(tmp_path, PAIR.replace("out Out : n + 1", "out Out : (n + 1) mod 3"))
    with pytest.raises(Trouble, match=r"no dead marking can be reached: all \d+ markings"):
        nearby.to_dead(game, 10_000, lambda n, t: None)
    with pytest.raises(Trouble, match="among the nearest"):
        nearby.to_dead(game, 2, lambda n, t: None)
    assert game.history.length == 0 and marking(game)["Top.A"] == "1`1++\n1`2"


RAISES = """
net Raises
  standard
  var n : INT;
  page Top
    place A : INT = 1`0
    place B : INT
    trans Up guard [n < 4]
      in A : n
      out A : n + 1
    trans Bad
      in A : n
      out B : 10 div (3 - n)
"""


def test_an_exception_somewhere_does_not_hide_the_rest(tmp_path: Path) -> None:
    game = session(tmp_path, RAISES)
    found = nearby.around(game, 9, 400)
    failed = [n for n in found.nodes if n.failure]
    assert len(failed) == 1 and "Div" in failed[0].failure and failed[0].depth == 3
    assert len(found.nodes) == 9 and sum(n.is_dead for n in found.nodes) == 4
    assert not failed[0].is_dead


def test_a_marking_in_which_the_net_cannot_go_on_is_not_called_dead(tmp_path: Path) -> None:
    game = session(
        tmp_path,
        RAISES.replace("10 div (3 - n)", "1")
        .replace("[n < 4]", "[10 div (3 - n) > 0]")
        .replace("in A : n\n      out B", "in A : 9\n      out B"),
    )
    with pytest.raises(Trouble, match=r"all 4 markings, but in 1 of them .*Div"):
        nearby.to_dead(game, 100, lambda n, t: None)
    assert [n.is_dead for n in nearby.around(game, 9, 400).nodes] == [False] * 4
