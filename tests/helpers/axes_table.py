"""The axes of an arm as a row of the table in docs/robots.md: where a larger number takes each, and how far.

row("cobra_s600")   # "| `cobra_s600` | +z, -105 .. 105 | +z, -150 .. 150 | slides -z, 0 .. 0.21 m | ... |"
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.model import Arm, find_arm

MOST_AXES = 7
DIRECTIONS = {(1, 0, 0): "+x", (0, 1, 0): "+y", (0, 0, 1): "+z"}
DIRECTIONS |= {tuple(-x for x in v): name.replace("+", "-") for v, name in DIRECTIONS.items()}


def row(name: str) -> str:
    """Of an arm that comes with pn2code."""
    d = Diagnostics()
    arm = find_arm(name, Path(), Origin("cell.toml"), d)
    assert arm is not None and not d.has_errors
    cells = [_cell(arm, i, v) for i, v in enumerate(_directions(arm))]
    cells += [""] * (MOST_AXES - len(cells))
    return f"| `{name}` | {' | '.join(cells)} |".replace("|  |", "| |").replace("|  |", "| |")


def _directions(arm: Arm) -> list[tuple[int, ...]]:
    """Of each axis in the frame of the base, all axes at zero as the maker counts."""
    rotation = np.eye(3)
    found = []
    for joint in arm.chain:
        rotation = rotation @ joint.T_parent_joint[:3, :3]
        if joint.type != "fixed":
            along = rotation @ np.asarray(joint.axis)
            assert np.allclose(along, np.round(along), atol=1e-9)
            found.append(tuple(int(x) for x in np.round(along)))
    return found


def _cell(arm: Arm, axis: int, direction: tuple[int, ...]) -> str:
    low, high = float(arm.lower[axis]), float(arm.upper[axis])
    for i, _, c in arm.coupled():
        if i == axis:
            low, high = c.lower, c.upper
    where = DIRECTIONS[direction]
    if arm.slides(axis):
        return f"slides {where}, {low:g} .. {high:g} m"
    return f"{where}, {np.degrees(low):.4g} .. {np.degrees(high):.4g}"
