"""`replay` says at which time a run has ended, also where nothing occurred at its end, and why in words."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from helpers.netbuilder import write
from pn2code.cli.main import app

TICKS = """
    net Ticks
      colset N = int timed;
      var n : N;
      page Top
        place P : N = 1`0
        trans Tick
          in P : n
          out P : n + 1 @+ 10
"""
"""Something occurs every ten units of time."""


@pytest.mark.parametrize(
    ("options", "says", "at"),
    [
        (("--until", "12"), "the next step would be after the given time, at time 12", 12),
        (("--until", "10"), "the next step would be after the given time, at time 10", 10),
        (("--steps", "2"), "steps, at time 10", None),
    ],
)
def test_the_end_of_a_run_limited_in_time(
    tmp_path: Path, options: tuple[str, ...], says: str, at: int | None
) -> None:
    net, trace = write(TICKS, tmp_path / "ticks.cpn"), tmp_path / "t.trace.jsonl"
    simulate = ["simulate", str(net), "--trace", str(trace), "--engine", "reference", *options]
    done = CliRunner().invoke(app, simulate)
    assert done.exit_code == 0, done.output
    done = CliRunner().invoke(app, ["replay", str(trace), str(net)])
    assert done.stdout == f"{trace}: 2 steps, each enabled when its turn came, ended: {says}\n"
    done = CliRunner().invoke(app, ["replay", str(trace), str(net), "--json"])
    row = json.loads(done.stdout)
    assert (row["ended"], row["time"]) == ("until" if at else "steps", 10)
    assert at is None or row["ended_at"] == at
