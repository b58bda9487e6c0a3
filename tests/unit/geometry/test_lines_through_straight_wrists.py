"""What lies between samples of a line through a straight wrist is not known, and whoever asks is told so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.geometry.in_zones import _MOST_PIECES as MOST_PIECES
from pn2code.geometry.legs import Leg
from pn2code.geometry.lines import Follower
from pn2code.geometry.tracks import ArmShape, Link, Track
from pn2code.geometry.zone_speeds import slow_enough
from pn2code.robot.motion import plan_lin
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import matrix_of


def straight_line() -> LinearTrajectory:
    cell = riveting_cell("good")
    robot = cell.robot("robot1")
    q = np.radians([0.0, -80.0, 80.0, 0.0, 8.0, 0.0])
    start = robot.kinematics.forward(q)
    turned = start @ matrix_of(pose_mm(0, 0, 0, 0, -16, 0))
    path = plan_lin(robot.kinematics, q, start, turned, robot.limits(cell.motion), 0.2)
    assert isinstance(path, LinearTrajectory) and path.is_straight
    return path


def test_it_is_given_up_after_few_pieces() -> None:
    path = straight_line()
    follower = Follower(path.kinematics, path)
    edges = np.linspace(0.0, 1.0, 17)
    pieces, looked, given_up = np.stack([edges[:-1], edges[1:]], axis=1), 0, False
    while len(pieces):
        looked += len(pieces)
        _, away, lost = follower.pieces(pieces[:, 0], pieces[:, 1])
        given_up |= bool(lost.any())
        left = pieces[np.isinf(away).any(axis=1)]
        middle = left.mean(axis=1)
        pieces = np.concatenate(
            [np.stack([left[:, 0], middle], axis=1), np.stack([middle, left[:, 1]], axis=1)]
        )
    assert given_up and "so near to a singularity" in follower.trouble
    assert looked < MOST_PIECES


def track_of(path: LinearTrajectory) -> Track:
    robot = riveting_cell("good").robot("robot1")
    low, high = np.full((2, 3), 0.1) * [[-1.0], [1.0]]
    shape = ArmShape(robot, (Link.of("robot1/tool", 7, np.eye(4), low, high),))
    return Track(shape, cast(Leg, SimpleNamespace(path=path, robot="robot1", kind="lin")))


def test_each_question_has_its_own_trouble() -> None:
    """Another question may have been asked in another process, or not have been asked yet."""
    track = track_of(straight_line())
    edges = np.linspace(0.0, 1.0, 2001)
    lost = np.flatnonzero(track.knots(edges[:-1], edges[1:]).lost)
    assert 0 < len(lost) < 1000 and track.trouble
    some, others = lost[:1], np.array([0])
    assert lost[0] > 0
    for piece, is_lost in ((others, False), (some, True), (others, False)):
        track.begin()
        track.knots(edges[piece], edges[piece + 1])
        assert bool(track.trouble) is is_lost


def test_whether_it_is_slow_enough_is_not_known() -> None:
    path = straight_line()
    watch: Any = SimpleNamespace(limited=(), too_fast=lambda *_: None)
    nothing = np.zeros((16, 1))
    track: Any = SimpleNamespace(
        leg=cast(Leg, SimpleNamespace(path=path)),
        robot="robot1",
        trouble="",
        begin=lambda: None,
        knots=lambda *_: SimpleNamespace(q=nothing, spread=nothing),
        speeds=lambda *_: nothing,
        boxes=lambda *_: nothing,
        links=(),
    )
    assert slow_enough(watch, cast(Track, track), ()) == ("yes", "")
    track.trouble = "it is not known"
    assert slow_enough(watch, cast(Track, track), ()) == ("unknown", "it is not known")
