"""A layout says where a device stands: what moves of it goes there, in runs and in proofs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers import belt_cell as belts
from helpers.belt_cell import belt_cell
from helpers.full_cell import read as read_full
from pn2code.cell.load import load
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.check import cells_of
from pn2code.robot.geometry import bodies
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import matrix_of
from pn2code.run.cell import run_cell
from pn2code.run.prepare import RunOptions

AWAY = """
[layouts.here]
[layouts.away]
devices.feeder.base = { x = 0.1, y = 0.1, z = -0.05, yaw = 2.0 }
[layouts.moved]
devices.feeder.base = { x = 0.1, y = 0.2 }
places.infeed = { x = 1.6, y = -0.4 }
places.entry = { x = 1.6, y = -1.3 }
"""


def cell(folder: Path, layout: str) -> RobotCell:
    d = Diagnostics()
    config = load(folder, d)
    assert config is not None, [e.message for e in d.errors]
    cells = cells_of(config, layout, d)
    assert cells is not None, [e.message for e in d.errors]
    return cells[0][1]


def test_all_that_moves_goes_there(tmp_path: Path) -> None:
    folder = belt_cell(tmp_path, toml=belts.TOML + AWAY)
    here, away = (cell(folder, name) for name in ("here", "away"))
    base = away.robot("feeder").T_world_base
    assert not np.allclose(base, np.eye(4))
    belt = next(a for a in here.robot("feeder").belts)
    q = here.robot("feeder").home
    plates = [x.robot("feeder").T_world_plate(belt, q) for x in (here, away)]
    assert np.allclose(plates[1], base @ plates[0])
    old, new = (
        matrix_of(next(b for b in bodies(x) if b.name == "feeder/belt").solids[0].pose)
        for x in (here, away)
    )
    assert np.allclose(new, base @ old)


@pytest.mark.cc
@pytest.mark.usefixtures("quick_build")
@pytest.mark.parametrize(
    ("layout", "at"), [("here", (1.5, -0.6)), ("moved", (1.6, -0.4)), ("away", None)]
)
def test_a_run_has_it_there(tmp_path: Path, layout: str, at: tuple[float, float] | None) -> None:
    """The belt stops at the place, wherever both are; `away` the feeder puts the box above the belt, where it hangs."""
    net = belts.NET.replace("parts = 2", "parts = 1")
    if layout == "moved":
        net = net.replace("at (1500.0, ~600.0, 650.0)", "at (1600.0, ~400.0, 650.0)")
    d = Diagnostics()
    options = RunOptions(
        out=tmp_path / "run", backend="fake", checked=False, looks=False, layout=layout
    )
    found = run_cell(belt_cell(tmp_path / "cell", net, belts.TOML + AWAY), options, d)
    assert found is not None, [e.message for e in d.errors]
    taken = [p.change.pose for p in found.record.parts if p.change.effect == "takes"]
    if at is None:
        assert "grips air" in found.record.reason
    else:
        assert found.record.verdict == "finished", found.record.reason
        assert [(round(p.x, 6), round(p.y, 6)) for p in taken] == [at]


@pytest.mark.parametrize(
    ("layout", "says"),
    [
        ("devices.feder.base = { x = 1.0 }", "layout `x` places an unknown device `feder`"),
        ("devices.feeder.axes.belt.width = 1.0", "unknown key `axes` in `layouts.x.devices.feeder`"),
        ("devices.feeder.instance = 'Other'", "unknown key `instance` in `layouts.x.devices.feeder`"),
        ("devices.feeder.base = 3", "devices.feeder.base` must be a table"),
        ("devices.feeder.base = { x = 'a' }", "is `a`, but a number"),
        ("devices.feeder.base = { roll = 5.0 }", "is not level"),
        ("devices.feeder.base = { y = 2.0 }", "no part on it comes there"),
    ],
)  # fmt: skip
def test_mistakes_are_told(tmp_path: Path, layout: str, says: str) -> None:
    folder = belt_cell(tmp_path, toml=f"{belts.TOML}[layouts.x]\n{layout}\n")
    d = Diagnostics()
    config = load(folder, d)
    if config is not None:
        cells_of(config, "x", d)
    assert any(says in e.message for e in d.errors), [e.message for e in d.errors]


def test_what_moves_nothing_stands_nowhere(tmp_path: Path) -> None:
    data = {"devices": {"panel": {"instance": "Panel", "base": {"x": 1.0}}}}
    _, d = read_full(tmp_path, data, "devices")
    assert any("nothing of it moves" in e.message for e in d.errors)
