"""What holds between samples of moves with external axes: no point of a link is further off than the spread."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest

from helpers.robot_cells import pose_mm
from helpers.thorough import amount
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.tracks import ArmShape, Track
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveExternal, MoveHome, MoveJoint, MoveLinear
from unit.geometry.test_spreads import corners
from unit.robot.test_external_axes import CELL, SEAM, moves_on_plate, plate, rail

pytestmark = pytest.mark.bullet


@pytest.fixture(scope="module")
def shape() -> ArmShape:
    backend = BulletBackend(CELL, looks=False)
    found = ArmShape.of(CELL.robots[0], backend)
    backend.close()
    return found


def legs() -> list[Leg]:
    planner = Planner(CELL)
    home = planner.home("left")
    over = planner.leg(home, MoveJoint(SEAM, frame="seam", along=(plate(10.0), rail(0.2))))
    led = [planner.leg(over.end, command) for command in moves_on_plate()]
    tool = MoveLinear(pose_mm(30.0, 20.0, -90.0, 5.0), "tool", along=(rail(0.4),))
    others = [
        planner.leg(home, MoveExternal((rail(1.7), plate(-100.0)))),
        planner.leg(over.end, tool),
        planner.leg(led[2].end, MoveHome()),
    ]
    out = [over, *led, *others]
    assert [x.fault for x in out] == [None] * len(out)
    return out


@pytest.mark.parametrize("number", range(amount(4, 9)))
def test_no_point_is_further_off_than_the_spread(shape: ArmShape, number: int) -> None:
    leg = legs()[number]
    assert leg.path is not None
    track = Track(shape, leg)
    choice = Random(number)
    known = 0
    for _ in range(40):
        size = 2.0 ** -choice.randint(0, 9)
        a = choice.random() * (1.0 - size)
        knots = track.knots(np.array([a]), np.array([a + size]))
        if not np.isfinite(knots.spread).all():
            continue
        known += 1
        within = leg.path.on_way(np.linspace(a, a + size, 40))
        off = np.linalg.norm(corners(track, within) - corners(track, knots.q), axis=3)
        assert (off.max(axis=(0, 2)) <= knots.spread[0] + 1e-9).all()
    assert known > 10


def test_a_plate_moves_with_nothing_but_itself(shape: ArmShape) -> None:
    moved = {link.name: shape.moved(link).tolist() for link in shape.links}
    assert moved["left/plate"] == [False] * 7 + [True]
    assert moved["left/base_link"] == [True] + [False] * 7
    assert moved["left/link_6"] == [True] * 7 + [False]


def test_the_kinematics_are_those_of_the_collision_library() -> None:
    backend = BulletBackend(CELL, looks=False)
    robot = CELL.robots[0]
    choice = np.random.default_rng(3)
    for _ in range(20):
        q = choice.uniform(robot.arm.lower, robot.arm.upper)
        backend.set_joints("left", q)
        ours = robot.T_world_base @ robot.kinematics.forward(q)
        assert np.abs(backend.tcp("left") - ours).max() < 1e-5
    backend.close()


def test_a_tool_in_the_work_piece_on_the_plate_is_seen() -> None:
    """And is permitted where a contact rule says so."""
    backend = BulletBackend(CELL, looks=False)
    planner = Planner(CELL)
    deep = MoveJoint(pose_mm(0.0, 0.0, -20.0, 180.0), frame="seam", along=(rail(0.2),))
    leg = planner.leg(planner.home("left"), deep)
    backend.set_joints("left", leg.end.q)
    near = {(c.a, c.b): c.distance for c in backend.distances.pairs("self", "left", 0.1)}
    touching = [pair for pair, distance in near.items() if distance < -0.01]
    assert touching and all("left/plate" in pair for pair in touching)
    assert any(c.kind == "self" and c.distance < -0.01 for c in backend.clearances(0.5) or ())
    turned = np.array(leg.end.q)
    turned[-1] += math.pi / 2.0
    backend.set_joints("left", turned)
    assert backend.distances.pairs("self", "left", 0.1)
    backend.close()
