"""A joint move that ends with the elbow in the table: which other branches there are is told, and what chooses one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from helpers import carrying_cell
from pn2code.cli.main import app

pytestmark = [pytest.mark.cc, pytest.mark.bullet, pytest.mark.usefixtures("quick_build")]

NET = carrying_cell.NET.replace(
    "(fetch (); go (slot n); release (); moveLinear (up (slot n)))",
    "(moveJoint (at (500.0, 0.0, 750.0)); moveHome ())",
)
TABLE = "size = [0.4, 0.4, 0.5], pose = { x = 1.5, y = -0.6, z = 0.25 }"
ARM = carrying_cell.TOML.index('model = "kr120'), carrying_cell.TOML.index("[devices.feeder]")
TOML = (
    carrying_cell.TOML[: ARM[0]]
    + 'model = "ur5e"\nbase = { z = 0.5 }\nhome = [-15.0, -20.0, -73.0, 3.0, -90.0, 75.0]\n'
    + carrying_cell.TOML[ARM[1] :]
).replace(TABLE, "size = [0.5, 0.8, 0.5], pose = { x = 0.55, z = 0.25 }")


def moves(folder: Path, toml: str) -> list[dict[str, Any]]:
    carrying_cell.write(folder, NET, toml)
    done = CliRunner().invoke(app, ["check", "--geometry", "--json", str(folder)])
    found: list[dict[str, Any]] = json.loads(done.stdout)["layouts"][0]["moves"]
    return [m for m in found if m["robot"] == "robot"]


def test_other_branches_are_told(tmp_path: Path) -> None:
    problems = [m["problem"] for m in moves(tmp_path / "first", TOML) if m["kind"] == "ptp"]
    (problem,) = (p for p in problems if "branch" in p)
    assert (
        "overlap by" in problem and "it ends in branch front/down/minus; branches that" in problem
    )
    assert "front/up/minus" in problem and "(`branch` of the robot in cell.toml" in problem
    chosen = TOML.replace('model = "ur5e"\n', 'model = "ur5e"\nbranch = "front/up/minus"\n')
    assert {m["answer"] for m in moves(tmp_path / "chosen", chosen)} == {"yes"}
