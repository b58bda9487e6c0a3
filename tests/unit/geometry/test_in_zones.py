"""An arm on its way is in a zone, or not, only as `InZones` says; and it says both only where both may be."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import numpy as np
import pytest

from helpers.robot_cells import riveting_cell
from pn2code.geometry.in_zones import InZones
from pn2code.geometry.legs import Planner
from pn2code.robot.commands import MoveAxes, MoveLinear, Pose
from pn2code.robot.zones import ZoneWatch
from pn2code.robot.zones_table import Zone


def zone(random: Random, around: np.ndarray) -> Zone:
    x, y, z = (float(v) + random.uniform(-0.6, 0.6) for v in around)
    size = (random.uniform(0.1, 0.8), random.uniform(0.1, 0.8), random.uniform(0.1, 0.8))
    return Zone("here", Pose(x, y, z, 0.3, 0.0, random.uniform(-3.0, 3.0)), size)


@pytest.mark.parametrize("seed", [2])
def test_it_says_what_is_seen_on_the_way(seed: int) -> None:
    random = Random(seed)
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    planner = Planner(cell)
    home = planner.home("robot1")
    turned = np.array(robot.home) + np.array([random.uniform(-0.4, 0.4) for _ in robot.home])
    far = planner.leg(home, MoveAxes(tuple(turned.tolist())))
    step = Pose(*(random.uniform(-0.1, 0.1) for _ in range(3)), 0.0, 0.0, 0.0)
    line = planner.leg(far.end, MoveLinear(step, "tool"))
    middle = (robot.T_world_base @ robot.kinematics.forward(robot.home))[:3, 3]
    both = 0
    for _ in range(3):
        own = zone(random, middle)
        seen = replace(cell, zones={"here": own})
        watch, zones = ZoneWatch(seen), InZones(seen)
        for leg in (far, line, planner.standing(home)):
            if leg.path is None:
                continue
            there = {
                watch.occupied("here", {"robot1": q}, ())
                for q in leg.path.on_way(np.linspace(0.0, 1.0, 15))
            }
            said = zones.answers("here", leg, ())
            assert there <= said
            assert said == there or leg.is_moving
            both += len(said) == 2
    assert both < 8
