"""Links that the collision library is not asked about are further apart than is asked for: nothing else is left out."""

from __future__ import annotations

import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from tools.geometry.pairs import facing, moves

from helpers.carrying_cell import TOML
from helpers.robot_cells import nowhere
from helpers.thorough import amount
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.legs import Planner
from pn2code.geometry.pieces import Own, gaps, near
from pn2code.geometry.tracks import ArmShape, Track
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, MoveExternal
from pn2code.robot.part import Part
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import translation

pytestmark = pytest.mark.bullet
LIMITS = (1e-5, 0.02, 0.1, 0.5)


def carrying() -> RobotCell:
    """An arm with a turntable."""
    data = tomllib.loads(TOML)
    pose = {"x": 1.2, "y": 0.3, "z": 0.4}
    data["robots"]["robot"]["axes"] = {
        "plate": {"kind": "turntable", "pose": pose, "from": -200.0, "to": 200.0, "radius": 0.4}
    }
    d = Diagnostics()
    cell = load(data, Path(), nowhere, d)
    assert cell is not None, [x.message for x in d]
    return cell


def pieces(count: int) -> list[tuple[float, float]]:
    """Halves of halves of a way."""
    edges = np.linspace(0.0, 1.0, count + 1)
    return list(pairwise(edges.tolist()))


def test_of_two_arms() -> None:
    """What is found between the links that may be near is what is found between all, in the same order."""
    cell = facing("dense")
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    left, right = (
        [Track(ArmShape.of(cell.robot(r), backend), leg) for leg in moves(planner, r, "dense", 5)]
        for r in ("left", "right")
    )
    skipped = found = 0
    for a, b in zip(left, right, strict=True):
        for x, y in zip(pieces(16), reversed(pieces(16)), strict=True):
            one, other = (t.knots(*np.array([[p], [q]])) for t, (p, q) in ((a, x), (b, y)))
            backend.set_joints("left", one.q[0])
            backend.set_joints("right", other.q[0])
            gap = gaps(one, a.radii, other, b.radii)[0]
            for limit in LIMITS:
                some = near(gap, limit, list(a.names), list(b.names))
                whole = backend.distances.pairs("robots", "left", limit, "right")
                assert backend.distances.pairs("robots", "left", limit, "right", near=some) == whole
                assert {(c.a, c.b) for c in whole} <= some
                skipped += gap.size - len(some)
                found += len(whole)
            for c in backend.distances.pairs("robots", "left", 2.0, "right"):
                assert c.distance >= gap[a.names[c.a], b.names[c.b]]
    backend.close()
    assert found > 100 and skipped > 1000


@pytest.mark.parametrize("is_loaded", [False, True])
def test_of_one_arm_with_what_it_carries(is_loaded: bool) -> None:
    cell = carrying()
    backend = BulletBackend(cell, looks=False)
    robot = cell.robot("robot")
    shape = ArmShape.of(robot, backend)
    (kind,) = cell.parts.values()
    held = Part("held", kind, translation(0.0, 0.0, 0.1), holder="robot")
    placed = Part("placed", kind, translation(0.1, 0.0, 0.1), plate="robot/plate")
    parts = (held, placed) if is_loaded else ()
    for part in parts:
        backend.set_part(part)
    links = tuple(shape.holding(p, *backend.part_box(p.kind)) for p in parts)
    planner = Planner(cell)
    turn = MoveExternal((Along("plate", 1.5, is_track=False),))
    leg = planner.leg(planner.home("robot"), turn)
    assert leg.path is not None, leg.fault
    track = Track(shape, leg, links, parts)
    own, skipped, found = Own(track), 0, 0
    for a, b in pieces(amount(8, 64)):
        knots = track.knots(np.array([a]), np.array([b]))
        backend.set_joints("robot", knots.q[0])
        for limit in LIMITS:
            some = own.near(a, b, limit)
            whole = backend.distances.pairs("self", "robot", limit)
            assert backend.distances.pairs("self", "robot", limit, near=some) == whole
            assert {(c.a, c.b) for c in whole} <= some
            skipped += track.radii.size * (track.radii.size - 1) - len(some)
    # The same at random joint positions: what capsules say is never more than what is measured.
    choice = np.random.default_rng(5)
    lower, upper = robot.arm.lower, robot.arm.upper
    q = choice.uniform(lower, upper, (amount(60, 2000), len(lower)))
    knots = track._placed(q, np.zeros(q.shape), None, np.zeros(len(q), bool))
    for row in range(len(q)):
        backend.set_joints("robot", q[row])
        gap = gaps(knots.only(row), track.radii, knots.only(row), track.radii)[0]
        whole = backend.distances.pairs("self", "robot", 1.0)
        for c in whole:
            assert c.distance >= gap[track.names[c.a], track.names[c.b]] - 1e-9
        for limit in LIMITS:
            some = near(gap, limit, list(track.names), list(track.names))
            some |= {(y, x) for x, y in some}
            close = backend.distances.pairs("self", "robot", limit)
            assert backend.distances.pairs("self", "robot", limit, near=some) == close
            found += len(close)
    backend.close()
    assert found > 100 and skipped > 1000
