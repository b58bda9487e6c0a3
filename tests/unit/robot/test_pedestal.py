"""What an arm above the floor stands on is as wide as its base link needs."""

from __future__ import annotations

from pathlib import Path

import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot.geometry import bodies
from pn2code.robot.model import MODELS
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

HERE = Origin("cell.toml")


def cell(model: str, axes: int, folder: Path = MODELS, **base: float) -> RobotCell:
    if model.startswith("ur"):
        pytest.importorskip("eaik")
    home = {4: [0.0] * 4, 6: [0.0, -90.0, 90.0, 0.0, 0.0, 0.0]}[axes]
    robot = {"model": model, "tool": "none", "base": {"z": 0.7, **base}, "home": home}
    d = Diagnostics()
    found = load({"robots": {"arm": robot}}, folder, lambda *_: HERE, d)
    assert found is not None, [e.message for e in d]
    return found


def width(c: RobotCell) -> float:
    (body,) = (b for b in bodies(c) if b.name == "arm_pedestal")
    assert body.looks
    (solid,) = body.solids
    assert solid.size[0] == solid.size[1] and solid.size[2] == 0.7
    return solid.size[0]


@pytest.mark.parametrize(
    ("model", "axes", "side"),
    [
        ("kr120_r2500", 6, 0.92),
        ("kr210_r2700", 6, 0.92),
        ("ur5e", 6, 0.34),
        ("ur10e", 6, 0.38),
        ("cobra_s600", 4, 0.40),
        ("gantry_3000", 4, 0.92),
    ],
)
def test_it_is_somewhat_wider_than_the_base_link(model: str, axes: int, side: float) -> None:
    assert width(cell(model, axes)) == side


def test_where_the_extent_is_not_known_it_is_the_widest(tmp_path: Path) -> None:
    assert width(cell("ur5e", 6, roll=10.0)) == 0.92
    text = (MODELS / "ur5e.urdf").read_text().replace("meshes/", f"{MODELS}/meshes/")
    shape = '<cylinder radius="0.0748" length="0.0945"/>'
    assert text.count(shape) == 1
    (tmp_path / "base.stl").write_text(
        "solid base\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid base\n"
    )
    for other, side in (
        ('<mesh filename="base.stl"/>', 0.92),
        ('<sphere radius="0.1"/>', 0.40),
        ('<capsule radius="0.1" length="0.1"/>', 0.40),
    ):
        (tmp_path / "arm.urdf").write_text(text.replace(shape, other))
        assert width(cell("arm.urdf", 6, tmp_path)) == side
