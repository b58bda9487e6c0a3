"""The course of a run: markings from keys and changes are those of the token game, after each step."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet
from pn2code.net.front import load
from pn2code.replay import course as courses
from pn2code.replay.arrays import unpacked
from pn2code.replay.course import Course
from pn2code.semantics.game.report import places
from pn2code.semantics.game.token_game import Game

COUNTING = """
net Counting
  standard
  var n, m : INT;
  page Top
    place A : INT = 1`3 ++ 2`1
    place B : INT
    place Tick : INT = 1`0
    trans Move
      in A : n
      out B : n + 1
    trans Back
      in B : n
      in Tick : m
      out A : if n > 5 then 0 else n
      out Tick : m + 1
"""
TIMED = """
net Clocks
  standard
  colset TINT = int timed;
  var n : INT;
  page Top
    place A : TINT = 1`3@0 ++ 1`1@2 ++ 1`1@0
    trans Wait delay @+2
      in A : n
      out A : n
"""


def played(text: str, folder: Path, steps: int) -> tuple[FlatNet, dict[str, Any], list[list[str]]]:
    """A random run: the net, its course as described, and the markings as the token game prints them."""
    d = Diagnostics()
    net = load(netbuilder.write(text, folder / "net.cpn"), d)
    assert net is not None, [e.message for e in d.errors]
    game, course, draws = Game(net), Course(net), random.Random(1)
    course.begin(game)
    seen = [_printed(net, game)]
    for _ in range(steps):
        if not game.advance():
            break
        occurred = game.fire(draws.choice(game.enabled()))
        course.step(game, occurred, float(game.steps))
        seen.append(_printed(net, game))
    return net, course.described(), seen


def _printed(net: FlatNet, game: Game) -> list[str]:
    by_id = {row["id"]: str(row["marking"]) for row in places(net, game.marking)}
    return [by_id[p.id] for p in net.places]


def shown(net: FlatNet, course: dict[str, Any], step: int) -> list[str]:
    """The marking after a step, from the nearest key before it, as a page computes it."""
    keys, changes, tokens = course["keys"], course["changes"], course["tokens"]
    at = max(i for i, k in enumerate(unpacked(keys["step"])) if k <= step)
    held: dict[int, int] = {}
    low, high = unpacked(keys["offset"])[at : at + 2]
    for i in range(low, high):
        held[int(unpacked(keys["token"])[i])] = int(unpacked(keys["count"])[i])
    offset = unpacked(changes["offset"])
    for i in range(offset[unpacked(keys["step"])[at]], offset[step]):
        token = int(unpacked(changes["token"])[i])
        held[token] = held.get(token, 0) + int(unpacked(changes["count"])[i])
    texts, stamps = unpacked(tokens["text"]), unpacked(tokens["stamp"])
    rows: list[list[str]] = [[] for _ in net.places]
    for token, n in sorted(held.items()):
        stamp = f"@{course['texts'][stamps[token] - 1]}" if stamps[token] else ""
        if n:
            place = unpacked(tokens["place"])[token]
            rows[place].append(f"{n}`{course['texts'][texts[token]]}{stamp}")
    joints = ["+++\n" if p.colset.timed else "++\n" for p in net.places]
    return [joint.join(row) or "empty" for joint, row in zip(joints, rows, strict=True)]


@pytest.mark.parametrize("text", [COUNTING, TIMED], ids=["untimed", "timed"])
def test_every_marking_is_that_of_the_token_game(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(courses, "_FEWEST", 8)  # keys in a short run
    net, course, seen = played(text, tmp_path, 120)
    assert len(unpacked(course["keys"]["step"])) > 3
    for step, marking in enumerate(seen):
        assert shown(net, course, step) == marking


def test_keys_are_not_larger_than_the_changes(tmp_path: Path) -> None:
    _, course, _ = played(COUNTING, tmp_path, 2000)
    offset = unpacked(course["keys"]["offset"])
    assert len(offset) > 2
    assert offset[-1] - offset[1] <= len(unpacked(course["changes"]["token"]))


def test_numbers_take_the_narrowest_type(tmp_path: Path) -> None:
    _, course, _ = played(COUNTING, tmp_path, 50)
    assert course["transition"]["type"] == "u8"
    assert course["changes"]["count"]["type"] == "i8"


def test_long_values_are_cut_and_say_so(tmp_path: Path) -> None:
    text = COUNTING.replace("2`1", "2`1").replace(
        "place B : INT",
        'place S : STRING = 1`(implode (List.tabulate (9000, fn _ => #"x")))\n    place B : INT',
    )
    _, course, _ = played(text, tmp_path, 1)
    longest = max(course["texts"], key=len)
    assert longest.endswith("(5,002 more characters)")
