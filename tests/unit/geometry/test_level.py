"""What stands on a part that a tool carries leans nowhere on the way by more than may be, or that is said."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

import numpy as np
import pytest

from helpers.robot_cells import riveting_cell
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.level import level
from pn2code.robot.commands import MoveAxes, MoveLinear, Pose
from pn2code.robot.part import Part, carried_to
from pn2code.robot.parts_table import PartKind
from pn2code.robot.riders import MOST_TILT, tilt
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.scene_objects import SceneObject

NOWHERE = Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
BOX = PartKind("box", SceneObject("box", "box", NOWHERE, size=(0.1, 0.1, 0.1)))


def rider(robot: CellRobot) -> Part:
    """A box on what the robot carries, upright where it stands at HOME."""
    there = robot.T_world_base @ robot.kinematics.forward(robot.home)
    part = Part("box.1", BOX, np.eye(4), robot.name)
    return replace(part, up=there[2, :3].copy())


def leans(robot: CellRobot, leg: Leg, part: Part) -> float:
    assert leg.path is not None
    way = leg.path.on_way(np.linspace(0.0, 1.0, 200))
    return max(tilt(part, carried_to(robot, q, part)) for q in way)


@pytest.mark.parametrize("seed", range(20))
def test_what_is_said_is_what_is_so_on_the_way(seed: int) -> None:
    random = Random(seed)
    cell = riveting_cell("good")
    robot, planner = cell.robot("robot1"), Planner(cell)
    part = rider(robot)
    turned = np.array(robot.home)
    for axis in random.sample(range(6), 2):
        turned[axis] += math.radians(random.choice([2.0, 9.0, 11.0, 25.0]))
    leg = planner.leg(planner.home("robot1"), MoveAxes(tuple(turned.tolist())))
    assert leg.path is not None
    answer, why = level(robot, leg, (part,))
    assert answer == ("yes" if leans(robot, leg, part) <= MOST_TILT else "no"), why
    assert ("tilts `box`" in why) is (answer == "no")


@pytest.mark.parametrize(
    ("degrees", "answer"), [(0.0, "yes"), (9.9, "yes"), (10.1, "no"), (10.0, "unknown")]
)
def test_a_line_turns_as_far_as_it_says(degrees: float, answer: str) -> None:
    cell = riveting_cell("good")
    robot, planner = cell.robot("robot1"), Planner(cell)
    home = planner.home("robot1")
    aside = Pose(0.0, 0.0, -0.05, math.radians(degrees), 0.0, 0.0)
    leg = planner.leg(home, MoveLinear(aside, "tool"))
    assert leg.path is not None, leg.fault
    part = rider(robot)
    # About the x of its tool: it leans by so much if that is level.
    flat = abs((robot.T_world_base @ home.T_base_tcp)[2, 0]) < 1e-9
    assert flat
    said, _ = level(robot, leg, (part,))
    assert said == answer
