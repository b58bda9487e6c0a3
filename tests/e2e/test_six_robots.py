"""Six robots in a row, two of them at work at a time: checked, verified, generated, run."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from rich.console import Console
from typer.testing import CliRunner

from helpers.many_robots import many_robots
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.report.summary import page
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_six_robots_are_proved_and_run(tmp_path: Path) -> None:
    cell = many_robots(tmp_path / "cell", 6, together=2)
    wanted = ["verify", str(cell), "--json", "--no-medium", "--most-traces", "0"]
    done = CliRunner().invoke(app, wanted)
    assert done.exit_code == 0, done.output
    (found,) = [c for c in json.loads(done.stdout)["controller"] if c["check"] == "non-blocking"]
    assert found["answer"] == "yes"
    d = Diagnostics()
    seen = run_cell(
        cell, RunOptions(tmp_path / "run", backend="fake", looks=False, checked=False), d
    )
    assert seen is not None, [e.message for e in d.errors]
    assert seen.record.verdict == "finished", seen.record.reason
    assert {a.robot for a in seen.record.actions} == {f"robot{i}" for i in range(1, 7)}
    shown = (tmp_path / "run" / "summary.json").read_text()
    console = Console(width=60, record=True, file=io.StringIO())
    console.print(page(json.loads(shown)))
    text = console.export_text()
    assert "utilisation" in text and all(f"robot{i} " in text for i in range(1, 7)), text
    busy = sorted((a.start, a.end, a.robot) for a in seen.record.actions)
    for start, _, _ in busy:
        at_once = {robot for a, b, robot in busy if a <= start + 1e-6 < b}
        assert len(at_once) <= 2
