"""What stands on a part that a tool carries: it goes along, as long as that stays level.

    tilted(robot, q, parts)         # "`arm` tilts `box.2` by 12.3 deg, ...", "": nothing leans too far

It only lies there, so how far it may lean is a matter of friction: 10 degrees are a coefficient of 0.18.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from pn2code.robot.part import Part, carried_to
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.transforms import Array

MOST_TILT = math.radians(10.0)
_ROUNDING = 1e-9
"""Rounding (rad): what leans by just as much as is allowed stays, on every processor."""


def riding(parts: Iterable[Part], robot: str) -> list[Part]:
    """What stands on the part that a robot carries."""
    return [p for p in parts if p.holder == robot and p.up is not None]


def tilt(part: Part, frame: Array) -> float:
    """How far (rad) a part leans at `T_world_part` from how it stood when it was taken along."""
    assert part.up is not None, "it stands on another one"
    return math.acos(min(1.0, max(-1.0, float(frame[2, :3] @ part.up))))


def tilted(robot: CellRobot, q: Array, parts: Iterable[Part]) -> str:
    """That something leans too far on what a robot at `q` carries, for people; "": nothing does."""
    for part in riding(parts, robot.name):
        leans = tilt(part, carried_to(robot, np.asarray(q), part))
        if leans > MOST_TILT + _ROUNDING:
            return leaning(robot.name, part.name, leans)
    return ""


def leaning(robot: str, part: str, leans: float) -> str:
    """In words."""
    return (
        f"`{robot}` tilts `{part}` by {math.degrees(leans):.1f} deg, which only stands on what it carries (at most "
        f"{math.degrees(MOST_TILT):g} deg)"
    )
