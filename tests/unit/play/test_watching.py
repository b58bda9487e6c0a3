"""Monitors in a game that goes back and on: what they have collected goes with it."""

from __future__ import annotations

from pathlib import Path

from helpers.monitors import Spec, with_monitors
from helpers.played import session
from helpers.shown import PAIR
from pn2code.play.running import Wish, run
from pn2code.play.view import View

FLAT = """
net Flat
  standard
  var n : INT;
  page Top
    place A : INT = 1`1 ++ 1`2
    place B : INT
    trans Go guard [n < 30]
      in A : n
      out B : n + 1
    trans Back
      in B : n
      out A : n + 1
"""
SIZE = Spec("Size of A", "Marking size", ["Top.A"])
COUNT = Spec("Goes", "Count transition occurrence data collector", ["Top.Go"])


def test_statistics_go_back_with_the_steps(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, SIZE, COUNT))
    assert game.watching is not None
    seen = [game.watching.rows()]
    for _ in range(15):
        game.step()
        seen.append(game.watching.rows())
    points = [list(p) for p in game.watching.points]
    for k in (4, 0, 9, 15, 7):
        game.go(k)
        assert game.watching.rows() == seen[k]
        assert all(p[0] <= k for own in game.watching.points for p in own)
    game.go(15)
    assert game.watching.points == points
    assert seen[15] != seen[4] and points[0]


def test_another_way_has_other_values(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, COUNT))
    assert game.watching is not None
    for _ in range(6):
        game.step()
    game.go(0)
    for _ in range(2):
        game.fire_any(next(t.index for t in game.net.transitions if t.short == "Go"))
    assert game.watching.rows()[0]["count"] == 2


def test_what_is_made_again_is_what_was_made(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, COUNT))
    assert game.watching is not None
    go, back = (
        next(t.index for t in game.net.transitions if t.short == name) for name in ("Go", "Back")
    )
    game.fire_any(go)
    game.fire_any(go)
    game.undo()
    game.fire_any(back)
    game.undo()
    game.redo()
    assert game.watching.rows()[0]["count"] == 1


def test_what_is_forgotten_is_not_kept(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, COUNT), most_bytes=20_000)
    assert game.watching is not None
    for _ in range(50):
        game.step()
    assert game.history.forgotten and min(game.watching._steps) >= game.history.forgotten
    game.go(game.history.forgotten)
    seen = game.watching.rows()
    game.go(50)
    game.go(game.history.forgotten)
    assert game.watching.rows() == seen


def test_steps_that_were_not_seen_go_back_too(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, COUNT))
    assert game.watching is not None
    game.step()
    game.leapt(game.game.marking, 5000, [])
    assert game.watching.missed == 4999
    game.undo()
    assert game.watching.missed == 0
    game.redo()
    assert game.watching.missed == 4999


def test_a_breakpoint_of_the_net_ends_a_run(tmp_path: Path) -> None:
    stop = Spec(
        "A is empty", "Place contents break point", ["Top.A"], options={"if is empty": "true"}
    )
    game = session(tmp_path, with_monitors(FLAT, stop))
    ended = run(game, Wish(steps=1000), lambda steps, time: None)
    assert ended.why == "breakpoint" and "A is empty" in ended.text


def test_the_page_is_told_what_is_new(tmp_path: Path) -> None:
    game = session(tmp_path, with_monitors(FLAT, SIZE))
    view = View(game)
    first = view.state()["monitors"]["plots"][0]
    game.step()
    second = view.state()["monitors"]["plots"][0]
    assert first["from"] == 0 and second["from"] == len(first["points"])
    assert len(second["points"]) == 1
    assert view.state()["monitors"]["plots"][0]["points"] == []


def test_a_net_without_monitors_has_none(tmp_path: Path) -> None:
    game = session(tmp_path, PAIR)
    assert game.watching is None and View(game).state()["monitors"] is None
