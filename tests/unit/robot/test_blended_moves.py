"""Linear moves through poses: the corners are rounded within their zone, and nothing is faster than allowed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.geometry.words import words
from pn2code.geometry.zone_speeds import _Pace
from pn2code.robot.active_motion import Motion
from pn2code.robot.blend import MOST_OFF, Blended, PassingLaw
from pn2code.robot.commands import MoveLinear, Pose
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array, matrix_of
from pn2code.run import command_words

CELL = riveting_cell("good")
START = np.radians([10.0, -100.0, 90.0, 20.0, 40.0, 60.0])
VIA = (pose_mm(150.0, 0, 0, 0, 0, 10), pose_mm(150.0, 120.0, 0, 10, 0, 10))
END = pose_mm(0.0, 120.0, 60.0)
PLAIN = tuple(Pose(p.x, p.y, p.z, 0.0, 0.0, 0.0) for p in VIA)


def executor() -> RobotExecutor:
    made = RobotExecutor(CELL.robot("robot1"), CELL.motion, {})
    made.stand(START, made.robot.kinematics.forward(START), "")
    return made


def move(
    zone: float, via: tuple[Pose, ...] = VIA, speed: float | None = 0.5, ramp: float = 1.0
) -> Motion:
    return executor().begin(MoveLinear(END, "tool", speed, ramp, via=via, blend=zone), 0.0)


def corners(via: tuple[Pose, ...] = VIA) -> Array:
    """The places of the lines in the base frame."""
    start = CELL.robot("robot1").kinematics.forward(START)
    return np.stack([start[:3, 3], *((start @ matrix_of(p))[:3, 3] for p in (*via, END))])


def off_lines(places: Array, ends: Array) -> Array:
    """How far each place is from the nearest line."""
    out = []
    for a, b in zip(ends[:-1], ends[1:], strict=True):
        s = np.clip((places - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        out.append(np.linalg.norm(places - a - s[:, None] * (b - a), axis=1))
    return np.min(out, axis=0)


def path_of(motion: Motion) -> LinearTrajectory:
    assert isinstance(motion.trajectory, LinearTrajectory)
    return motion.trajectory


@pytest.mark.parametrize("zone", [0.002, 0.02, 0.05])
def test_corners_are_rounded_within_their_zone(zone: float) -> None:
    motion = move(zone)
    assert motion.kind == "blend"
    path, ends = path_of(motion), corners()
    k = CELL.robot("robot1").kinematics
    times = np.linspace(0.0, motion.duration, 3000)
    places = k.forward_many(path.sample(times))[:, :3, 3]
    assert np.abs(places - path.line.at(path.way(times))[:, :3, 3]).max() < 1e-9
    assert np.linalg.norm(places[0] - ends[0]) < 1e-9
    assert np.linalg.norm(places[-1] - ends[-1]) < 1e-9
    off = off_lines(places, ends)
    near = np.linalg.norm(places[:, None] - ends[None, 1:-1], axis=2)
    assert off[(near > zone + 1e-9).all(axis=1)].max() < 1e-9
    # Where the way turns by a right angle, it is a third of the zone times sin(45 deg) off its pose.
    assert near[:, 0].min() == pytest.approx(zone / 3.0 * math.sin(math.pi / 4.0), rel=0.02)
    assert off.max() <= zone * MOST_OFF


@pytest.mark.parametrize("speed", [0.05, 0.5])
@pytest.mark.parametrize("ramp", [0.3, 1.0])
@pytest.mark.parametrize("zone", [0.005, 0.03, 0.2])
def test_the_place_of_the_tcp_keeps_the_limits(zone: float, ramp: float, speed: float) -> None:
    """By differences of the true path, over many instants."""
    motion = move(zone, PLAIN, speed, ramp)
    path = path_of(motion)
    times = np.linspace(0.0, motion.duration, 20001)
    places, h = path.line.at(path.way(times))[:, :3, 3], times[1]
    found = []
    for _ in range(3):
        places = np.diff(places, axis=0) / h
        found.append(np.linalg.norm(places, axis=1).max())
    most = CELL.motion.linear_acceleration * ramp
    assert found[0] <= speed * (1.0 + 1e-6)
    assert found[1] <= most * (1.0 + 1e-4)
    assert found[2] <= CELL.motion.linear_jerk * (1.0 + 1e-2)
    assert found[1] > 0.9 * most or found[0] > 0.9 * speed
    begin = path.line.at(path.way(np.array([0.0, motion.duration])))
    assert np.linalg.norm(begin[:, :3, 3] - corners(PLAIN)[[0, -1]], axis=1).max() < 1e-9


def test_it_does_not_stop_on_the_way() -> None:
    motion = move(0.03)
    path = path_of(motion)
    rates = np.array([path.rate(t) for t in np.linspace(0.0, motion.duration, 2001)])
    law = path._law
    assert isinstance(law, PassingLaw)
    inner = path.way(np.linspace(0.0, motion.duration, 2001)) * path.line.length
    on_way = (inner > 0.05) & (inner < path.line.length - 0.09)
    assert rates[on_way].min() * path.line.length >= law.passing * (1.0 - 1e-9)


def test_it_is_the_same_every_time() -> None:
    one, two = (path_of(move(0.02)) for _ in range(2))
    times = np.linspace(0.0, one.duration, 50)
    assert one.duration == two.duration
    assert one.sample(times).tobytes() == two.sample(times).tobytes()


@pytest.mark.parametrize("zone", [0.004, 0.06])
def test_speeds_of_the_way_are_those_of_the_poses_on_it(zone: float) -> None:
    """What the geometry check relies on: twists, and bounds on them and on how they change."""
    way = path_of(move(zone)).line
    h = 1e-6
    s = np.linspace(0.01, 0.99, 2000)
    before, after, here = way.at(s - h), way.at(s + h), way.at(s)
    shifts = (after - before)[:, :3, 3] / (2.0 * h)
    assert np.abs(shifts - way.shifts(s)).max() < 1e-6
    rates = (after - before)[:, :3, :3] / (2.0 * h) @ np.transpose(here[:, :3, :3], (0, 2, 1))
    found = np.stack([rates[:, 2, 1], rates[:, 0, 2], rates[:, 1, 0]], axis=1)
    spins = way.spins(here[:, :3, :3], s)
    assert np.abs(found - spins).max() < 1e-6
    assert np.linalg.norm(shifts, axis=1).max() <= way.length + 1e-6
    assert np.linalg.norm(spins, axis=1).max() <= way.angle + 1e-6
    twists = [
        np.hstack([way.shifts(x), way.spins(at[:, :3, :3], x)])
        for x, at in ((s - h, before), (s + h, after))
    ]
    change = np.linalg.norm(twists[1] - twists[0], axis=1) / (2.0 * h)
    assert 0.3 * way.bend < change.max() <= way.bend * (1.0 + 1e-6)


def test_a_way_that_turns_back_turns_before_its_pose() -> None:
    eye, far = np.eye(4), np.eye(4)
    far[0, 3] = 0.1
    way = Blended([eye, far, eye], 0.03)
    places = way.at(np.linspace(0.0, 1.0, 1001))[:, :3, 3]
    assert places[:, 0].max() == pytest.approx(0.1 - 0.01, abs=1e-6)


def test_zones_are_no_longer_than_half_of_a_line() -> None:
    ends = corners()
    way = path_of(move(5.0)).line
    assert isinstance(way, Blended)
    lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1) / 2.0
    assert [c.zone for c in way.corners] == pytest.approx(
        [min(lengths[0], lengths[1]), min(lengths[1], lengths[2])]
    )


@pytest.mark.parametrize(
    ("via", "zone", "message"),
    [
        ((pose_mm(0.05, 0, 0),), 0.01, "pose 1 of a move through 2 poses is 0.0500 mm from where"),
        ((VIA[0], VIA[0]), 0.01, "pose 2 of a move through 3 poses is 0.0000 mm from where"),
        (VIA, math.nan, "corners are rounded within 0.1 mm at least, but `blend` is nan mm"),
        (VIA, 0.0, "corners are rounded within 0.1 mm at least, but `blend` is 0 mm"),
        (VIA, 1e-5, "corners are rounded within 0.1 mm at least, but `blend` is 0.01 mm"),
        ((pose_mm(150.0, 0, 9000.0),), 0.01, "the path leaves the reach of branch"),
    ],
)
def test_what_is_refused(via: tuple[Pose, ...], zone: float, message: str) -> None:
    with pytest.raises(MotionFault, match="robot1") as caught:
        move(zone, via)
    assert message in caught.value.message


def test_a_speed_must_be_above_zero() -> None:
    with pytest.raises(MotionFault, match="linear speed must be above 0, but it is 0"):
        move(0.02, VIA, 0.0)


@pytest.mark.parametrize("zone", [0.005, 0.05])
def test_the_speed_between_instants_is_bounded(zone: float) -> None:
    """What is checked in zones where people may be: its speed has several peaks, at no particular times."""
    path = path_of(move(zone))
    pace = _Pace(path)
    times = np.linspace(0.0, path.duration, 40001)
    rows = np.array([path.progress(float(t)) for t in times])
    assert (np.diff(rows[:, 0]) >= -1e-12).all()
    is_above = False
    for a in np.linspace(0.0, 0.999, 1000):
        inside = (rows[:, 0] >= a) & (rows[:, 0] <= a + 0.001)
        most = rows[inside, 1].max()
        assert most <= pace.most(a, a + 0.001)
        is_above |= bool(most > pace.most(a, a + 0.001) - pace._more)
    assert is_above


def test_words_say_by_which_poses() -> None:
    """Those of runs, and of the check."""
    told = MoveLinear(END, "tool", via=VIA, blend=0.02)
    says = command_words.words(told)
    assert says.count(" via ") == 2 and says.endswith("blend 20.0000 mm")
    assert words(told).count(" via ") == 2 and "blend 20 mm" in words(told)
