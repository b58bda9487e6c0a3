"""How far a belt with a stop runs is not followed: within how many seconds something comes is known all the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers import belt_cell
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]

PROPERTY = """
[[property]]
name = "soon"
holds = "every fires(Sup'Want) is followed by fires(Sup'Placed) within {} seconds"
"""


def within(cell: Path, seconds: float, code: int) -> dict[str, Any]:
    done = CliRunner().invoke(app, ["time", str(cell), "--within", str(seconds), "--json"])
    assert done.exit_code == code, done.output
    found = json.loads(done.stdout)
    (said,) = found["within"]
    return {**said, "cycle": found["layouts"][0]["cycle"]}


def soon(folder: Path, seconds: float, toml: str = belt_cell.TOML) -> dict[str, Any]:
    belt_cell.belt_cell(folder, toml=toml + PROPERTY.format(seconds))
    done = CliRunner().invoke(app, ["verify", str(folder), "--durations", "--no-medium", "--json"])
    found = json.loads(done.stdout)
    (said,) = (x for x in found["properties"] if x["name"] == "soon")
    return dict(said)


def ran(folder: Path, out: Path) -> float:
    result = run_cell(
        folder, RunOptions(out, backend="fake", looks=False, checked=False), Diagnostics()
    )
    assert result is not None and result.record.verdict == "finished"
    return result.record.time


@pytest.mark.bullet
def test_a_cycle_is_within_both_bounds(tmp_path: Path) -> None:
    cell = belt_cell.belt_cell(tmp_path / "cell")
    said = within(cell, 1.0, 1)
    cycle = said["cycle"]
    assert said["answer"] == "no" and "no cycle takes less than" in said["why"]
    took = ran(cell, tmp_path / "run")
    assert cycle["at_least_s"] < took < cycle["at_most_s"]
    assert within(cell, cycle["at_most_s"] + 0.01, 0)["answer"] == "yes"
    between = within(cell, took, 3)
    assert between["answer"] == "unknown"
    assert f"no cycle takes more than {cycle['at_most_s']:.3f} s" in between["why"]


@pytest.mark.bullet
def test_a_wait_is_no_longer_than_if_the_belt_runs_all_of_its_way(tmp_path: Path) -> None:
    said = soon(tmp_path / "long", 60)
    assert said["answer"] == "yes", said
    assert any("no command takes more than its planned time" in x for x in said["assumes"])
    most = said["value"]
    assert ran(tmp_path / "long", tmp_path / "run") < 2 * most
    short = soon(tmp_path / "short", most - 0.1)
    assert short["answer"] == "inconclusive"
    assert f"no wait is longer than {most:.3f} s" in short["why"]


@pytest.mark.bullet
def test_what_may_not_come_is_no_yes(tmp_path: Path) -> None:
    """An answer that may be too late, a net that goes round for ever, and a move that is not possible."""
    late = belt_cell.TOML.replace('["Finished"]', '["Finished"]\nreply_timeout_s = 7', 1)
    assert late != belt_cell.TOML
    said = soon(tmp_path / "late", 60, late)
    assert said["answer"] == "inconclusive" and "reply_timeout_s (7 s)" in said["why"], said
    said = within(tmp_path / "late", 600, 3)
    assert "reply_timeout_s (7 s)" in said["why"]
    ever = belt_cell.NET.replace("guard [n <= parts]", "", 1).replace(
        "out Next : n + 1", "out Next : n"
    )
    cell = belt_cell.belt_cell(tmp_path / "ever", net=ever)
    assert within(cell, 10_000, 3)["answer"] == "unknown"
    far = belt_cell.NET.replace("val infeed = at (1500.0,", "val infeed = at (9500.0,")
    cell = belt_cell.belt_cell(tmp_path / "far", net=far)
    assert within(cell, 10_000, 3)["answer"] != "yes"


@pytest.mark.bullet
def test_an_answer_that_a_belt_may_make_late_is_no_yes(tmp_path: Path) -> None:
    """It was: in time, with a latest answer far beyond the limit. A run stopped there."""
    toml = belt_cell.TOML.replace('["Finished"]', '["Finished"]\nreply_timeout_s = 20', 1)
    cell = belt_cell.belt_cell(tmp_path / "cell", toml=toml.replace("speed = 0.25", "speed = 0.02"))
    done = CliRunner().invoke(app, ["verify", str(cell), "--durations", "--no-medium", "--json"])
    assert done.exit_code == 3, done.output
    found = json.loads(done.stdout)
    (check,) = (x for x in found["controller"] if x["check"] == "in-time")
    assert check["answer"] == "unknown"
    (late,) = found["durations"]["layouts"][0]["cycle"]["late"]
    assert "feeder` may come as late as after 62.089 s" in late
    assert "reply_timeout_s (20 s)" in late
    options = RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False)
    result = run_cell(cell, options, Diagnostics())
    assert result is not None and "feeder has not answered" in result.record.reason
