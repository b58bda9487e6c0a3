"""A picture of where two things touch has the parts and arms where they are then."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.belt_cell import TOML
from helpers.robot_cells import nowhere
from pn2code.diagnostics import Diagnostics
from pn2code.geometry import pictures
from pn2code.geometry.answers import Around, Pair
from pn2code.robot.backend import Camera, Clearance
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.part import Part
from pn2code.robot.scene import load
from pn2code.robot.transforms import translation

pytestmark = pytest.mark.bullet
POINT = (0.6, 0.1, 0.7)


def test_what_is_there_is_shown_from_near(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cell = load(tomllib.loads(TOML), Path(), nowhere, Diagnostics())
    assert cell is not None
    part = Part("box.7", cell.kinds[0], translation(0.6, 0.0, 0.5))
    home = cell.robot("robot").home
    rests, touches = [v + 0.1 for v in home], tuple(v + 0.2 for v in home)
    seen: list[tuple[Camera, tuple[float, ...], list[str]]] = []

    def looked(backend: BulletBackend, camera: Camera, width: int, height: int) -> Any:
        seen.append((camera, tuple(backend._q["robot"]), [*backend._parts]))
        return np.zeros((height, width, 3), np.uint8)

    monkeypatch.setattr(BulletBackend, "render", looked)
    gap = Clearance("robots", "robot/link_1", "box.7", "", -0.01, None, POINT)
    around = Around({"robot": np.array(rests)}, (part,))
    pair = Pair(
        ("robot", ""), ("Work", ""), ("", ""), "no", "", gap, joints=(("robot", touches),),
        around=around,
    )  # fmt: skip
    (drawn,) = pictures.draw(cell, [pair], tmp_path, "touch")
    assert Path(drawn.picture).is_file()
    (near, q, parts), (whole, _, _) = seen
    assert q == pytest.approx(touches) and parts == ["box.7"]
    assert near.target == whole.target == pytest.approx(POINT)
    far, further = (float(np.linalg.norm(np.subtract(c.eye, POINT))) for c in (near, whole))
    assert far < 2.5 < further
