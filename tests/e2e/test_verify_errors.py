"""An exception in a reachable marking: the shortest way there, and what raises it, by two implementations."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from helpers.netbuilder import flat, write
from helpers.processes import pn2code
from pn2code.semantics.game.token_game import GameError
from pn2code.verify.answers.path import play

pytestmark = pytest.mark.cc

OCCURRENCE = """
    net Occurrence
      colset INT = int;
      colset LIST = list INT;
      var n, m : INT;
      var l : LIST;
      place P : INT = 1`7
      place Q : LIST = 1`[]
      trans Down guard [n > 0]
        in P : n
        out P : n - 1
      trans Half guard [n > 1]
        in P : n
        out P : n div 2
      trans Push guard [length l < 2] code input (l, n); output (m); action 6 div n
        in Q : l
        both P : n
        out Q : m :: l
"""
"""7, 3, 1, 0: then Push cannot occur. With Down alone it would take seven steps."""
GUARD = """
    net Guard
      colset INT = int;
      var n, k : INT;
      place P : INT = 1`0 ++ 1`5
      trans Up guard [n < 9]
        in P : n
        out P : n + 1
      trans Look guard [List.nth ([1, 2, 3, 4, 5, 6, 7, 8], k) < 9]
        in P : k
"""
"""Two ways of three steps lead to a token 8, of four of them three are not the first."""
TIMED = """
    net Timed
      colset INT = int timed;
      var n : INT;
      place P : INT = 1`2@0
      trans T
        in P : n
        out P : (n - 1) @+ 5
      trans Check guard [10 div n > 0]
        in P : n
        out P : n @+ 6
"""


def explored(net: Path, folder: Path, *options: str) -> dict[str, object]:
    done = pn2code("verify", net, "--json", "--traces", folder, *options)
    assert done.returncode == 1, done.stderr
    said = json.loads(done.stdout)
    assert (said["complete"], said["why"]) == (False, "error")
    error: dict[str, object] = said["error"]
    return error


@pytest.mark.parametrize(
    ("text", "steps", "exception", "binding"),
    [
        (OCCURRENCE, 3, "Div", {"l": "[]", "n": "0"}),
        (GUARD, 3, "Subscript", None),
        (TIMED, 2, "Div", None),
    ],
    ids=["occurrence", "guard", "timed"],
)
def test_the_way_to_an_exception(
    text: str, steps: int, exception: str, binding: object, tmp_path: Path
) -> None:
    net = write(text, tmp_path / "net.cpn")
    one = explored(net, tmp_path, "--threads", "1")
    assert (one["message"], one["binding"]) == (exception, binding)
    trace = one["trace"]
    assert isinstance(trace, dict)
    assert trace["steps"] == steps
    path = Path(trace["file"])
    assert path.name == f"{path.name.split('.')[0]}.error-{one['node']}.trace.jsonl"
    assert json.loads(path.read_text().splitlines()[-1])["why"] == "error"
    for engine in ("compiled", "reference"):
        replayed = pn2code("simulate", net, "--replay", path, "--engine", engine, "--steps", "0")
        assert replayed.returncode == 0, replayed.stderr
    # The token game comes to the same exception, and to none before.
    model = flat(text)
    game, played = play(model, {}, path)
    assert len(list(played)) == steps
    with pytest.raises(GameError, match=exception):
        settled = game.advance_time(game.marking)
        for element in game.enabled_in(settled):
            game.occur(settled, element)
    # Other threads and another order: the same marking, from a way that may be another one.
    two = explored(net, tmp_path, "--threads", "2", "--no-graph")
    assert two == one
    if not model.timed:  # which goes on for ever
        deep = explored(net, tmp_path, "--order", "dfs")
        assert deep["message"] == exception
        assert deep["trace"]


def test_no_way(tmp_path: Path) -> None:
    """Where it is not wanted, not possible, not permitted."""
    net = write(OCCURRENCE, tmp_path / "net.cpn")
    error = explored(net, tmp_path, "--most-traces", "0")
    assert error["node"]
    assert error["trace"] is None
    hashed = explored(net, tmp_path, "--approximate", "hash")
    assert (hashed["node"], hashed["trace"]) == (None, None)
    assert not list(tmp_path.glob("*.jsonl"))
    done = pn2code("verify", net, "--traces", "/proc/self")
    assert done.returncode == 1
    assert "warning[dead-trace-unwritable]" in done.stderr
    done = pn2code("verify", net, "--traces", tmp_path, "--report", tmp_path / "r.html")
    assert "  then `Top.Push` with l = [], n = 0 raises `Div`" in done.stdout
    page = (tmp_path / "r.html").read_text()
    assert "Then Top.Push with l = [], n = 0 raises Div." in page
    assert "Partial: an inscription raised an exception" in page
