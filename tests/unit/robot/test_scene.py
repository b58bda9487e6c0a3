"""The sections `[robots]`, `[motion]`, `[scene]`: what is read, and what is reported."""

import copy
import math

import pytest

from helpers.robot_cells import EXAMPLE, geometry, nowhere, riveting_cell
from pn2code.diagnostics import Diagnostics
from pn2code.robot.backend import BackendUnavailableError
from pn2code.robot.choose_backend import open_backend
from pn2code.robot.geometry import bodies, panel_bodies
from pn2code.robot.panel import point_at
from pn2code.robot.scene import load


def test_the_example_in_si_units():
    cell = riveting_cell("good")
    assert [r.name for r in cell.robots] == ["robot1", "robot2"]
    robot2 = cell.robot("robot2")
    assert (robot2.base.x, robot2.base.y, robot2.base.z) == (6.25, 8.4, 0.9)
    assert robot2.base.rz == pytest.approx(-math.pi / 2)
    assert cell.motion.joint_jerk == pytest.approx(math.radians(1000))
    assert cell.scene.panel is not None
    assert cell.scene.panel.ribs == (5.5, 6.0, 6.5, 7.0)
    assert {(c.a, c.b) for c in cell.scene.contacts} == {
        ("robot1/tool_tip", "panel/skin"),
        ("robot2/tool_tip", "panel/skin"),
        ("robot1/tool_tip", "robot2/tool_tip"),
    }


def test_layouts_differ_in_robot_2_only():
    good, paper = riveting_cell("good"), riveting_cell("paper")
    assert good.robot("robot1").base == paper.robot("robot1").base
    assert good.robot("robot2").base != paper.robot("robot2").base


def read(change):
    data = copy.deepcopy(geometry())
    change(data)
    d = Diagnostics()
    return load(data, EXAMPLE, nowhere, d), d


def put(*path, value):
    def change(data):
        for key in path[:-1]:
            data = data[key]
        data[path[-1]] = value

    return change


def remove(*path):
    def change(data):
        for key in path[:-1]:
            data = data[key]
        del data[path[-1]]

    return change


MISTAKES = [
    (put("robots", "robot1", "model", value="kr210"), "robot-model", "unknown robot model `kr210`"),
    (
        put("robots", "robot1", "tool", value="hammer"),
        "robot-tool",
        "unknown end effector `hammer`",
    ),
    (put("robots", "robot1", "hom", value=[]), "robot-key", "unknown key `hom` in `robots.robot1`"),
    (remove("robots", "robot2", "base"), "robot-key", "`robots.robot2.base` is missing"),
    (remove("robots", "robot2", "model"), "robot-key", "`robots.robot2.model` is missing"),
    (
        put("robots", "robot1", "home", value=[0, 1]),
        "robot-value",
        "a list of four, six or seven numbers is expected",
    ),
    (
        put("robots", "robot1", "home", value=[0, -150, 110, 0, 45, 90]),
        "robot-value",
        "HOME of `robot1` puts axis 2 at -150 degrees, outside -140 .. -5",
    ),
    (put("robots", "robot1", "branch", value="up"), "robot-value", "one of any, front/up/plus"),
    (
        put("robots", "robot1", "base", "x", value="6"),
        "robot-value",
        "`robots.robot1.base.x` is `6`",
    ),
    (
        put("robots", "robot1", "base", "x", value=math.nan),
        "robot-value",
        "a number from -1000 to 1000 is expected",
    ),
    (
        put("robots", "robot1", "base", value=3),
        "robot-value",
        "`robots.robot1.base` must be a table",
    ),
    (
        put("motion", "joint_speed", value=1.5),
        "robot-value",
        "a number from 0.0001 to 1 is expected",
    ),
    (
        put("motion", "linear_speed", value=0),
        "robot-value",
        "a number from 1e-05 to 100 is expected",
    ),
    (put("motion", "linear_sped", value=1), "robot-key", "unknown key `linear_sped`"),
    (put("motion", "sample_s", value=True), "robot-value", "`motion.sample_s` is `True`"),
    (put("scene", "panel", "radius", value=-1.0), "robot-value", "`scene.panel.radius` is `-1.0`"),
    (
        put("scene", "panel", "x_to", value=4.0),
        "robot-value",
        "a number above `x_from` is expected",
    ),
    (put("scene", "panel", "x_to", value="5.0"), "robot-value", "`scene.panel.x_to` is `5.0`"),
    (
        put("scene", "panel", "ribs", value=["a"]),
        "robot-value",
        "a list of numbers from -1000 to 1000 is expected",
    ),
    (put("scene", "floor", value=1), "robot-value", "`true` or `false` is expected"),
    (remove("scene", "panel", "axis_y"), "robot-key", "`scene.panel.axis_y` is missing"),
    (put("scene", "objects", value=3), "robot-value", "a list of tables is expected"),
    (
        put("scene", "objects", value=[{"name": "a", "kind": "cone"}]),
        "robot-value",
        "`mesh` is expected",
    ),
    (
        put("scene", "objects", value=[{"name": "a", "kind": "mesh", "file": "no.obj"}]),
        "robot-value",
        "OBJ or STL file that exists",
    ),
    (
        put("scene", "objects", value=[{"name": "a", "size": [1, 0, 1]}]),
        "robot-value",
        "three numbers above 0",
    ),
    (
        put("scene", "contacts", value=[{"a": "panel/ribs"}]),
        "robot-key",
        "`b` of the 1st of `scene.contacts` is missing",
    ),
    (
        put("scene", "contacts", value=[{"a": "robt1/tool_tip", "b": "panel/ribs"}]),
        "robot-value",
        "did you mean `robot1`?",
    ),
    (
        put("scene", "objects", value=[{"name": "a"}]),
        "robot-key",
        "`size` of `a` in `scene.objects` is missing",
    ),
    (
        put("scene", "objects", value=[{"name": "a", "size": [1, 1, 1]}] * 2),
        "robot-value",
        "two objects of the scene are called `a`",
    ),
    (
        put("scene", "objects", value=[{"name": "a", "size": [1, 1, 1], "colour": [1, 1]}]),
        "robot-value",
        "three or four numbers from 0 to 1",
    ),
]


@pytest.mark.parametrize(("change", "code", "message"), MISTAKES, ids=[m[2] for m in MISTAKES])
def test_mistakes_are_reported(change, code, message):
    cell, d = read(change)
    assert cell is None
    [error] = d.errors
    assert error.code == code
    assert message in error.message + error.hint
    assert error.origin.file == "cell.toml"


def test_home_in_radians_that_is_outside_the_limits_gets_a_hint():
    _, d = read(put("robots", "robot1", "home", value=[0, -2.18, 2.18, 0, 0.785, 1.57]))
    assert "outside -140 .. -5" in d.errors[0].message
    assert "if these are radians, multiply them by 57.2958" in d.errors[0].hint


def test_near_names_are_suggested():
    _, d = read(put("motion", "linear_sped", value=1))
    assert d.errors[0].hint == "did you mean `linear_speed`?"


def test_all_mistakes_at_once():
    def change(data):
        put("motion", "joint_speed", value=2)(data)
        put("robots", "robot2", "model", value="x")(data)
        put("scene", "floor", value=0)(data)

    _, d = read(change)
    assert len(d.errors) == 3


def test_a_robot_without_a_tool():
    cell, d = read(remove("robots", "robot1", "tool"))
    assert cell is not None, list(d)
    assert cell.robot("robot1").tool is None
    assert [c.a for c in cell.scene.contacts] == ["robot2/tool_tip"]


def test_objects_of_all_kinds(tmp_path):
    (tmp_path / "cube.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n")
    d = Diagnostics()
    scene = {
        "objects": [
            {"name": "table", "size": [1, 2, 0.5], "pose": {"x": 1.0, "yaw": 90}},
            {"name": "post", "kind": "cylinder", "radius": 0.1, "length": 2.0, "colour": [1, 0, 0]},
            {"name": "part", "kind": "mesh", "file": "cube.obj", "scale": 0.1},
        ],
        "contacts": [{"a": "post", "b": "table", "depth": 0.001}],
    }
    cell = load({"scene": scene}, tmp_path, nowhere, d)
    assert cell is not None, list(d)
    assert [b.name for b in bodies(cell)] == ["floor", "table", "post", "part"]
    assert cell.scene.objects[1].colour == (1.0, 0.0, 0.0, 1.0)


def test_an_empty_cell():
    d = Diagnostics()
    cell = load({}, EXAMPLE, nowhere, d)
    assert cell is not None, list(d)
    assert cell.robots == ()


def test_the_joint_line_of_the_panel_is_where_the_rivets_go():
    """Arc angle 0 of the example's panel is the line of the references of the case study."""
    panel = riveting_cell("good").scene.panel
    assert point_at(panel, 0.0, panel.radius) == pytest.approx((5.8988, 2.13505), abs=5e-5)


def test_stringers_keep_clear_of_the_joint_line():
    panel = riveting_cell("good").scene.panel
    ribs = next(b for b in panel_bodies(panel) if b.name == "panel/ribs")
    long = [s for s in ribs.solids if s.size[0] > 2.0]
    assert len(long) == 13
    y, z = point_at(panel, 0.0, panel.radius)
    assert min(math.hypot(s.pose.y - y, s.pose.z - z) for s in long) > 0.12


def test_fake_backend_knows_where_the_tool_is():
    cell = riveting_cell("good")
    backend = open_backend("fake", cell)
    robot = cell.robot("robot1")
    expected = robot.T_world_base @ robot.kinematics.forward(robot.home)
    assert (backend.tcp("robot1") == expected).all()
    assert backend.clearances(1.0) is None
    backend.close()


def test_a_window_needs_a_display(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    with pytest.raises(BackendUnavailableError, match="there is no display"):
        open_backend("bullet", riveting_cell("good"), gui=True)


@pytest.mark.parametrize("text", ["not a mesh", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"])
def test_what_parts_stand_on_is_a_body(text, tmp_path):
    """Else what stands on it would be said to be in the air."""
    (tmp_path / "sheet.obj").write_text(text, encoding="utf-8")
    sheet = {"name": "sheet", "kind": "mesh", "file": "sheet.obj"}
    door = {"from": 0.0, "to": 1.0, "objects": [sheet]}
    parts = {"box": {"size": [0.1, 0.1, 0.1]}}
    cells = (
        ("objects", {"parts": parts, "scene": {"objects": [sheet]}}),
        ("door.objects", {"parts": parts, "devices": {"mill": {"axes": {"door": door}}}}),
    )
    for where, geometries in cells:
        d = Diagnostics()
        assert load(geometries, tmp_path, nowhere, d) is None
        (error,) = d.errors
        assert f"{where}" in error.message and "of a body that is not flat" in error.message
    # Where there are no parts, nothing stands on it; but it can be touched, if it is anything.
    alone = load({"scene": {"objects": [sheet]}}, tmp_path, nowhere, Diagnostics())
    assert (alone is not None) == text.startswith("v")


@pytest.mark.parametrize("text", ["not a mesh", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"])
def test_a_part_is_a_body(text, tmp_path):
    """Of what cannot be read, or is flat, nobody could say what it stands on when it is released."""
    (tmp_path / "sheet.obj").write_text(text, encoding="utf-8")
    d = Diagnostics()
    part = {"kind": "mesh", "file": "sheet.obj"}
    assert load({"parts": {"sheet": part}}, tmp_path, nowhere, d) is None
    (error,) = d.errors
    assert "`parts.sheet.file` is `sheet.obj`, but an OBJ or STL file that" in error.message
