"""What PyBullet makes of a URDF file is what pn2code takes it for: links where they are, shapes that are shapes."""

from __future__ import annotations

import itertools
import re
import struct
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


CORNERS = [*itertools.product((0.0, 0.1), (0.0, 0.2), (0.0, 0.3))]
FACES = [
    (0, 1, 3), (0, 3, 2), (4, 7, 5), (4, 6, 7), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]  # fmt: skip
OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
MESHES = {
    "body.obj": OBJ + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in FACES),
    "loose.obj": OBJ + "f 1 2 3\n",
    "text.stl": "solid body\n"
    + "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {' '.join(map(str, CORNERS[i]))}\n" for i in face)
        + "endloop\nendfacet\n"
        for face in FACES
    )
    + "endsolid body\n",
    "binary.STL": b"solid body".ljust(80)
    + struct.pack("<I", len(FACES))
    + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for i in face for x in CORNERS[i]), 0) for face in FACES
    ),
}


def with_mesh(folder: Path, name: str, text: str | bytes) -> None:
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    parts = {"inertial": "", "material": "", "concave": "", "origin": "", "geometry": BOX}
    hand = TOOL.format(**parts).partition("<collision>")
    mesh = f'<collision><geometry><mesh filename="{name}"/></geometry></collision></link>'
    text = hand[0] + mesh + hand[2].partition("</link>")[2]
    (folder / "hand.urdf").write_text(text)


@pytest.mark.bullet
@pytest.mark.parametrize("name", MESHES)
def test_each_kind_of_mesh_is_as_large_as_its_file_says(name: str, tmp_path: Path) -> None:
    """PyBullet makes no shape at all of STL in text, and a smaller one where faces do not name all points."""
    with_mesh(tmp_path, name, MESHES[name])
    backend = BulletBackend(cell(tmp_path, tool="hand.urdf"), looks=False)
    found = backend.box("arm", "tool_hand")
    backend.close()
    assert found is not None
    assert np.allclose(found[0], 0.0, atol=0.01) and np.allclose(
        found[1], (0.1, 0.2, 0.3), atol=0.01
    )


@pytest.mark.bullet
def test_a_thing_of_stl_in_text_is_there(tmp_path: Path) -> None:
    for name in ("text.stl", "binary.STL"):
        with_mesh(tmp_path, name, MESHES[name])
        d = Diagnostics()
        thing = {"name": "body", "kind": "mesh", "file": name, "pose": {"x": 3.0}}
        arm = {"model": "gp25", "base": {}, "home": [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]}
        found = load(
            {"robots": {"arm": arm}, "scene": {"objects": [thing]}}, tmp_path, lambda *_: HERE, d
        )
        assert found is not None, [e.message for e in d]
        backend = BulletBackend(found, looks=False)
        (body,) = (s.id for s in backend.distances._standing() if s.whole == "body")
        low, high = backend._p.getAABB(body, physicsClientId=backend._client)
        backend.close()
        assert np.allclose(low, (3.0, 0.0, 0.0), atol=0.01)
        assert np.allclose(high, (3.1, 0.2, 0.3), atol=0.01)


@pytest.mark.parametrize(
    ("name", "text", "why"),
    [
        ("hand.dae", "<COLLADA/>", "it is no OBJ or STL file"),
        ("hand.stl", "not a mesh", "it is not of the STL format"),
        ("hand.stl", b"".ljust(80) + struct.pack("<I", 7) + b"short", "it is not of the STL format"),
        ("hand.obj", OBJ, "it has no triangles"),
        ("hand.obj", "v 0 0\nf 1 \\\n2 3\n", "line 2 is not of the OBJ format"),
        ("gone.obj", None, "No such file or directory"),
    ],
)  # fmt: skip
def test_a_mesh_that_cannot_be_read_is_refused(
    name: str, text: str | bytes | None, why: str, tmp_path: Path
) -> None:
    with_mesh(tmp_path, name, text or "")
    if text is None:
        (tmp_path / name).unlink()
    d = Diagnostics()
    arm = {
        "model": "gp25",
        "tool": "hand.urdf",
        "base": {},
        "home": [0.0, 0.0, 0.0, 0.0, -90.0, 0.0],
    }
    assert load({"robots": {"arm": arm}}, tmp_path, lambda *_: HERE, d) is None
    (found,) = d.errors
    assert found.message == (
        f"the collision mesh `{name}` of link `hand` cannot be read, so that it would touch nothing: {why}"
    )
    if text is None:
        return
    d = Diagnostics()
    thing = {"name": "body", "kind": "mesh", "file": name}
    del arm["tool"]
    sections = {"robots": {"arm": arm}, "scene": {"objects": [thing]}}
    assert load(sections, tmp_path, lambda *_: HERE, d) is None
    assert any("an OBJ or STL file" in e.message for e in d.errors), [e.message for e in d]
