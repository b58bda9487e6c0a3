"""`pn2code reach`: what an arm reaches from other bases is what it reaches when it stands there."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.meeting_cell import meeting_cell
from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.base.how_far import listening
from pn2code.cli.main import app
from pn2code.geometry.reach_map import Task, reach_map
from pn2code.robot.commands import MoveJoint
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.transforms import matrix_of

pytestmark = [pytest.mark.cc, pytest.mark.usefixtures("quick_build")]


def test_poses_are_reached_where_an_executor_reaches_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cell = riveting_cell("paper")
    robot = cell.robot("robot2")
    choice = Random(4)
    poses = [
        pose_mm(choice.uniform(5500, 7000), choice.uniform(5600, 6300), 2100.0, 75.0)
        for _ in range(12)
    ]
    task = Task(np.stack([matrix_of(p) for p in poses]), tuple(slice(i, i + 1) for i in range(12)))
    bases = np.array([[choice.uniform(5, 7.5), choice.uniform(7.5, 9.2)] for _ in range(40)])
    said: list[str] = []
    monkeypatch.setattr("pn2code.geometry.reach_map._AT_ONCE", 1)
    monkeypatch.setattr("pn2code.base.how_far.PERIOD_S", 0.0)
    with listening(said.append):
        found = reach_map(robot, task, bases)
    assert said[-1].startswith("moving robot2: 40 of 40, ") and "about 0 s left" in said[-1]
    some = set()
    for i, (x, y) in enumerate(bases):
        there = replace(robot, base=replace(robot.base, x=x, y=y))
        count = 0
        for pose in poses:
            try:
                RobotExecutor(there, cell.motion).reach(MoveJoint(pose))
                count += 1
            except MotionFault:
                pass
        assert found.reach[i] == pytest.approx(count / 12)
        some.add(count)
    assert len(some) > 4


def test_the_paper_s_robot_comes_close_to_its_singularity(root: Path, tmp_path: Path) -> None:
    cell = root / "examples" / "riveting"
    arguments = ["reach", str(cell), "--layout", "paper", "--robot", "robot2", "--steps", "7"]
    result = CliRunner().invoke(app, [*arguments, "-o", str(tmp_path), "--json"])
    assert result.exit_code == 0, result.output
    (found,) = json.loads(result.stdout)
    assert found["robot"] == "robot2" and found["moves"] == 22 and found["open"] is None
    here, best = found["here"], found["best"]
    assert here["reach"] == 1.0 and 100.0 < here["condition"] < 105.0
    assert best["reach"] == 1.0 and best["condition"] < 15.0
    assert len(found["bases"]) == 49
    assert Path(found["picture"]).is_file()
    table = (tmp_path / "robot2.reach.tsv").read_text().splitlines()
    assert table[0].split("\t") == ["x", "y", "reach", "condition", "limit_deg"]
    assert len(table) == 50


def test_what_is_asked_of_it(tmp_path: Path) -> None:
    cell = meeting_cell(tmp_path / "cell", guarded=True)
    run = CliRunner()
    arguments = ["reach", str(cell), "--steps", "3", "-o", str(tmp_path / "out")]
    result = run.invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert result.stdout.count("where it stands") == 2
    result = run.invoke(app, [*arguments, "--robot", "robot3"])
    assert result.exit_code == 1
    assert "reach-unknown" in result.stderr and "`robot2`" in result.stderr
    (cell / "cell.toml").unlink()
    result = run.invoke(app, ["reach", str(cell / "cell.cpn"), "-o", str(tmp_path / "out")])
    assert result.exit_code == 1 and "geometry-no-cell" in result.stderr
