"""From where a picture is taken: nothing hides what it is about."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from helpers.belt_cell import TOML
from helpers.robot_cells import nowhere
from pn2code.diagnostics import Diagnostics
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.render import cameras, close_up
from pn2code.robot.scene import load

pytestmark = pytest.mark.bullet


def tip_and_cameras(post: np.ndarray | None) -> tuple[np.ndarray, dict[str, int], np.ndarray]:
    """Where the tool is, how much of it two cameras do not see, and where the second of them is."""
    data = tomllib.loads(TOML)
    if post is not None:
        x, y, z = post.tolist()
        thing = {"name": "post", "size": [0.3, 0.3, 0.3], "pose": {"x": x, "y": y, "z": z}}
        data["scene"] = {"objects": [thing]}
    d = Diagnostics()
    cell = load(data, Path(), nowhere, d)
    assert cell is not None, [e.message for e in d.errors]
    backend = BulletBackend(cell)
    try:
        backend.set_joints("robot", cell.robot("robot").home)
        tip = backend.tcp("robot")[:3, 3]
        usual = next(c for c in cameras(cell, backend) if c.name == "tools")
        chosen = close_up(cell, backend, "robot")
        places = [tuple(float(v) for v in tip + off) for off in (np.zeros(3), 0.04 * np.eye(3)[2])]
        hidden = {
            name: backend.hidden(c.eye, places)  # type: ignore[arg-type]
            for name, c in (("usual", usual), ("chosen", chosen))
        }
        return tip, hidden, np.array([usual.eye, chosen.eye])
    finally:
        backend.close()


def test_a_close_up_is_taken_from_where_nothing_is_in_the_way() -> None:
    tip, free, eyes = tip_and_cameras(None)
    assert free == {"usual": 0, "chosen": 0} and eyes[0] == pytest.approx(eyes[1])
    _, hidden, eyes = tip_and_cameras(tip + 0.4 * (eyes[0] - tip))
    assert hidden["usual"] == 2 and hidden["chosen"] == 0
    assert np.linalg.norm(eyes[0] - eyes[1]) > 0.3


def test_no_eye_is_inside_of_a_thing() -> None:
    """From there nothing seems to be in the way."""
    _, _, eyes = tip_and_cameras(None)
    _, hidden, eyes = tip_and_cameras(eyes[0])
    assert hidden == {"usual": 0, "chosen": 0}
    assert np.linalg.norm(eyes[0] - eyes[1]) > 0.3
