"""What lies between samples of a line through a straight wrist is not known, and whoever asks is told so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from helpers.robot_cells import pose_mm, riveting_cell
from pn2code.geometry.in_zones import _MOST_PIECES as MOST_PIECES
from pn2code.geometry.legs import Leg
from pn2code.geometry.lines import Follower
from pn2code.geometry.tracks import Track
from pn2code.geometry.zone_speeds import slow_enough
from pn2code.robot.motion import LinearTrajectory, plan_lin
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
    pieces, looked = np.stack([edges[:-1], edges[1:]], axis=1), 0
    while len(pieces):
        looked += len(pieces)
        _, away = follower.pieces(pieces[:, 0], pieces[:, 1])
        left = pieces[np.isinf(away).any(axis=1)]
        middle = left.mean(axis=1)
        pieces = np.concatenate(
            [np.stack([left[:, 0], middle], axis=1), np.stack([middle, left[:, 1]], axis=1)]
        )
    assert "so near to a singularity" in follower.trouble
    assert looked < MOST_PIECES


def test_whether_it_is_slow_enough_is_not_known() -> None:
    path = straight_line()
    watch: Any = SimpleNamespace(limited=(), too_fast=lambda *_: None)
    nothing = np.zeros((16, 1))
    track: Any = SimpleNamespace(
        leg=cast(Leg, SimpleNamespace(path=path)),
        robot="robot1",
        trouble="",
        knots=lambda *_: SimpleNamespace(q=nothing, spread=nothing),
        speeds=lambda *_: nothing,
        boxes=lambda *_: nothing,
        links=(),
    )
    assert slow_enough(watch, cast(Track, track), ()) == ("yes", "")
    track.trouble = "it is not known"
    assert slow_enough(watch, cast(Track, track), ()) == ("unknown", "it is not known")
