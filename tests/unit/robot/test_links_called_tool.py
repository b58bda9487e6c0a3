"""Links of an arm whose names begin as those of its tool: they are not the tool, and none has two meanings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import model
from pn2code.robot.placed_links import tool_links
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.scene import load
from pn2code.robot.tool_contacts import end_links

pytest.importorskip("eaik")  # the solver of the arm, which does not come with every Python

ARM = Path(model.__file__).parent / "models" / "ur5e.urdf"


def _loaded(folder: Path, forearm: str, d: Diagnostics) -> CellRobot | None:
    """An arm whose forearm has another name, with a gripper."""
    text = ARM.read_text(encoding="utf-8").replace('"link_3"', f'"{forearm}"')
    (folder / "own.urdf").write_text(text, encoding="utf-8")
    robot: dict[str, Any] = {
        "model": "own.urdf",
        "tool": "vacuum_gripper",
        "base": {"z": 0.5},
        "home": [0, -90, 90, -90, -90, 0],
    }
    cell = load({"robots": {"arm": robot}}, folder, lambda *_: Origin("cell.toml"), d)
    return None if cell is None else cell.robots[0]


def test_a_forearm_is_no_tool(tmp_path: Path) -> None:
    """What the arm carries must not touch it, nor may tools that lie in their racks."""
    robot = _loaded(tmp_path, "tool_side", Diagnostics())
    assert robot is not None
    assert "tool_side" in robot.arm.urdf.links
    assert "tool_side" not in {*end_links(robot), *tool_links(robot)}
    assert {*tool_links(robot)} < {*end_links(robot)}


@pytest.mark.parametrize("link", ["tool_tcp"])
def test_no_link_of_an_arm_is_called_as_one_of_its_tool(tmp_path: Path, link: str) -> None:
    d = Diagnostics()
    _loaded(tmp_path, link, d)
    assert [e.message for e in d.errors if "the name that `tcp` of the tool gets" in e.message]
