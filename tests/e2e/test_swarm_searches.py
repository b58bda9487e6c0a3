"""One search of a swarm, by the compiled explorer: what it looks at, and the runs that it keeps."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from helpers.explored import Explorers
from helpers.netbuilder import flat
from helpers.questions import Asked, ask
from helpers.random_graphs import numbered
from pn2code.semantics.game.errors import GameError
from pn2code.verify.answers.path import play
from pn2code.verify.swarm.plan import Search

pytestmark = pytest.mark.cc

ALL = ("--sketch", 60_000, "--max-depth", 100_000, "--memory", 64)
LISTS = """
    net Lists
      colset INT = int;
      colset LIST = list INT;
      var n : INT;
      var l : LIST;
      place Numbers : INT = 1`1 ++ 1`2 ++ 1`3 ++ 1`4
      place Lists : LIST = 1`[] ++ 1`[7]
      trans Put
        in Numbers : n
        in Lists : l
        out Lists : n :: l
"""
TIMED = """
    net Timed
      colset INT = int timed;
      colset TEXT = string timed;
      var n : INT;
      var s : TEXT;
      place A : INT = 1`1@2 +++ 1`2@0 +++ 1`3@5
      place B : INT
      place Long : TEXT = 1`"a text that is long enough to be stored apart from its stamps"@1
      trans Go
        in A : n
        out B : n@+2
      trans Back guard [n < 3]
        in B : n
        in Long : s
        out Long : s@+3
"""
ASSIGNS = """
    net Assigns
      colset INT = int;
      var n : INT;
      globref seen = 0;
      place P : INT = 1`1 ++ 1`2 ++ 1`3
      place Q : INT
      trans T
        in P : n
        out Q : n
        code
          input (n);
          action (seen := !seen * 2 + n)
"""
RAISES = """
    net Raises
      colset INT = int;
      var n : INT;
      place P : INT = 1`5
      place Q : INT = 1`0
      trans Down
        in P : n
        out P : n - 1 + 0 * (6 div n)
      trans Round
        in Q : n
        out Q : (n + 1) mod 3
"""


def stable(report: dict[str, Any]) -> dict[str, Any]:
    """Without what depends on the clock and the machine."""
    times = ("seconds", "cpu_seconds", "states_per_second", "peak_mib")
    return {k: v for k, v in report.items() if k not in times}


def limits(report: dict[str, Any]) -> list[tuple[int, int]]:
    """The least and the most tokens of each place."""
    return [(b["lower"], b["upper"]) for b in report["bounds"]]


@pytest.mark.parametrize("text", [LISTS, TIMED, ASSIGNS], ids=["lists", "timed", "references"])
def test_equal_markings_have_equal_hashes(explorers: Explorers, text: str) -> None:
    """In all searches, whatever numbers their multi-sets have got; and different ones have others."""
    net = flat(text)
    whole = explorers.explore(net, reads=False).report
    sketches = []
    for seed in (1, 2, 9):
        found = explorers.explore(net, "--swarm", seed, "--shuffle", seed + 1, *ALL, reads=False)
        assert (found.report["why"], found.report["nodes"]) == ("approximation", whole["nodes"])
        assert limits(found.report) == limits(whole)
        sketches.append(found.report["swarm"]["sketch"])
    assert sketches[0] == sketches[1] == sketches[2]
    assert len(sketches[0]) == whole["nodes"] and sketches[0] == sorted(set(sketches[0]))


@pytest.mark.parametrize("number", range(4))
def test_random_nets(explorers: Explorers, number: int) -> None:
    net = flat(numbered(number))
    whole = explorers.explore(net, reads=False).report
    found = explorers.explore(net, "--swarm", 5, "--shuffle", 6, *ALL, reads=False).report
    assert whole["complete"]
    assert len(found["swarm"]["sketch"]) == found["nodes"] == whole["nodes"]
    few = explorers.explore(net, "--swarm", 5, "--shuffle", 6, "--sketch", 7, reads=False).report
    assert few["swarm"]["sketch"] == found["swarm"]["sketch"][:7]


@pytest.fixture(scope="module")
def lists(explorers: Explorers) -> Asked:
    return ask(explorers, LISTS, ("List.all (fn l => length l < 4) Lists", "Numbers <> []"))


LINES = ["pred 0", "pred 1", "dead", "not 2", "? invariant 0", "? invariant 1", "? invariant 3"]
WALK = ("--walk", "--max-states", 500)


@pytest.mark.parametrize("how", [("--shuffle", 8), WALK], ids=["depth first", "walk"])
def test_each_finding_has_its_run(lists: Asked, how: tuple[object, ...], tmp_path: Path) -> None:
    found, answers = lists.say(LINES, "--swarm", 7, *how, "--trace-to", tmp_path / "dead-")
    assert [a["answer"] for a in answers] == ["no", "no", "no"]
    for answer in answers:
        game, played = play(lists.flat, {}, Path(answer["trace"]))
        assert len(list(played)) == answer["steps"]
    assert not game.enabled_in(game.marking)
    dead = found.report["swarm"]["dead_trace"]
    game, played = play(lists.flat, {}, Path(dead["file"]))
    assert len(list(played)) == dead["steps"] == 4
    assert not game.enabled_in(game.marking)


@pytest.mark.parametrize("number", range(2))
def test_the_seed_decides_all(lists: Asked, number: int) -> None:
    one, again, other = (
        lists.say(LINES[:3], *Search.of(i).arguments(), "--sketch", 50, "--max-states", 40)[0]
        for i in (number, number, number + 2)
    )
    assert stable(one.report) == stable(again.report)
    assert one.report["swarm"]["sketch"] != other.report["swarm"]["sketch"]


@pytest.mark.parametrize("how", [("--shuffle", 8), WALK], ids=["depth first", "walk"])
def test_no_run_is_longer_than_it_may_be(lists: Asked, how: tuple[object, ...]) -> None:
    """Four steps lead to each dead marking."""
    for depth, answer in ((4, "no"), (3, "unknown")):
        found, answers = lists.say(LINES, "--swarm", 3, *how, "--max-depth", depth)
        assert (answers[2]["answer"], found.report["depth"]) == (answer, depth)


def test_it_ends_where_it_is_told_to(lists: Asked) -> None:
    found, answers = lists.say(LINES, "--swarm", 3, "--shuffle", 4, "--ending", "1")
    assert found.report["why"] == "decided" and answers[1]["answer"] == "no"
    whole, _ = lists.say(LINES, "--swarm", 3, "--shuffle", 4)
    assert found.report["expanded"] < whole.report["expanded"]


@pytest.mark.parametrize("how", [("--shuffle", 8), WALK], ids=["depth first", "walk"])
def test_the_way_to_an_exception(
    explorers: Explorers, how: tuple[object, ...], tmp_path: Path
) -> None:
    net = flat(RAISES)
    options = ("--swarm", 2, *how, "--error-trace-to", tmp_path / "error-")
    error = explorers.explore(net, *options, reads=False).report["error"]
    assert (error["message"], error["binding"], error["node"]) == ("Div", {"n": 0}, None)
    trace = Path(error["trace"]["file"])
    assert json.loads(trace.read_text().splitlines()[-1])["why"] == "error"
    game, played = play(net, {}, trace)
    assert len(list(played)) == error["trace"]["steps"]
    with pytest.raises(GameError, match="Div"):
        for element in game.enabled_in(game.marking):
            game.occur(game.marking, element)


def test_walks_have_no_loops_in_their_runs(explorers: Explorers, tmp_path: Path) -> None:
    """Five steps down, and twice round at most: what leads back is left out."""
    options = ("--swarm", 4, *WALK, "--error-trace-to", tmp_path / "error-")
    error = explorers.explore(flat(RAISES), *options, reads=False).report["error"]
    assert 5 <= error["trace"]["steps"] <= 5 * 3 + 2


TRAP = """
    net Trap
      colset INT = int;
      var n : INT;
      place Start : INT = 1`0
      place Over : INT
      place Round : INT
      trans Good
        in Start : n
        out Over : n
      trans Bad
        in Start : n
        out Round : n
      trans Go guard [n < 9]
        in Round : n
        out Round : n + 1
      trans Again
        in Round : 9
        out Round : {again}
"""
ENDS = ("owner 0 0 1 2 3", "within 1 1 -", "ef 0", "? ends 1")


@pytest.mark.parametrize(("most", "answer"), [(20_000, "no"), (4_000, "unknown")])
def test_where_no_end_can_be_reached(explorers: Explorers, most: int, answer: str) -> None:
    """The run leads to the first marking of the trap. It is not looked for where walks have seen little."""
    asked = ask(explorers, TRAP.format(again="0"), (), "trap")
    walk = ("--swarm", 2, "--walk", "--max-depth", 50, "--max-states", most)
    _, (said,) = asked.say(ENDS, *walk, *ALL[:2])
    assert said["answer"] == answer
    if answer == "no":
        assert said["why"] == "endless"
        _, played = play(asked.flat, {}, Path(said["trace"]))
        assert [step.transition for step, _ in played] == ["Top.Bad"] and said["steps"] == 1


def test_the_way_to_an_exception_behind_the_end_of_a_walk(explorers: Explorers) -> None:
    """What follows is looked at, and is farther away than a walk may go."""
    asked = ask(explorers, TRAP.format(again="hd []"), (), "trap-raises")
    walk = ("--swarm", 2, "--walk", "--max-depth", 4, "--max-states", 20_000)
    run = asked.folder / "error-"
    found, _ = asked.say(ENDS, *walk, *ALL[:2], "--error-trace-to", run)
    assert found.report["error"]["trace"]["steps"] == 10
    _, played = play(asked.flat, {}, Path(f"{run}0.trace.jsonl"))
    assert [step.transition for step, _ in played] == ["Top.Bad", *["Top.Go"] * 9]
