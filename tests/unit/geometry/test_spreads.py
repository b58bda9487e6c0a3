"""What holds between samples: no point of a link is further off than the spread, and capsules are around shapes."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest

from helpers.robot_cells import arm_kinematics, pose_mm, riveting_cell
from helpers.thorough import amount
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.pieces import between, gaps
from pn2code.geometry.tracks import ArmShape, Knots, Track
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import MoveCircular, MoveHome, MoveJoint, MoveLinear
from pn2code.robot.robot_cell import RobotCell

pytestmark = pytest.mark.bullet


@pytest.fixture(scope="module")
def cell() -> RobotCell:
    return riveting_cell("paper")


@pytest.fixture(scope="module")
def shapes(cell: RobotCell) -> dict[str, ArmShape]:
    backend = BulletBackend(cell, looks=False)
    found = {r.name: ArmShape.of(r, backend) for r in cell.robots}
    backend.close()
    return found


def legs(cell: RobotCell) -> list[Leg]:
    """A joint move, lines that go and turn, one that ends near a straight elbow, the way home, an arc, and corners."""
    planner = Planner(cell)
    first = planner.leg(planner.home("robot2"), MoveJoint(pose_mm(5750.0, 5995.4, 2109.2, 75.0)))
    down = planner.leg(first.end, MoveLinear(pose_mm(0, 0, 100.0), "tool"))
    turned = planner.leg(first.end, MoveLinear(pose_mm(50.0, 0, -80.0, 0, 12.0, 9.0), "tool"))
    far = planner.leg(first.end, MoveLinear(pose_mm(1000.0, 0, 0), "tool"))
    home = planner.leg(far.end, MoveHome())
    over = MoveCircular(pose_mm(60.0, 0, -90.0), pose_mm(150.0, 0, -40.0, 0, 9.0, 0), "tool")
    arc = planner.leg(first.end, over)
    by = (pose_mm(90.0, 0, -60.0, 0, 12.0, 0), pose_mm(90.0, 50.0, -90.0, 9.0, 0, 0))
    through = MoveLinear(pose_mm(10.0, 60.0, -90.0, 0, 0, 15.0), "tool", via=by, blend=0.02)
    corners = planner.leg(first.end, through)
    out = [first, down, turned, far, home, arc, corners]
    assert [x.fault for x in out] == [None] * 7
    return out


def corners(track: Track, q: np.ndarray) -> np.ndarray:
    """The corners of the links' boxes in the base frame: (n, links, 8, 3)."""
    frames = track.shape.robot.kinematics.link_frames(q)
    out = np.empty((len(q), len(track.links), 8, 3))
    for i, link in enumerate(track.links):
        if link.joint == 0:
            out[:, i] = link.corners
        else:
            frame = frames[link.joint - 1]
            out[:, i] = link.corners @ frame[:, :3, :3].transpose(0, 2, 1) + frame[:, None, :3, 3]
    return out


@pytest.mark.parametrize("number", range(amount(4, 7)))
def test_no_point_is_further_off_than_the_spread(
    cell: RobotCell, shapes: dict[str, ArmShape], number: int
) -> None:
    leg = legs(cell)[number]
    track = Track(shapes["robot2"], leg)
    choice = Random(number)
    known = 0
    for _ in range(60):
        size = 2.0 ** -choice.randint(0, 10)
        a = choice.random() * (1.0 - size)
        knots = track.knots(np.array([a]), np.array([a + size]))
        if not np.isfinite(knots.spread).all():
            continue
        known += 1
        assert leg.path is not None
        within = leg.path.on_way(np.linspace(a, a + size, 60))
        middle = corners(track, knots.q)
        off = np.linalg.norm(corners(track, within) - middle, axis=3).max(axis=(0, 2))
        assert (off <= knots.spread[0] + 1e-9).all(), (a, size, off, knots.spread[0])
    assert known > 20


def test_spreads_are_not_much_too_large(cell: RobotCell, shapes: dict[str, ArmShape]) -> None:
    """Else everything would have to be divided for nothing."""
    for leg in legs(cell):
        track = Track(shapes["robot2"], leg)
        knots = track.knots(np.array([0.5]), np.array([0.5 + 2.0**-8]))
        assert leg.path is not None
        within = leg.path.on_way(np.linspace(0.5, 0.5 + 2.0**-8, 9))
        off = np.linalg.norm(corners(track, within) - corners(track, knots.q), axis=3)
        assert knots.spread.max() < 6.0 * off.max() + 1e-4


def test_capsules_are_around_the_shapes(cell: RobotCell, shapes: dict[str, ArmShape]) -> None:
    """A lower bound of the distance of two links is never more than what PyBullet measures."""
    backend = BulletBackend(cell, looks=False)
    planner = Planner(cell)
    choice = Random(7)
    met = 0
    for _ in range(40):
        knots = []
        for robot in cell.robots:
            arm = robot.arm
            # Towards each other: axis 1 and the wrist at random, the rest not far from HOME.
            q = np.array(robot.home) + [choice.uniform(-0.6, 0.6) for _ in range(6)]
            q = np.clip(q, arm.lower, arm.upper)
            backend.set_joints(robot.name, q)
            track = Track(shapes[robot.name], planner.standing(planner.home(robot.name)))
            knots.append((track, track._placed(q[None], np.zeros((1, 6)), None, np.zeros(1, bool))))
        (a, one), (b, other) = knots
        off = gaps(one, a.radii, other, b.radii)[0]
        for gap in backend.distances.pairs("robots", "robot1", 5.0, "robot2"):
            met += 1
            assert off[a.names[gap.a], b.names[gap.b]] <= gap.distance + 1e-9, gap
    backend.close()
    assert met > 1000


def test_distances_of_segments() -> None:
    """Next to the least distance of many points of both."""
    choice = np.random.default_rng(1)
    p, q, r, s = (choice.uniform(-1, 1, (200, 3)) for _ in range(4))
    q[:20] = p[:20]  # points
    s[10:30] = r[10:30]
    s[40:60] = r[40:60] + (q[40:60] - p[40:60])  # parallel
    found = between(p, q, r, s)
    t = np.linspace(0.0, 1.0, 201)
    one = p[:, None] + (q - p)[:, None] * t[:, None]
    two = r[:, None] + (s - r)[:, None] * t[:, None]
    sampled = np.sqrt(((one[:, :, None] - two[:, None]) ** 2).sum(-1)).min(axis=(1, 2))
    assert (found <= sampled + 1e-9).all()
    assert (sampled - found < 0.02).all()


def test_the_bound_on_the_steepness_of_a_jacobian_holds() -> None:
    """The norm of dJ/dq, by differences, is below what `lines` takes for it."""
    from pn2code.geometry.lines import _steepness

    kinematics = arm_kinematics()
    choice = np.random.default_rng(2)
    limit = _steepness(kinematics)
    for _ in range(300):
        q = choice.uniform(kinematics.arm.lower, kinematics.arm.upper)
        step = choice.normal(size=6)
        step *= 1e-5 / np.linalg.norm(step)
        change = kinematics.jacobian(q + step) - kinematics.jacobian(q)
        assert np.linalg.norm(change, 2) / 1e-5 <= limit
    assert limit < 6.0 * math.sqrt(1.0 + 4.5**2)


def test_what_pieces_are_divided_into_is_worked_out_with_them(
    cell: RobotCell, shapes: dict[str, ArmShape], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    work_out = Track._worked_out

    def counted(track: Track, a: np.ndarray, b: np.ndarray) -> Knots:
        asked.append(len(a))
        return work_out(track, a, b)

    for leg in legs(cell):
        ahead, alone = (Track(shapes[leg.robot], leg) for _ in range(2))
        halves = np.array([0.0, 0.5]), np.array([0.5, 1.0])
        with monkeypatch.context() as patched:
            patched.setattr(Track, "_worked_out", counted)
            ahead.knots(np.array([0.0]), np.array([1.0]))
            before = len(asked)
            found = ahead.knots(*halves)
            assert len(asked) == before
        # The numbers are those of pieces that are worked out by themselves, to the last bit.
        for row in range(2):
            single = work_out(alone, halves[0][[row]], halves[1][[row]])
            for name in ("q", "ends", "spread", "lost"):
                assert np.array_equal(getattr(found, name)[[row]], getattr(single, name)), name
