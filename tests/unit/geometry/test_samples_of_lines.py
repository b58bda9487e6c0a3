"""Samples of lines are worked out once, and what is said of a piece does not depend on what was asked before."""

from __future__ import annotations

import numpy as np
from tools.geometry.pairs import facing, moves

from pn2code.geometry.legs import Planner
from pn2code.geometry.lines import SAMPLES, Follower
from pn2code.robot.trajectories import LinearTrajectory
from pn2code.robot.transforms import Array


def lines() -> list[LinearTrajectory]:
    legs = moves(Planner(facing("far")), "left", "far", 12)
    return [leg.path for leg in legs if isinstance(leg.path, LinearTrajectory)]


def divided(depth: int) -> list[Array]:
    """A way, its halves, the halves of these ...: rows from where to where."""
    edges = [np.linspace(0.0, 1.0, 2**level + 1) for level in range(depth)]
    return [np.stack([e[:-1], e[1:]], axis=1) for e in edges]


def test_halves_have_samples_in_common() -> None:
    path = lines()[0]
    follower, asked = Follower(path.kinematics, path), 0
    for level in divided(5):
        follower.pieces(level[:, 0], level[:, 1])
        asked += len(level) * (SAMPLES + 1)
    assert follower._samples.count == len(follower._known) == 16 * SAMPLES + 1 < asked / 2


def test_what_was_asked_before_makes_no_difference() -> None:
    for path in lines():
        once, one_by_one = (Follower(path.kinematics, path) for _ in range(2))
        for level in reversed(divided(4)):
            once.pieces(level[:, 0], level[:, 1])
        for a, b in np.vstack(divided(4)):
            ends = np.array([a]), np.array([b])
            for found, fresh in (
                (once.pieces(*ends), one_by_one.pieces(*ends)),
                (once.rates(*ends), Follower(path.kinematics, path).rates(*ends)),
            ):
                assert all(x.tobytes() == y.tobytes() for x, y in zip(found, fresh, strict=True))
