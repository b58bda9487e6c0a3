"""How deep things overlap, and how near they come: what is said holds between samples, and is nearly reached."""

from __future__ import annotations

import math
import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from helpers.robot_cells import nowhere, pose_mm
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.met_pairs import touch_in_words
from pn2code.geometry.shown import Shown
from pn2code.geometry.tracks import Track
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveJoint, MoveLinear
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

pytestmark = pytest.mark.bullet

DATA = """
[robots.left]
model = "kr120_r2500"
base = { x = 0.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
[robots.right]
model = "kr120_r2500"
base = { x = 3.2, yaw = 180.0 }
home = [0.0, -90.0, 90.0, 0.0, 90.0, 0.0]
[scene]
objects = [{ name = "post", size = [0.1, 0.1, 1.4], pose = { x = 1.7, y = -0.6, z = 0.7 } }]
"""


@cache
def cell() -> RobotCell:
    d = Diagnostics()
    found = load(tomllib.loads(DATA), Path(), nowhere, d)
    assert found is not None, [x.message for x in d]
    return found


def line(planner: Planner, robot: str, x: float, y: float) -> Leg:
    """Across, 1.2 m, at the height of 1 m; in the world."""
    begin = planner.leg(planner.home(robot), MoveJoint(pose_mm(x, -y, 1000.0, 180.0)))
    leg = planner.leg(begin.end, MoveLinear(pose_mm(x, y, 1000.0, 180.0), "world"))
    assert leg.fault is None and leg.path is not None
    return leg


def grid(leg: Leg, count: int) -> np.ndarray:
    assert leg.path is not None
    return leg.path.on_way(np.linspace(0.0, 1.0, count))


@pytest.mark.parametrize("x", [1550.0, 1200.0])
def test_two_arms(x: float) -> None:
    backend = BulletBackend(cell(), looks=False)
    planner = Planner(cell())
    one, other = line(planner, "left", x, 500.0), line(planner, "right", 1700.0, 400.0)
    compared = Comparison(cell(), planner, Shown(backend))
    first = compared.two((one, ()), (other, ()))
    found = compared.deepest(first)
    distances = []
    for q in grid(one, 11):
        backend.set_joints("left", q)
        for p in grid(other, 11):
            backend.set_joints("right", p)
            distances += [
                c.distance for c in backend.distances.pairs("robots", "left", 0.5, "right")
            ]
    nearest = compared.nearest()
    backend.close()
    if x > 1400.0:
        assert first.outcome == "touch" and not first.is_whole and first.where is not None
        assert found.outcome == "touch" and found.where is not None and nearest is None
        assert found.is_whole and found.where.distance <= first.where.distance < 0.0
        said = touch_in_words(first)
        assert "overlap by at least" in said and "was not searched for" in said
        assert found.least <= min(distances) and found.where.distance <= 0.85 * min(distances)
        assert -found.least <= 2.0 * -found.where.distance
        assert "and nowhere on the way by more than" in touch_in_words(found)
    else:
        assert first is found and found.outcome == "clear" and nearest is not None
        assert nearest.least <= min(distances) and nearest.where.distance <= min(distances) / 0.85
        assert nearest.least >= 0.2 * nearest.where.distance


def test_an_arm_and_what_stands() -> None:
    backend = BulletBackend(cell(), looks=False)
    planner = Planner(cell())
    leg = line(planner, "left", 1550.0, 700.0)
    found, _ = Comparison(cell(), planner, Shown(backend)).around(leg, ())
    distances = []
    for q in grid(leg, 100):
        backend.set_joints("left", q)
        distances += [c.distance for c in backend.distances.pairs("scene", "left", 0.1)]
    backend.close()
    assert found.outcome == "touch" and found.where is not None
    assert found.least <= min(distances) and found.where.distance <= 0.85 * min(distances)
    assert -found.least <= 1.2 * -found.where.distance + 2e-3


def test_where_nothing_is_known_between_samples_no_depth_is_certain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    backend = BulletBackend(cell(), looks=False)
    planner = Planner(cell())
    one, other = line(planner, "left", 1550.0, 700.0), line(planner, "right", 1700.0, 400.0)
    compared = Comparison(cell(), planner, Shown(backend))
    monkeypatch.setattr(Track, "trouble", "it passes near to a singularity")
    two = compared.deepest(compared.two((one, ()), (other, ())))
    for found in (compared.around(one, ())[0], two):
        assert found.outcome == "touch" and found.nearest < 0.0 and found.least == -math.inf
        assert touch_in_words(found).endswith("how deep on the rest of the way is not known")
    backend.close()
