"""Tools that a robot changes: where they have to be, what each is good for, what hangs on the flange with it."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.tool_cell import DRIVER, TOML, placed
from pn2code.arms import Arms
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.replay.arrays import unpacked
from pn2code.replay.cell import at_start, describe, put, tool_in_use
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.commands import (
    Along,
    Handling,
    MoveHome,
    MoveJoint,
    MoveLinear,
    Pose,
    ToolAction,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.gripped import MoveEnds
from pn2code.robot.led_contacts import Led, LedContact, LedContacts
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.part import Part, PartFault, carried_to
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import Array, matrix_of, pose_of
from pn2code.robot.zones import ZoneWatch
from pn2code.run.record import PartRecord

DOWN = math.pi
LOCK = {name: Handling("couples", name) for name in ("gripper", "driver")}
FREE = {name: Handling("uncouples", name) for name in ("gripper", "driver")}
TAKE, RELEASE = Handling("takes", "blank"), Handling("releases", "blank")
OTHER = """
[robots.other]
instance = "Other"
model = "gp25"
base = { y = 5.0 }
home = [0.0, 0.0, 0.0, 0.0, -90.0, 0.0]
tools = ["gripper"]
"""


def at(x: float, y: float, z: float, turned: float = 0.0) -> Array:
    return matrix_of(Pose(x, y, z, DOWN, 0.0, turned))


LEFT, RIGHT = at(0.3, -0.9, 0.75), at(-0.3, -0.9, 0.75)


@pytest.fixture
def cell(tmp_path: Path) -> RobotCell:
    return read(tmp_path)


def read(folder: Path, toml: str = TOML) -> RobotCell:
    found, d = placed(folder, toml)
    assert found is not None, [e.message for e in d.errors]
    return found


def wrong(folder: Path, old: str, new: str) -> list[str]:
    assert old in TOML or not old
    _, d = placed(folder, TOML.replace(old, new, 1) if old else TOML + new)
    return [e.message for e in d.errors]


# --- parts ---------------------------------------------------------------------------------------


def test_a_tool_is_coupled_and_left(cell: RobotCell) -> None:
    parts = Parts(cell)
    assert parts.tool_of("arm") == "" and parts.present["gripper"].holder == ""
    change = parts.handle("arm", LOCK["gripper"], at(0.301, -0.9, 0.75))
    assert (change.effect, change.part, change.pose.x) == ("couples", "gripper", pytest.approx(0.3))
    tool = parts.present["gripper"]
    assert tool.holder == "arm" and (tool.frame == np.eye(4)).all(), "the coupling centres it"
    assert parts.tool_of("arm") == "gripper" and parts.held_by("arm") is None
    parts.handle("arm", FREE["gripper"], at(0.299, -0.9, 0.75))
    assert parts.present["gripper"].frame == pytest.approx(LEFT)
    assert parts.tool_of("arm") == ""


@pytest.mark.parametrize(
    ("before", "does", "where", "says"),
    [
        ((), LOCK["gripper"], at(0.303, -0.9, 0.75), "which lies 3.0 mm away \\(at most 2 mm, 2 deg\\)"),
        ((), LOCK["gripper"], at(0.3, -0.9, 0.75, 0.1), "which lies 0.0 mm and 5.7 deg away"),
        ((), LOCK["gripper"], RIGHT, "which lies 600.0 mm away .*; `driver` lies here"),
        ((), FREE["gripper"], LEFT, "but it has no tool in use"),
        ((LOCK["gripper"],), LOCK["driver"], RIGHT, "but it has tool `gripper` in use"),
        ((LOCK["gripper"],), FREE["driver"], RIGHT, "but it has tool `gripper` in use"),
        ((LOCK["gripper"],), FREE["gripper"], at(0.3, -0.9, 0.753), "its place `rackLeft` is 3.0 mm away"),
    ],
)  # fmt: skip
def test_where_it_has_to_be(
    cell: RobotCell, before: tuple[Handling, ...], does: Handling, where: Array, says: str
) -> None:
    parts = Parts(cell)
    for handling in before:
        parts.handle("arm", handling, LEFT)
    with pytest.raises(PartFault, match=says):
        parts.handle("arm", does, where)


def test_a_tool_that_another_robot_has(tmp_path: Path) -> None:
    parts = Parts(read(tmp_path, TOML + OTHER))
    parts.handle("arm", LOCK["gripper"], LEFT)
    with pytest.raises(PartFault, match="`other` couples tool `gripper`, but `arm` has it in use"):
        parts.handle("other", LOCK["gripper"], LEFT)


def test_a_place_where_another_tool_lies(tmp_path: Path) -> None:
    """Two tools may share a place, as long as one of them is in use."""
    toml = TOML.replace('rack = "rackRight"', 'rack = "rackLeft"').replace(
        "tools = [", 'begins_with = "driver"\ntools = ['
    )
    parts = Parts(read(tmp_path, toml))
    assert parts.tool_of("arm") == "driver"
    with pytest.raises(PartFault, match="but tool `gripper` lies at its place `rackLeft`"):
        parts.handle("arm", FREE["driver"], LEFT)


def test_a_part_is_gripped_at_the_tcp_of_the_tool(cell: RobotCell) -> None:
    parts = Parts(cell)
    parts.handle("arm", LOCK["gripper"], LEFT)
    with pytest.raises(PartFault, match="200.0 mm from where it can be gripped"):
        parts.handle("arm", TAKE, at(1.0, 0.3, 0.5))
    parts.handle("arm", TAKE, at(1.0, 0.3, 0.7))
    assert parts.held_by("arm").kind.name == "blank"  # type: ignore[union-attr]
    with pytest.raises(PartFault, match="uncouples tool `gripper`, which still holds `blank.1`"):
        parts.handle("arm", FREE["gripper"], LEFT)
    parts.handle("arm", RELEASE, at(1.0, -0.3, 0.7))
    assert parts.present["blank.1"].frame[:3, 3] == pytest.approx([1.0, -0.3, 0.45])
    parts.handle("arm", FREE["gripper"], LEFT)


def test_what_is_no_part(cell: RobotCell) -> None:
    """Nothing stands on a tool that lies there, and no sensor takes it for a part."""
    parts = Parts(cell)
    assert not parts.is_seen("rackLeft") and not parts.is_seen("rackLeft", "gripper")
    assert {p.name for p, _ in parts.everywhere({})} == {"blank.1"}
    assert parts.copy().present.keys() == {"blank.1", "gripper", "driver"}


# --- moves ---------------------------------------------------------------------------------------


def after(cell: RobotCell, *commands: object) -> RobotExecutor:
    executor = RobotExecutor(cell.robot("arm"), cell.motion, cell.frames)
    for command in commands:
        executor.begin(command, 0.0)  # type: ignore[arg-type]
        executor.finish()
    return executor


def lock(name: str) -> ToolAction:
    return ToolAction("lock", 1.0, LOCK[name])


def test_moves_are_those_of_the_tool_in_use(cell: RobotCell) -> None:
    goal = MoveJoint(Pose(1.0, 0.0, 0.7, DOWN, 0.0, 0.0))
    heights = []
    for commands in ((), (lock("gripper"),), (lock("driver"),)):
        executor = after(cell, *commands, goal)
        heights.append(float((executor.robot.T_world_base @ executor.T_base_tcp)[2, 3]))
    assert heights == pytest.approx([0.7, 0.9, 0.98])
    coupling = MoveLinear(Pose(1.0, 0.0, 0.8, DOWN, 0.0, 0.0), tcp="coupling")
    executor = after(cell, lock("driver"), goal, coupling)
    assert float((executor.robot.T_world_base @ executor.T_base_tcp)[2, 3]) == pytest.approx(0.8)


def test_an_increment_is_one_of_the_tool_in_use(cell: RobotCell) -> None:
    turn = MoveLinear(Pose(0.0, 0.0, 0.0, 0.2, 0.0, 0.0), frame="tool")
    goal = MoveJoint(Pose(1.0, 0.0, 0.7, DOWN, 0.0, 0.0))
    executor = after(cell, lock("driver"), goal, turn)
    robot = executor.robot
    tip = robot.T_world_base @ robot.tcps["driver"].forward(executor.q)
    assert tip[:3, 3] == pytest.approx([1.0, 0.0, 0.7], abs=1e-9)


def test_on_a_track_and_with_a_tool_that_stays_on_the_flange(tmp_path: Path) -> None:
    """The coupling is the TCP of what stays there, wherever the track has carried the arm."""
    toml = TOML.replace("tools = [", 'tool = "counterpoint"\ntools = [').replace(
        "[robots.arm.tcps.coupling]",
        "[robots.arm.tcps.coupling]\nz = 0.5\n"
        "[robots.arm.axes.rail]\ndirection = [0.0, 1.0, 0.0]\nfrom = -1.0\nto = 1.0",
    )
    cell = read(tmp_path, toml)
    there = (Along("rail", -0.5, is_track=True),)
    goal = MoveLinear(Pose(0.9, -0.5, 0.9, DOWN, 0.0, 0.0), along=there)
    executor = after(
        cell, lock("driver"), MoveJoint(Pose(0.9, -0.5, 1.0, DOWN, 0.0, 0.0), along=there), goal
    )
    robot = executor.robot
    coupling = robot.T_world_base @ executor.T_base_tcp
    assert coupling[:3, 3] == pytest.approx([0.9, -0.5, 0.9 + 0.28], abs=1e-6)
    assert robot.of_tool("driver", coupling)[:3, 3] == pytest.approx([0.9, -0.5, 0.9], abs=1e-6)
    assert robot.tcps["coupling"].T_flange_tcp == pytest.approx(robot.kinematics.T_flange_tcp)
    parts = Parts(cell)
    parts.handle("arm", LOCK["driver"], RIGHT)
    held = carried_to(robot, executor.q, parts.present["driver"])
    assert held == pytest.approx(coupling, abs=1e-6)


@pytest.mark.parametrize(
    ("commands", "says"),
    [
        ((lock("gripper"), lock("driver")), "it couples tool `driver`, but `gripper` is in use"),
        ((ToolAction("u", 1.0, FREE["driver"]),), "it uncouples tool `driver`, but no tool is in use"),
        ((ToolAction("grip", 1.0, TAKE),), "takes a part `blank`, which needs tool `gripper`, but no tool is in use"),
        ((lock("driver"), ToolAction("grip", 1.0, TAKE)), "which needs tool `gripper`, but `driver` is in use"),
        ((lock("gripper"), ToolAction("drive", 1.0)), "action `drive` needs tool `driver`, but `gripper` is in use"),
        (
            (lock("gripper"), MoveLinear(Pose(1.0, 0.0, 0.7, DOWN, 0.0, 0.0), tcp="driver")),
            "it moves tool `driver`, but `gripper` is in use",
        ),
        ((ToolAction("lock", 1.0, Handling("couples", "x")),), "it does not change tool `x`"),
    ],
)  # fmt: skip
def test_what_needs_another_tool_is_a_fault(
    cell: RobotCell, commands: tuple[object, ...], says: str
) -> None:
    with pytest.raises(MotionFault, match=says) as fault:
        after(cell, *commands)
    assert fault.value.kind == "wrong-tool" and "at TCP pose" in str(fault.value)


def test_a_cell_without_tools_that_are_changed_needs_none(tmp_path: Path) -> None:
    toml = TOML.replace('tools = ["gripper", "driver"]', 'tool = "vacuum_gripper"')
    after(read(tmp_path, toml), ToolAction("grip", 1.0, TAKE), ToolAction("drive", 1.0))


def test_what_has_no_history_asks_every_tool(cell: RobotCell) -> None:
    """A pose that only the longer tool reaches is neither out of reach nor proved to be within it."""
    arms = Arms({"": cell})

    def ahead(x: float, tcp: str = "") -> MoveJoint:
        return MoveJoint(Pose(x, 0.0, 0.9, 0.0, math.pi / 2.0, 0.0), tcp=tcp)

    said = {
        (x, tcp): (bool(arms.why_unreachable("arm", ahead(x, tcp))), arms.depends_on_tool("arm", ahead(x, tcp)))
        for x in (1.2, 1.95, 3.0)
        for tcp in ("", "driver", "coupling")
    }  # fmt: skip
    assert said == {
        (1.2, ""): (False, False),
        (1.2, "driver"): (False, False),
        (1.2, "coupling"): (False, False),
        (1.95, ""): (False, True),
        (1.95, "driver"): (False, False),
        (1.95, "coupling"): (True, False),
        (3.0, ""): (True, False),
        (3.0, "driver"): (True, False),
        (3.0, "coupling"): (True, False),
    }


# --- loads ---------------------------------------------------------------------------------------


def test_each_tool_has_its_load_and_its_pace(tmp_path: Path) -> None:
    (tmp_path / "weak.urdf").write_text(
        (Path(__file__).parents[3] / "src/pn2code/robot/models/gp25.urdf")
        .read_text()
        .replace('"../meshes', '"meshes')
        .replace("</robot>", '<pn2code load="1" speed="1" acceleration="1"/><pn2code load="5" speed="0.5" '
                 'acceleration="0.25"/></robot>')
    )  # fmt: skip
    cell = read(tmp_path, TOML.replace('"gp25"', '"weak.urdf"'))
    arm = cell.robot("arm")
    masses = {
        t: max(x.mass for x in arm.loads_with(t, cell.parts, ("blank",))) for t in ("", *arm.tools)
    }
    assert masses == {"": 0.0, "gripper": 2.0, "driver": 5.0}, "only the gripper takes parts"
    assert arm.pace == (1.0, 1.0) and arm.paces["driver"] == (0.5, 0.25)
    light, heavy = (
        after(cell, *c).begin(MoveHome(), 0.0).duration
        for c in (
            (MoveJoint(Pose(1.0, 0.0, 0.7, DOWN, 0.0, 0.0), tcp="coupling"),),
            (lock("driver"), MoveJoint(Pose(1.0, 0.0, 0.7, DOWN, 0.0, 0.0), tcp="coupling")),
        )
    )
    assert heavy > 1.3 * light
    centre = arm.tools["driver"].with_coupling(None)
    assert (centre[1], centre[2].tolist()) == (5.0, [0.0, 0.0, 0.08])
    too_heavy = replaced_payload(tmp_path, "4")
    assert "`driver`" in too_heavy and "5 kg, but 4 kg are rated" in too_heavy


def replaced_payload(folder: Path, most: str) -> str:
    text = (folder / "weak.urdf").read_text()
    (folder / "weaker.urdf").write_text(text.replace('payload="25"', f'payload="{most}"'))
    cell = read(folder, TOML.replace('"gp25"', '"weaker.urdf"'))
    return cell.robot("arm").overload(cell.parts, ("blank",))


# --- shapes --------------------------------------------------------------------------------------


def test_a_tool_in_use_is_in_zones(tmp_path: Path) -> None:
    zone = "\n[zones.front]\npose = { x = 9.0 }\nsize = [1.0, 1.0, 1.0]\n"
    cell = read(tmp_path, TOML.replace("tools = [", 'begins_with = "driver"\ntools = [') + zone)
    arm = cell.robot("arm")
    placed_ = dict(ZoneWatch(cell).placed("arm", np.array(arm.home), Parts(cell).present.values()))
    flange = arm.T_world_base @ arm.kinematics.forward(np.array(arm.home))
    local = (placed_["arm/driver"] - flange[:3, 3]) @ flange[:3, :3]
    assert local.min(axis=0) == pytest.approx([-0.05, -0.05, 0.0])
    assert local.max(axis=0) == pytest.approx([0.05, 0.05, 0.28])


def nodes_of(glb: bytes) -> list[dict[str, Any]]:
    """The nodes of a glTF, whose matrices are by columns."""
    found = json.loads(glb[20 : 20 + int.from_bytes(glb[12:16], "little")])
    return list(found["nodes"])


def test_what_the_replay_page_is_told(tmp_path: Path) -> None:
    """A tool is one kind of things, with the shapes of all links; one that is in use hangs at the coupling."""
    cell = read(tmp_path, TOML.replace("tools = [", 'begins_with = "driver"\ntools = ['))
    described = describe(cell)
    assert described["robots"][0]["changes"] is True
    assert np.array(described["tools"]["driver"]).reshape(4, 4)[2, 3] == pytest.approx(0.28)
    nodes = nodes_of(unpacked(described["glb"]).tobytes())
    body, bit = (nodes[k] for k in nodes[described["kinds"]["driver"]]["children"])
    assert body["matrix"][14] == pytest.approx(0.08)
    assert bit["matrix"][14] == pytest.approx(0.16 + 0.06)
    start = at_start(cell)
    assert start["driver"]["holder"] == "arm" and start["gripper"]["holder"] == ""
    assert np.array(start["gripper"]["frame"]).reshape(4, 4) == pytest.approx(LEFT)
    parts = Parts(cell)
    left = parts.handle("arm", FREE["driver"], RIGHT)
    taken = parts.handle("arm", LOCK["gripper"], LEFT)
    assert put(cell, left, "arm")["holder"] == "" and put(cell, taken, "arm")["holder"] == "arm"
    entries = [PartRecord(1.0, "arm", left), PartRecord(2.0, "arm", taken)]
    arm = cell.robot("arm")
    assert [tool_in_use(arm, entries, t) for t in (0.5, 1.5, 2.5)] == ["driver", "", "gripper"]


def test_contacts_that_are_permitted(cell: RobotCell) -> None:
    rules = {(r.a, r.b) for r in cell.scene.contacts}
    assert ("arm/link_6", "gripper") in rules and ("arm/link_6", "gripper.*") in rules
    assert ("arm/gripper", "rack") in rules and ("arm/gripper", "blank.*") in rules
    assert ("arm/driver", "rack") not in rules and ("arm/gripper", "stand") not in rules
    assert ("arm/driver", "blank.*") not in rules and ("arm/link_5", "gripper") not in rules


@pytest.mark.bullet
def test_sweeps_measure_the_tool_and_the_part_in_it(cell: RobotCell) -> None:
    """The part comes further on a way than the tool, so that what is known of the nearer one does not tell."""
    tool = Part("gripper", cell.tools["gripper"], np.eye(4), "arm")
    part = Part(
        "blank.1", cell.parts["blank"], matrix_of(Pose(0.0, 0.0, 0.2, 0.0, 0.0, 0.0)), "arm"
    )
    backend = BulletBackend(cell, looks=False)
    try:
        backend.set_part(tool)
        backend.set_part(part)
        backend.set_joints("arm", np.array(cell.robots[0].home))
        found = {(x.a, x.b): x.distance for x in backend.distances.pairs("self", "arm", 1.0)}
        seen = [x for x in backend.clearances(1.0) or () if x.kind == "self"]
    finally:
        backend.close()
    for link in ("link_3", "link_4", "link_5"):
        assert ("arm/gripper", f"arm/{link}") in found and ("arm/blank.1", f"arm/{link}") in found
    assert {x.distance for x in seen} == {min(found.values())}


# --- mistakes ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('rack = "rackLeft"', 'rack = "rackLft"', "`tools.gripper.rack`"),
        ('rack = "rackRight"', 'rack = "rackLeft"', "tools `gripper` and `driver` are both at place `rackLeft`"),
        ('rack = "rackRight"\n', "", "no robot begins with tool `driver`, and it has no place"),
        ('holders = ["rack"]', 'holders = ["rck"]', "`tools.gripper.holders` names `rck`"),
        ('takes = ["blank"]', 'takes = ["blnk"]', "`tools.gripper.takes` names `blnk`"),
        ('"gripper", "driver"]', '"gripper", "drver"]', "`robots.arm.tools` names `drver`, which is no tool"),
        ("tools = [", 'begins_with = "x"\ntools = [', "`robots.arm.begins_with`"),
        ("[robots.arm.tcps.coupling]", "[robots.arm.tcps.driver]", "names `driver`, which is no name of its own"),
        ("[tools.gripper]", "[tools.blank]", "`blank` is not a name for a tool"),
        ('name = "stand"', 'name = "driver"', "an object of the scene and a tool are called `driver`"),
        ('model = "driver.urdf"', 'model = "no.urdf"', "there is no file"),
    ],
)  # fmt: skip
def test_mistakes_are_told(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert any(says in m for m in wrong(tmp_path, old, new)), wrong(tmp_path, old, new)


def test_who_holds_what_is_not_there_is_told_where_it_says_so(tmp_path: Path) -> None:
    (tmp_path / "driver.urdf").write_text(DRIVER, encoding="utf-8")
    data = tomllib.loads(TOML.replace('holders = ["rack"]', 'holders = ["rck"]', 1))
    d = Diagnostics()
    load(data, tmp_path, lambda *path: Origin(".".join(map(str, path))), d)
    assert [e.origin for e in d.errors] == [Origin("tools.gripper.holders")]


def test_one_tool_on_two_robots(tmp_path: Path) -> None:
    toml = TOML.replace("tools = [", 'begins_with = "gripper"\ntools = [') + OTHER
    _, d = placed(tmp_path, toml + 'begins_with = "gripper"\n')
    assert [e.message for e in d.errors] == [
        "robots `arm` and `other` both begin with tool `gripper`, of which there is one"
    ]


def test_a_tool_without_a_place_is_not_left(tmp_path: Path) -> None:
    toml = TOML.replace("tools = [", 'begins_with = "driver"\ntools = [')
    _, d = placed(tmp_path, toml.replace('rack = "rackRight"\n', ""))
    assert [e.message for e in d.errors] == [
        "`leaveDriver` uncouples tool `driver`, and it has no place"
    ]


# --- what may touch -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tool", "x", "z", "led"),
    [
        ("", 0.3, 0.75, (True, False)),
        ("", 0.3, 0.77, (True, False)),  # the rest of the way is another line
        ("", -0.3, 0.75, (False, False)),  # where the other one lies
        ("", 0.31, 0.75, (False, False)),
        ("gripper", 0.3, 0.75, (True, True)),
        ("gripper", 0.0, 0.75, (False, False)),  # beside its place
    ],
)
def test_a_coupling_touches_what_it_takes_and_a_tool_its_own_rack(
    cell: RobotCell, tool: str, x: float, z: float, led: tuple[bool, bool]
) -> None:
    """They might touch any tool and any place of the rack, on any line, up to a millimetre deep."""
    arm = RobotExecutor(cell.robot("arm"), cell.motion)
    arm.begin(MoveJoint(pose_of(at(x, -0.9, 0.95)), tcp="coupling"), 0.0)
    arm.finish()
    arm.stand(arm.q, arm.T_base_tcp, tool)
    path = arm.begin(MoveLinear(pose_of(at(x, -0.9, z)), tcp="coupling"), 0.0).trajectory
    ends = MoveEnds.of(cell.robot("arm"), tool, path)
    contacts = LedContacts(cell)
    lying = contacts.between("arm/link_6", "gripper"), Parts(cell).present["gripper"]
    held = contacts.between("arm/gripper", "rack"), None
    assert lying[0] == LedContact("arm", "", "gripper") and held[0] == LedContact("arm", "", "rack")
    home = np.array(cell.robot("arm").home)
    assert led == tuple(
        contact is not None
        and contacts.of_move(contact, ends, (None, part), lambda _name: home, (0.0, 1.0))
        is Led.NEAR
        for contact, part in (lying, held)
    )
