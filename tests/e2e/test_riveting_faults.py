"""A drill that breaks at the third rivet, end to end: both robots retract and go HOME, the cell ends in `Failed`."""

from __future__ import annotations

import json
import shutil
import tomllib
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.table_2 import table_2
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.replay import happenings
from pn2code.robot.transforms import Array
from pn2code.run.cell import run_cell
from pn2code.run.engine import Engine
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build", "generated_once")]

FINAL = ["Cell.Supervisor.Failed"]


class Arms:
    """Remembers where the arms stand at the end (rad); in real time the last sample may come before it."""

    def __init__(self) -> None:
        self.joints: dict[str, Array] = {}

    def begun(self, engine: Engine) -> None: ...

    def advanced(self, engine: Engine) -> None: ...

    def ended(self, engine: Engine) -> None:
        self.joints = {r.name: np.array(r.arm.q) for r in engine.robots if r.arm is not None}

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None: ...


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the first run leaves its program for the others."""
    return tmp_path_factory.mktemp("built") / "program"


def failing(root: Path, out: Path, built: Path, **options: object) -> tuple[RunResult, Arms]:
    if built.exists():
        shutil.copytree(built, out / "program")
    d = Diagnostics()
    arms = Arms()
    cell = root / "examples/riveting"
    given = RunOptions(out=out, input=cell / "faults", looks=False, **options)  # type: ignore[arg-type]
    result = run_cell(cell, given, d, [arms])
    assert result is not None, [e.message for e in d.errors]
    if not built.exists():
        shutil.copytree(out / "program", built)
    return result, arms


def assert_both_are_home(root: Path, arms: Arms) -> None:
    toml = tomllib.loads((root / "examples/riveting/cell.toml").read_text())
    for name, robot in toml["robots"].items():
        assert np.degrees(arms.joints[name]) == pytest.approx(robot["home"], abs=1e-9)


def test_the_drill_fails_at_the_third_rivet(root: Path, tmp_path: Path, built: Path) -> None:
    result, arms = failing(root, tmp_path, built, backend="fake")
    assert (result.record.verdict, result.summary["final"]) == ("finished", FINAL)
    assert result.summary["failed"] == FINAL
    assert happenings._events(result.record)[-1]["kind"] == "fault"
    assert result.summary["counts"]["rivets"] == 2
    assert_both_are_home(root, arms)
    # Table 2 up to the retreat of the third rivet, and nothing more.
    sent = [line.split("\t") for line in (tmp_path / "rows.tsv").read_text().splitlines()]
    assert sent == [[str(k), *row] for k, row in enumerate(table_2(), 1)][:9]
    last = [e["transition"] for e in result.record.events if "transition" in e]
    at = last.index("Cell.Supervisor.Install.Rivet.Fasten.Drill failed")
    acts = [n for n in last[at:] if n.endswith(("MoveLinear", "MoveHome", "Release", "Give up"))]
    assert acts == [
        "Cell.Robot2.Release",
        "Cell.Robot1.MoveLinear",
        "Cell.Robot2.MoveLinear",
        "Cell.Supervisor.Install.Give up",
        "Cell.Robot1.MoveHome",
        "Cell.Robot2.MoveHome",
    ]
    end = json.loads((tmp_path / "supervisor.trace.jsonl").read_text().splitlines()[-1])
    assert (end["why"], end["final"]) == ("finished", FINAL)

    def replayed(trace: Path) -> tuple[int, str]:
        net = str(root / "examples/riveting")
        done = CliRunner().invoke(app, ["replay", str(trace), net])
        return done.exit_code, done.output

    trace = tmp_path / "cell.trace.jsonl"
    code, text = replayed(trace)
    assert code == 0, text
    assert f"{len(last)} steps" in text
    # The replay can say no: had the drill reported that it is done, `Drill failed` could not occur.
    broken = tmp_path / "broken.trace.jsonl"
    broken.write_text(trace.read_text().replace('"drilled": 2', '"drilled": 1'))
    code, text = replayed(broken)
    assert code == 1, text


def test_in_real_time_too(root: Path, tmp_path: Path, built: Path) -> None:
    result, arms = failing(root, tmp_path, built, backend="fake", realtime=True, speed=100.0)
    assert (result.record.verdict, result.summary["final"]) == ("finished", FINAL)
    assert_both_are_home(root, arms)


@pytest.mark.bullet
def test_the_way_home_is_free(root: Path, tmp_path: Path, built: Path) -> None:
    """From the third place, where no undisturbed run goes HOME from, in PyBullet."""
    result, arms = failing(root, tmp_path, built, backend="bullet")
    assert (result.record.verdict, result.summary["final"]) == ("finished", FINAL)
    assert_both_are_home(root, arms)
    assert all(entry["m"] > 0.0 for entry in result.summary["clearances"].values())
