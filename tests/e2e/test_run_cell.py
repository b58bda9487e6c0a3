"""The riveting cell, end to end: compiled supervisor, shared files, script interpreters, PyBullet arms.

Figures are those of the issue that the paper set: Table 2 digit for digit, its singularity of robot 2,
TCP on the commanded pose within 1e-6 mm.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.table_2 import table_2
from helpers.thorough import amount
from pn2code.cli.main import app
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.robot.transforms import Array
from pn2code.run.cell import run_cell
from pn2code.run.engine import Engine
from pn2code.run.prepare import RunOptions
from pn2code.run.results import RunResult
from pn2code.trace.replay import replay

pytestmark = pytest.mark.usefixtures("quick_build", "generated_once")

TOLERANCE_MM = 1e-6
# Condition numbers of robot 2 at the seven rivets in the paper's place for it.
PAPER_CONDITIONS = (13.9, 14.2, 15.2, 16.9, 20.0, 26.9, 102)


@dataclass
class Noses:
    """Watches how far apart the TCPs are while the drill works (mm)."""

    gaps: list[float] = field(default_factory=list)

    def begun(self, engine: Engine) -> None: ...

    def advanced(self, engine: Engine) -> None: ...

    def ended(self, engine: Engine) -> None: ...

    def sampled(self, engine: Engine, t: float, joints: Mapping[str, Array]) -> None:
        if any(r.tool_action() == "drill" for r in engine.robots):
            tips = []
            for name, q in joints.items():
                robot = engine.cell.robot(name)
                tips.append((robot.T_world_base @ robot.kinematics.forward(q))[:3, 3])
            self.gaps.append(float(np.linalg.norm(tips[0] - tips[1])) * 1000.0)


def run(root: Path, out: Path, layout: str, backend: str) -> tuple[RunResult, Noses]:
    d = Diagnostics()
    noses = Noses()
    options = RunOptions(out=out, layout=layout, backend=backend)  # type: ignore[arg-type]
    result = run_cell(root / "examples/riveting", options, d, [noses])
    assert result is not None, [e.message for e in d.errors]
    return result, noses


@pytest.fixture(scope="module", params=["paper", "good"][: amount(1, 2)])
def bullet_run(
    request: pytest.FixtureRequest, root: Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[str, Path, RunResult, Noses]:
    """One whole run in PyBullet for each layout; `test_bullet_path` goes along the good one each time."""
    out = tmp_path_factory.mktemp(request.param)
    result, noses = run(root, out, request.param, "bullet")
    return request.param, out, result, noses


@pytest.mark.cc
@pytest.mark.bullet
class TestWholeRun:
    """Both layouts; one run each, looked at from all sides."""

    def test_finishes_without_collision(
        self, bullet_run: tuple[str, Path, RunResult, Noses]
    ) -> None:
        _, _, result, _ = bullet_run
        assert (result.record.verdict, result.record.reason) == ("finished", "")
        assert result.summary["counts"]["rivets"] == 7
        assert result.summary["rows"] == 22
        for name, entry in result.summary["clearances"].items():
            assert entry["m"] > 0.0, name

    def test_rows_are_table_2_digit_for_digit(
        self, bullet_run: tuple[str, Path, RunResult, Noses]
    ) -> None:
        _, out, _, _ = bullet_run
        lines = (out / "rows.tsv").read_text().splitlines()
        expected = [[str(k), *row] for k, row in enumerate(table_2(), 1)]
        assert [line.split("\t") for line in lines] == expected

    def test_tcp_is_where_it_was_commanded(
        self, bullet_run: tuple[str, Path, RunResult, Noses]
    ) -> None:
        _, _, result, noses = bullet_run
        assert result.record.accuracy["TCP off the commanded pose"] < TOLERANCE_MM
        assert result.record.accuracy["off the line on linear moves"] < TOLERANCE_MM
        assert len(noses.gaps) >= 7
        assert max(noses.gaps) < TOLERANCE_MM

    def test_conditioning(self, bullet_run: tuple[str, Path, RunResult, Noses]) -> None:
        layout, _, result, _ = bullet_run
        at = result.summary["conditioning"]["robot2"]["at_rivets"]
        texts = [w["text"] for w in result.summary["warnings"]]
        if layout == "paper":
            assert at == pytest.approx(PAPER_CONDITIONS, rel=0.005)
            assert [t for t in texts if "close to a singularity" in t and "elbow 7.9 deg" in t]
        else:
            assert 8.3 < min(at) <= max(at) < 8.9
            assert not [t for t in texts if "singularity" in t]

    def test_trace_is_an_occurrence_sequence_of_the_net(
        self, root: Path, bullet_run: tuple[str, Path, RunResult, Noses]
    ) -> None:
        """Supervisor (compiled C) and robots (interpreted scripts), replayed by the token game."""
        _, out, result, _ = bullet_run
        net = load(root / "examples/riveting/cell.cpn", Diagnostics())
        assert net is not None
        config = result.prepared.config
        found = replay(out / "cell.trace.jsonl", net, storage=config.storage)
        assert found.ok, found.message
        occurred = [e for e in result.record.events if "transition" in e]
        assert found.steps == len(occurred) > 300
        assert found.ended == "finished"

    def test_trace_is_drawn_on_the_pages(
        self, bullet_run: tuple[str, Path, RunResult, Noses], root: Path, tmp_path: Path
    ) -> None:
        _, out, _, _ = bullet_run
        page = tmp_path / "steps.html"
        cell, trace = str(root / "examples" / "riveting"), str(out / "cell.trace.jsonl")
        done = CliRunner().invoke(app, ["draw", cell, "--trace", trace, "-o", str(page)])
        assert done.exit_code == 0, done.output
        assert "Cell.Supervisor" in page.read_text(encoding="utf-8")

    def test_a_falsified_trace_is_refused(
        self, root: Path, tmp_path: Path, bullet_run: tuple[str, Path, RunResult, Noses]
    ) -> None:
        """The replay can say no: one occurrence left out."""
        _, out, result, _ = bullet_run
        lines = (out / "cell.trace.jsonl").read_text().splitlines(keepends=True)
        at = next(i for i, line in enumerate(lines) if "Robot1.Accept" in line)
        step = json.loads(lines[at])["step"]
        rest = [_earlier(line, step) for line in lines[at + 1 :]]
        broken = tmp_path / "broken.trace.jsonl"
        broken.write_text("".join(lines[:at] + rest))
        net = load(root / "examples/riveting/cell.cpn", Diagnostics())
        assert net is not None
        found = replay(broken, net, storage=result.prepared.config.storage)
        assert not found.ok
        assert "Robot1" in found.transition


def _earlier(line: str, step: int) -> str:
    """A line of a trace with its number lowered by one, if it is after a step: none seems to be missing."""
    number = json.loads(line).get("step", 0)
    return line.replace(f'"step": {number}', f'"step": {number - 1}') if number > step else line


@pytest.mark.cc
@pytest.mark.bullet
def test_two_runs_and_two_backends_give_the_same_trace(
    root: Path, tmp_path: Path, bullet_run: tuple[str, Path, RunResult, Noses]
) -> None:
    layout, out, _, _ = bullet_run
    run(root, tmp_path / "again", layout, "fake")
    for file in ("cell.trace.jsonl", "rows.tsv", "supervisor.trace.jsonl"):
        assert (tmp_path / "again" / file).read_bytes() == (out / file).read_bytes()
