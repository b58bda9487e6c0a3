"""What PyBullet makes of a URDF file is what pn2code takes it for: links where they are, shapes that are shapes."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.robot import urdf
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.model import MODELS
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load

HERE = Origin("cell.toml")
INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
TOOL = """<robot name="t">
<link name="hand">{inertial}
<visual>{material}{geometry}</visual>
<collision{concave}>{origin}{geometry}</collision></link>
<link name="tcp"/>
<joint name="j" type="fixed"><parent link="hand"/><child link="tcp"/><origin xyz="0 0 0.2"/></joint>
</robot>
"""
BOX = '<geometry><box size="0.1 0.1 0.2"/></geometry>'


def cell(folder: Path, model: str = "gp25", tool: str = "none") -> RobotCell:
    home = {"gantry": [1.0, 0.25, 0.5, 20.0]}.get(model, [0.0, 0.0, 0.0, 0.0, -90.0, 0.0])
    arm = {"model": model, "tool": tool, "base": {"x": 0.5, "z": 0.25, "yaw": 30.0}, "home": home}
    if (folder / f"{model}.urdf").exists():
        arm["model"] = f"{model}.urdf"
    d = Diagnostics()
    found = load({"robots": {"arm": arm}, "motion": {}}, folder, lambda *_: HERE, d)
    assert found is not None, [e.message for e in d]
    return found


def boxes(found: RobotCell) -> dict[str, tuple[float, ...]]:
    """Of each link, the corners of the box around it in the world."""
    backend = BulletBackend(found, looks=False)
    try:
        p, arm = backend._p, backend._robots["arm"]
        backend.set_joints("arm", found.robots[0].home)
        return {
            name: tuple(
                round(float(x), 6)
                for corner in p.getAABB(arm.body, i, physicsClientId=backend._client)
                for x in corner
            )
            for i, name in arm.links.items()
        }
    finally:
        backend.close()


def own(folder: Path, model: str) -> Path:
    """A copy of an arm, to be changed."""
    (folder / "meshes").symlink_to(MODELS / "meshes")
    path = folder / f"{model}.urdf"
    path.write_text((MODELS / f"{model}.urdf").read_text())
    return path


@pytest.mark.bullet
def test_masses_move_nothing(tmp_path: Path) -> None:
    """PyBullet would put the centre of gravity of the base link where the base is."""
    path = own(tmp_path, "gp25")
    before = boxes(cell(tmp_path))
    said = f'<inertial><origin xyz="0.5 0.2 0.3" rpy="0.4 0.5 0.6"/><mass value="90"/>{INERTIA}</inertial>'
    path.write_text(re.sub(r'(<link name="\w+">)', rf"\1{said}", path.read_text()))
    assert path.read_text().count("inertial") > 4
    assert boxes(cell(tmp_path)) == before


@pytest.mark.bullet
def test_what_slides_goes_as_far_as_it_is_told(tmp_path: Path) -> None:
    """PyBullet would multiply it with the length of the axis."""
    own(tmp_path, "gantry_3000")
    path = (tmp_path / "gantry_3000.urdf").rename(tmp_path / "gantry.urdf")
    before = boxes(cell(tmp_path, "gantry"))
    text = path.read_text()
    path.write_text(text.replace('<axis xyz="1 0 0"/>', '<axis xyz="2 0 0"/>'))
    assert path.read_text() != text
    assert boxes(cell(tmp_path, "gantry")) == before


@pytest.mark.bullet
@pytest.mark.parametrize(
    "what",
    [
        {"inertial": '<inertial><mass value="1"/></inertial>'},
        {"inertial": f"<inertial>{INERTIA}</inertial>"},
        {"material": "<material/>"},
        {"material": '<material><color rgba="1 0 0 1"/></material>'},
        {"concave": ' concave="yes"'},
        {"geometry": '<geometry><!-- a box --><box size="0.1 0.1 0.2"/></geometry>'},
        {"inertial": "<!-- " + "long " * 3000 + "-->"},
    ],
    ids=lambda what: next(iter(what)),
)
def test_what_pybullet_need_not_know(tmp_path: Path, what: dict[str, str]) -> None:
    parts = {"inertial": "", "material": "", "concave": "", "origin": "", "geometry": BOX}
    (tmp_path / "hand.urdf").write_text(TOOL.format(**parts).replace("\n", ""))
    before = boxes(cell(tmp_path, tool="hand.urdf"))
    (tmp_path / "hand.urdf").write_text(TOOL.format(**parts | what).replace("\n", ""))
    found = cell(tmp_path, tool="hand.urdf")
    assert boxes(found) == before
    BulletBackend(found, looks=True).close()


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ({"geometry": ""}, "the `geometry` of a `visual` of link `hand` is nothing, but one of box,"),
        ({"geometry": "<geometry/>"}, "is nothing, but one of box, cylinder, sphere,"),
        ({"geometry": "<geometry><cone/></geometry>"}, "of link `hand` is `cone`, but one of"),
        ({"geometry": BOX.replace("/></g", '/><sphere radius="1"/></g')}, "is `box`, `sphere`, but"),
        ({"geometry": BOX.replace("0.1 0.1", "0.1,0.1,")}, "`size` is `0.1,0.1, 0.2`, but 3 numbers"),
        ({"geometry": BOX.replace("0.2", "0")}, "a `box` of link `hand` has a size that is not above"),
        ({"geometry": BOX.replace("0.2", "-1")}, "has a size that is not above zero"),
        ({"geometry": "<geometry><box/></geometry>"}, "`size` is ``, but 3 numbers are expected"),
        ({"geometry": '<geometry><sphere radius="0"/></geometry>'}, "not above zero"),
        ({"geometry": '<geometry><cylinder radius="1"/></geometry>'}, "`length` is ``, but 1 numbers"),
        ({"geometry": "<geometry><mesh/></geometry>"}, "`filename`"),
        ({"geometry": '<geometry><mesh filename="a.stl" scale="1"/></geometry>'}, "`scale` is `1`"),
        ({"geometry": '<geometry><mesh filename="a.stl" scale="1 0 1"/></geometry>'}, "not above zero"),
        ({"origin": '<origin xyz="0,0,1"/>'}, "`xyz` is `0,0,1`, but 3 numbers are expected"),
        ({"origin": '<origin rpy="0 nan 1"/>'}, "`rpy` is `0 nan 1`, but 3 numbers are expected"),
    ],
)  # fmt: skip
def test_shapes_that_are_none_are_refused(tmp_path: Path, what: dict[str, str], says: str) -> None:
    """PyBullet takes numbers that it cannot read for zero: the shape would touch nothing."""
    parts = {"inertial": "", "material": "", "concave": "", "origin": "", "geometry": BOX}
    path = tmp_path / "hand.urdf"
    path.write_text(TOOL.format(**parts | what))
    d = Diagnostics()
    assert urdf.read(path, d) is None
    (found,) = d.items
    assert says in found.message and found.origin.line > 0


def test_arms_that_come_with_it_are_read_as_they_were() -> None:
    for path in sorted(MODELS.rglob("*.urdf")):
        tree = urdf.read(path, Diagnostics())
        assert tree is not None
        text = urdf.with_tool(tree, tree.links[-1], None)
        same = urdf.for_bullet(text, looks=True)
        assert re.findall(r'"[^"]*"', same) == re.findall(
            r'"[^"]*"', re.sub(r"<\?.*?\?>|<!--.*?-->", "", text)
        )
        assert np.isfinite(tree.centre).all()
