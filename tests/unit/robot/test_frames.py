"""`[frames]`: frames in frames, and what is wrong with them."""

from __future__ import annotations

import math
from typing import Any

import pytest

from helpers.robot_cells import nowhere
from pn2code.diagnostics import Diagnostics
from pn2code.robot.commands import Pose
from pn2code.robot.frames import read_frames
from pn2code.robot.table import Table


def read(data: dict[str, Any]) -> tuple[dict[str, Pose], Diagnostics]:
    d = Diagnostics()
    table = Table(data, ("frames",), nowhere, d, {"frames": data}, None)
    return dict(read_frames(table).standing), d


def test_a_frame_is_in_its_parent() -> None:
    found, d = read(
        {
            "corner": {"parent": "pallet", "x": 0.5, "yaw": 90.0},
            "pallet": {"parent": "hall", "y": 2.0, "yaw": 90.0},
            "hall": {"x": 10.0},
        }
    )
    assert not d.items
    assert found["hall"] == Pose(10.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    corner = found["corner"]
    assert (corner.x, corner.y, corner.z) == pytest.approx((10.0, 2.5, 0.0))
    assert abs(corner.rz) == pytest.approx(math.pi)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"a": {"parent": "b"}}, "but `world` or the name of another frame is expected"),
        ({"a": {"parent": "a"}}, "frame `a` is given in itself: `a` in `a`"),
        (
            {"a": {"parent": "b"}, "b": {"parent": "a"}},
            "frame `a` is given in itself: `a` in `b` in `a`",
        ),
        ({"tool": {}}, "`tool` is not a name for frames"),
        ({"world": {}}, "`world` is not a name for frames"),
        ({"a b": {}}, "`a b` is not a name for frames"),
    ],
)
def test_frames_that_are_none(data: dict[str, Any], message: str) -> None:
    _, d = read(data)
    assert any(message in e.message for e in d.errors), [e.message for e in d.errors]
