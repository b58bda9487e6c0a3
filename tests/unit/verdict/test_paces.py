"""The speed that a line or an arc of an arm never comes to."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from helpers.tool_cell import TOML, placed
from pn2code.verdict.paces import most


def test_no_way_within_reach_is_longer(tmp_path: Path) -> None:
    cell, d = placed(tmp_path, TOML)
    assert cell is not None, [e.message for e in d.errors]
    arm = cell.robot("arm")
    line, arc = (most(arm, cell.motion, is_arc=x) for x in (False, True))
    ends = np.random.default_rng(1).uniform(arm.arm.lower, arm.arm.upper, (200, 6))
    places = [
        (arm.kinematics.forward(q) @ tool.tool.T_flange_tcp)[:3, 3]
        for q in ends
        for tool in arm.tools.values()
    ]
    across = max(float(np.linalg.norm(a - b)) for a in places for b in places)
    assert 3.0 < across < line.way < 2.0 * across
    assert line.speed == pytest.approx(math.sqrt(cell.motion.linear_acceleration * line.way))
    assert arc.way == pytest.approx(math.pi * line.way)
