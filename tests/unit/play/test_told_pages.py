"""What a page has been told bit by bit is what it would be told at once, and what a game that came here would do."""

from __future__ import annotations

import asyncio
import json
import random
import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from starlette.websockets import WebSocketDisconnect

from helpers.played import session
from pn2code.play import app, saving
from pn2code.play.commands import Player
from pn2code.play.session import Session
from pn2code.play.trouble import Trouble
from pn2code.play.view import View
from pn2code.semantics.evaluation.references import Held, References
from pn2code.semantics.game.token_game import Game, GameError
from pn2code.trace.replay import replay

COUNTS = """
net Counts
  standard
  var n : INT;
  page Top
    place A : INT = 1`1
    trans Few guard [IntInf.toInt (step ()) < 3]
      in A : n
      out A : n + 1
    trans Many guard [IntInf.toInt (step ()) >= 3]
      in A : n
      out A : 0
"""
DRAWS = """
net Draws
  standard
  var n : INT;
  page Top
    place A : INT = 1`1
    place B : INT
    trans Perhaps guard [discrete (0, 3) > 0]
      in A : n
      out A : n + 1
    trans Always
      in A : n
      out A : n
      out B : discrete (0, 5)
"""
REMEMBERS = """
net Remembers
  standard
  globref r = 0;
  colset LATE = int timed;
  var n : INT;
  page Top
    place A : LATE = 1`1 @+ 0 +++ 1`5 @+ 3
    place B : INT
    trans Few guard [!r < 3] code input (n); action r := !r + 1
      in A : n
      out A : n + 1 @+ 2
    trans Again guard [!r >= 3] code action r := 0
      in A : n
      out A : n
      out B : n
    trans Raises guard [if n > 8 then raise Div else n = 7]
      in B : n
"""
COMMANDS = (
    "fire", "fire", "step", "step", "undo", "undo", "redo", "go", "edit", "seed", "reset", "advance", "evaluate",
    "load", "again", "bindings", "space", "run",
)  # fmt: skip
SAME = ("position", "length", "steps", "time", "later", "error")


class Page:
    """What a page knows."""

    def __init__(self, player: Player) -> None:
        self.player = player
        self.places: dict[str, Any] = {}
        self.enabled: set[int] = set()
        self.other: dict[str, Any] = {}
        self.hear(player.view.state())

    def hear(self, state: dict[str, Any]) -> None:
        told = state["enabled"]
        if isinstance(told, list):
            self.enabled = set(told)
        else:
            assert not self.enabled & set(told["more"]) and set(told["less"]) <= self.enabled
            self.enabled = self.enabled - set(told["less"]) | set(told["more"])
        self.places |= state["places"]
        self.other = {name: state[name] for name in SAME}

    def do(self, command: str, chance: random.Random, folder: Path) -> None:
        game, player = self.player.session, self.player
        if command == "again":
            self.hear(player.again())
            return
        if command == "load":
            trace = folder / "saved.trace.jsonl"
            try:
                saving.save(game, trace)
            except Trouble:  # this run cannot be a trace
                return
            result = replay(trace, game.net)
            assert result.ok, result.message()
            said = player.load(trace)
        else:
            text = chance.choice(["1`1", "1`7", "2`3", "empty"]) if command == "edit" else "1 + 1"
            said = player.answer(
                {
                    "do": command, "text": text, "place": 0, "depth": 2, "nodes": 20, "steps": 3,
                    "seed": chance.randrange(1, 5),
                    "transition": chance.randrange(len(game.net.transitions)),
                    "position": chance.randrange(game.history.length + 1),
                }
            )  # fmt: skip
        if "state" in said:
            self.hear(said["state"])


def enabled_elsewhere(game: Session) -> set[int]:
    """What is enabled in a game that has come to the same marking with the same number of steps."""
    other = Game(game.net, seed=game.game.evaluator.random.seed)
    other.steps = game.game.steps
    other.marking = game.game.marking
    held = game.game.marking.references
    if held.held:
        own = References(other.evaluator).contents()
        cells = zip(own.held, held.held, strict=True)
        references = Held(tuple((cell, value) for (cell, _), (_, value) in cells), own._roots)
        other.marking = replace(other.marking, references=references)
    try:
        return {t.index for t in other.enabled_transitions(other.marking)}
    except GameError:
        return set()


@pytest.mark.parametrize("seed", [1, 5, 9])
@pytest.mark.parametrize("text", [COUNTS, DRAWS, REMEMBERS], ids=["counts", "draws", "remembers"])
def test_a_page_knows_what_is_so(text: str, seed: int, tmp_path: Path) -> None:
    chance, game = random.Random(seed), session(tmp_path, text, seed=seed)
    page = Page(Player(game, lambda said: None))
    for _ in range(40):
        page.do(chance.choice(COMMANDS), chance, tmp_path)
        whole = View(game).state()
        assert page.other == {name: whole[name] for name in SAME}
        assert page.places == whole["places"] and page.enabled == set(whole["enabled"])
        assert page.enabled == enabled_elsewhere(game)


def test_after_an_exception_the_number_of_steps_is_as_before(tmp_path: Path) -> None:
    text = COUNTS.replace(
        "out A : n + 1", "out A : if step () = IntInf.fromInt 3 then 1 div 0 else n + 1"
    )
    game = session(tmp_path, text)
    for _ in range(2):
        game.fire_any(0)
    with pytest.raises(Trouble, match="Div"):
        game.fire_any(0)
    assert View(game).state()["enabled"] == [0]
    assert game.evaluate("step ()")[1] == "2"


def test_a_page_that_is_loaded_again_while_something_goes_on_is_told_everything(
    tmp_path: Path,
) -> None:
    """The answer to the page before, which nobody reads any more, does not count as told."""
    game = session(tmp_path, COUNTS)
    player, gate = Player(game, lambda said: None), threading.Event()

    class Reloaded:
        first: dict[str, Any] = {}

        async def send_text(self, text: str) -> None:
            self.first = self.first or json.loads(text)

        async def receive_text(self) -> str:
            raise WebSocketDisconnect

    def going_on() -> None:
        assert gate.wait(600)
        player.answer({"do": "fire", "transition": 0})

    async def reload(worker: ThreadPoolExecutor) -> Reloaded:
        page, hall = Reloaded(), app._Hall(SimpleNamespace(), None)  # type: ignore[arg-type]
        worker.submit(going_on)
        seat: Any = SimpleNamespace(player=player, worker=worker, name="seat")
        playing = asyncio.create_task(hall._at(page, seat, False))  # type: ignore[arg-type]
        await asyncio.sleep(0)  # it has come
        gate.set()
        await playing
        return page

    with ThreadPoolExecutor(1) as worker:
        state = asyncio.run(reload(worker)).first["state"]
    assert state["steps"] == 1 and state["enabled"] == [0]
    assert [state["places"]["0"]] == [[1, "1`2"]]
