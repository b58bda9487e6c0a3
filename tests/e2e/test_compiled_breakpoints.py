"""Breakpoints with predicates are compiled with the net; where they are not, the report says so."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers import monitors
from helpers.monitors import SAME, Spec
from pn2code.cli.main import app

pytestmark = pytest.mark.cc

NET = """
    net Watched
      standard
      globref seen = ([] : INT list);
      var n : INT;
      var u : UNIT;
      place P : INT = 1`0
      place Q : INT
      place Ticks = 1
      trans T code input (n); action (seen := n :: !seen)
        in P : n
        out P : n + 1
        out Q : n
      trans U
        in Q : n
      trans Tick
        both Ticks : u
"""


def predicate(rules: str) -> dict[str, str]:
    return {"Predicate": f"fun pred (bindelem) = let fun one {rules} in one bindelem end"}


def stop(name: str, nodes: Sequence[str], rules: str) -> Spec:
    return Spec(name, "Breakpoint", nodes, predicate(rules))


READS = stop(
    "reads", ["Top.T"], "(Top'T (1, {n})) = length (!seen) > 20 andalso n > 3 | one _ = false"
)
BINDING = stop(
    "binding",
    ["Top.T", "Top.U"],
    "(Top'T (1, {n})) = false | one (Top'U (i, {n})) = n + i = 9 | one _ = false",
)
TICK = stop("tick", ["Top.Tick"], "(Top'Tick (1, {u})) = List.length (!seen) = 7 | one _ = false")
COUNT = Spec("count", "Count transition occurrence data collector", ["Top.T"])
RAISES = stop("raises", ["Top.T"], "(Top'T (1, {n})) = 12 div (5 - n) < 0 | one _ = false")
WRITES = stop("writes", ["Top.T"], "(Top'T (1, {n})) = (seen := []; n > 9) | one _ = false")
OTHER = Spec(
    "other", "User defined", ["Top.T"],
    {**predicate("_ = true"), "Observer": "fun obs (bindelem) = 1", "Action": "fun action (n) = ()"},
)  # fmt: skip


def simulated(folder: Path, specs: Sequence[Spec], *options: object) -> dict[str, Any]:
    return monitors.simulated(folder / "watched.cpn", NET, specs, 300, *options)


@pytest.mark.parametrize(
    ("specs", "name"),
    [
        ([READS], "reads"),
        ([BINDING, TICK], None),
        ([COUNT, READS, BINDING], None),
    ],
    ids=["reads", "bindings", "many"],
)
def test_breakpoints_are_compiled(tmp_path: Path, specs: Sequence[Spec], name: str | None) -> None:
    compiled = simulated(tmp_path, specs)
    reference = simulated(tmp_path, specs, "--engine", "reference")
    assert (compiled["engine"], compiled["interpreted"]) == ("compiled", [])
    assert {k: compiled[k] for k in SAME} == {k: reference[k] for k in SAME}
    assert compiled["why"] == "breakpoint"
    assert name in (None, compiled["breakpoint"]["name"])


def test_what_is_interpreted_is_said(tmp_path: Path) -> None:
    """A monitor that does something, or an exception in one: the token game watches, and the report says for whom."""
    for specs, why in (([READS, OTHER], "breakpoint"), ([RAISES], "error")):
        compiled = simulated(tmp_path, specs)
        reference = simulated(tmp_path, specs, "--engine", "reference")
        assert {k: compiled[k] for k in SAME} == {k: reference[k] for k in SAME}
        assert compiled["why"] == why
        assert compiled["interpreted"] == [s.name for s in specs]
    trace = simulated(tmp_path, [READS], "--trace", tmp_path / "t.jsonl")
    assert trace["interpreted"] == ["reads"]
    assert simulated(tmp_path, [READS], "--no-breakpoints")["interpreted"] == []
    net = tmp_path / "watched.cpn"
    done = CliRunner().invoke(
        app, ["simulate", str(net), "--steps", "5", "--trace", str(tmp_path / "t")]
    )
    assert "its monitors are interpreted" in done.stdout and "(`reads`)" in done.stdout


def test_a_monitor_that_changes_what_the_net_reads(tmp_path: Path) -> None:
    compiled = simulated(tmp_path, [WRITES])
    assert compiled["engine"] == "reference"
