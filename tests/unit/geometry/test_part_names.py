"""Parts are told by the names that runs give them."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from helpers.belt_cell import TOML
from helpers.robot_cells import nowhere
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.legs import Planner
from pn2code.geometry.part_names import as_in_runs, as_seen, held, on_plate, standing, told
from pn2code.geometry.shown import Shown
from pn2code.robot.backend import Clearance
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import Along, MoveExternal
from pn2code.robot.part import Part
from pn2code.robot.scene import load


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        (f"arm/{held('blank.1', 'arm')}", "arm/blank.1"),
        (on_plate("blank.12", "left/plate", 2), "blank.12"),
        (standing("blank.2"), "blank.2"),
        ("arm/link_1", "arm/link_1"),
        ("table.standing", "table.standing"),
        ("camera.on_table", "camera.on_table"),
    ],
)
def test_names_are_those_of_runs(name: str, shown: str) -> None:
    assert as_in_runs(name) == shown


def test_what_is_reported_has_them() -> None:
    nothing = (0.0, 0.0, 0.0)
    names = f"arm/{held('blank.1', 'arm')}", standing("blank.2")
    gap = Clearance("robots", "arm", *names, 0.0, None, nothing, nothing)
    found = as_seen(Apart("open", 0.0, math.inf, gap, why=f"`{gap.a}` and `{gap.b}` come within"))
    assert found.where is not None
    assert (found.where.a, found.where.b) == ("arm/blank.1", "blank.2")
    assert found.why == "`arm/blank.1` and `blank.2` come within"


@pytest.mark.bullet
def test_two_that_move_together_may_have_one_name_in_runs() -> None:
    """Each of two programs, half way through, has put a first one on the belt; then it carries both."""
    cell = load(tomllib.loads(TOML), Path(), nowhere, Diagnostics())
    assert cell is not None
    both = []
    for along in (0.2, 0.5):
        frame = np.eye(4)
        frame[:3, 3] = along, 0.0, 0.075
        both.append(Part("box.1", cell.parts["box"], frame, plate="feeder/belt"))
    planner, backend = Planner(cell), BulletBackend(cell, looks=False)
    leg = planner.leg(planner.home("feeder"), MoveExternal((Along("belt", 0.3, True),)))
    scene, _ = Comparison(cell, planner, Shown(backend)).around(leg, tuple(both))
    backend.close()
    assert scene.outcome == "clear"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("arm/link_3", "`arm/link_3`"),
        (f"arm/{held('blank.1', 'arm')}", "`blank.1` (a part, held by `arm`)"),
        (f"arm/{held('gripper', 'arm')}", "`gripper` (a tool, held by `arm`)"),
        (standing("blank.2"), "`blank.2` (a part, which stands there)"),
        (on_plate("blank.2", "left/plate", 3), "`blank.2` (a part, on `left/plate`)"),
    ],
)
def test_it_is_said_what_comes_near(name: str, words: str) -> None:
    assert told(name) == words
