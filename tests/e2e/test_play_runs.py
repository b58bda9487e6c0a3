"""Many steps at once: both engines make the same, and a run ends where it is told to."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers.played import session
from helpers.shown import PAIR
from pn2code.play import saving
from pn2code.play.running import MANY, Ended, Wish, is_worth_it, run
from pn2code.play.session import Session
from pn2code.play.trouble import Trouble
from pn2code.trace.replay import replay

RING = """
net Ring
  standard
  colset T = int timed;
  var n : INT;
  page Top
    place A : T = 1`0 ++ 1`1 ++ 1`2
    place B : T
    trans Go
      in A : n
      out B : 1`((n + 1) mod 50) @+ 3
    trans Back
      in B : n
      out A : 1`n @+ (n mod 4)
"""


def done(game: Session, **wish: Any) -> Ended:
    return run(game, Wish(**wish), lambda steps, time: None)


@pytest.mark.cc
class TestCompiled:
    def test_it_makes_the_steps_of_the_token_game(self, tmp_path: Path, quick_build: None) -> None:
        game = session(tmp_path, RING, seed=3)
        ended = done(game, steps=400, engine="reference")
        assert (ended.why, ended.steps, ended.engine) == ("steps", 400, "the token game")
        wanted = game.game.marking
        saving.save(game, tmp_path / "a.jsonl")
        game.go(0)
        ended = done(game, steps=400, engine="compiled")
        assert (ended.why, ended.steps, ended.engine) == ("steps", 400, "the compiled simulator")
        assert game.game.marking == wanted and game.history.length == 1
        saving.save(game, tmp_path / "b.jsonl")
        assert (tmp_path / "a.jsonl").read_bytes() == (tmp_path / "b.jsonl").read_bytes()
        game.undo()
        assert game.game.marking.time == 0 and game.game.steps == 0
        game.redo()
        assert game.game.marking == wanted and game.game.steps == 400

    def test_it_goes_on_from_what_was_played_by_hand(
        self, tmp_path: Path, quick_build: None
    ) -> None:
        game = session(tmp_path, RING)
        game.fire_any(0)
        game.fire_any(0)
        assert done(game, steps=200, engine="compiled").steps == 200
        game.step()
        assert done(game, steps=300, engine="compiled").steps == 300
        file = tmp_path / "run.jsonl"
        saving.save(game, file)
        result = replay(file, game.net)
        assert result.ok and result.steps == 503 and result.marking == game.game.marking

    def test_a_time_ends_it(self, tmp_path: Path, quick_build: None) -> None:
        game = session(tmp_path, RING)
        assert done(game, steps=10_000, until=100.5, engine="compiled").why == "until"
        compiled = game.game.marking
        game.go(0)
        assert done(game, steps=10_000, until=100.5, engine="reference").why == "until"
        assert compiled == game.game.marking and compiled.time == 100

    def test_many_steps_are_its_business(self, tmp_path: Path, quick_build: None) -> None:
        game = session(tmp_path, RING)
        assert done(game, steps=5000).engine == "the compiled simulator"
        assert done(game, steps=10).engine == "the token game"
        game.edit(0, "1`7")
        assert done(game, steps=5000).engine == "the token game"
        with pytest.raises(Trouble, match="does not begin with the initial marking"):
            done(game, steps=5000, engine="compiled")


def test_a_short_run_after_a_long_one_is_not_repeated(tmp_path: Path) -> None:
    game = session(tmp_path, RING)
    game.fire_any(0)
    wish = Wish(steps=MANY)
    assert is_worth_it(game, wish)
    game.game.steps = MANY * 100
    assert not is_worth_it(game, wish)
    assert not is_worth_it(game, Wish(steps=MANY - 1))


def test_conditions_and_breakpoints_end_a_run(tmp_path: Path) -> None:
    game = session(tmp_path, PAIR)
    condition = game.typist.condition("List.exists (fn n => n > 9) (Mark.Top'A 1)")
    ended = done(game, steps=1000, condition=condition)
    assert ended.why == "condition"
    assert game.holds(condition.exp, condition.looks)
    game.undo()
    assert not game.holds(condition.exp, condition.looks)
    ended = done(game, steps=1000, breakpoints=frozenset({1}))
    assert ended.why == "breakpoint"
    element = game.history.entry(game.history.position - 1).element
    assert element is not None and element.transition == 1


def test_a_run_ends_by_itself(tmp_path: Path) -> None:
    game = session(tmp_path, PAIR)
    ended = done(game, steps=10_000, engine="reference")
    assert ended.why == "finished" and "dead" in ended.text
    with pytest.raises(Trouble, match="the marking is dead"):
        game.step()


def test_a_run_can_be_stopped(tmp_path: Path) -> None:
    game = session(tmp_path, RING)
    told: list[int] = []

    def tell(steps: int, time: float) -> None:
        told.append(steps)
        game.stop.set()

    ended = run(game, Wish(steps=10_000_000, engine="reference"), tell)
    assert ended.why == "stopped" and ended.steps >= told[0] > 0
    assert done(game, steps=3).steps == 3


def test_an_exception_ends_a_run_with_its_place(tmp_path: Path) -> None:
    game = session(tmp_path, RING.replace("@+ (n mod 4)", "@+ (4 div (7 - n))"))
    with pytest.raises(Trouble) as raised:
        done(game, steps=1000, engine="reference")
    assert raised.value.rows and game.game.steps > 0
