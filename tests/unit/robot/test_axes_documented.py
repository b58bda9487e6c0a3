"""docs/robots.md says of each arm where a larger number takes each axis, and how far; what it gives as HOME is so."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers.axes_table import row
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import find_arm, known_arms


def kinematics(name: str) -> Kinematics:
    d = Diagnostics()
    arm = find_arm(name, Path(), Origin("cell.toml"), d)
    assert arm is not None
    found = Kinematics.of(arm, None, Origin("cell.toml"), d)
    assert found is not None, list(d)
    return found


@pytest.mark.parametrize("name", known_arms())
def test_the_axes_of_each_arm_are_documented(root: Path, name: str) -> None:
    lines = (root / "docs" / "robots.md").read_text(encoding="utf-8").split("\n")
    assert row(name) in lines, f"a line of the table in docs/robots.md should be\n{row(name)}"


@pytest.mark.parametrize("name", [n for n in known_arms() if not n.startswith("ur")])
def test_a_larger_number_goes_where_the_table_says(name: str) -> None:
    """What moves is the flange: a slide goes along the direction, a turn is about it."""
    k = kinematics(name)
    arm = k.arm
    directions = {"x": 0, "y": 1, "z": 2}
    for i, cell in enumerate(x.strip() for x in row(name).split("|")[2 : 2 + len(arm.axes)]):
        sign, letter = cell.removeprefix("slides ")[:2]
        along = np.zeros(3)
        along[directions[letter]] = 1.0 if sign == "+" else -1.0
        q = np.zeros(len(arm.axes))
        before = k.forward(q)
        q[i] = 0.01
        after = k.forward(q)
        if arm.slides(i):
            assert np.allclose(after[:3, 3] - before[:3, 3], 0.01 * along, atol=1e-9)
        else:
            turned = after[:3, :3] @ before[:3, :3].T
            twist = np.array([turned[2, 1], turned[0, 2], turned[1, 0]])
            assert np.allclose(twist, np.sin(0.01) * along, atol=1e-9)


def test_home_of_the_arms_with_four_axes(root: Path) -> None:
    """As docs/robots.md and docs/tutorial.md give them."""
    robots = (root / "docs" / "robots.md").read_text(encoding="utf-8")
    tutorial = (root / "docs" / "tutorial.md").read_text(encoding="utf-8")
    assert "`home = [1.5, 0.0, 0.2, 0.0]` is the middle of `gantry_3000`" in robots
    gantry = kinematics("gantry_3000")
    assert np.allclose(gantry.forward(np.array([1.5, 0.0, 0.2, 0.0]))[:3, 3], (1.5, 0.0, 1.55))
    assert "home = [0.0, 90.0, 0.05, 0.0]" in robots and "[0.0, 90.0, 0.05, 0.0]" in tutorial
    q = np.array([0.0, np.radians(90.0), 0.05, 0.0])
    scara = kinematics("cobra_s600")
    assert np.allclose(scara.forward(q)[:3, 3], (0.325, 0.275, 0.337))
    assert 'branch = "left"' in tutorial
    assert str(scara.branch_of(q)) == "left"
