"""Devices of which something moves: doors and clamps, their axes, what they touch and what they hold."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers.door_cell import TOML, door_cell
from helpers.robot_cells import nowhere, pose_mm
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.geometry.apart import Apart
from pn2code.geometry.compare import Comparison
from pn2code.geometry.contents import Contents
from pn2code.geometry.legs import Leg, Planner
from pn2code.geometry.met_pairs import touch_in_words
from pn2code.geometry.shown import Shown
from pn2code.replay.cell import describe
from pn2code.robot.bullet import BulletBackend
from pn2code.robot.clamps import holding
from pn2code.robot.commands import (
    Along,
    Handling,
    MoveExternal,
    MoveHome,
    MoveLinear,
    ToolAction,
)
from pn2code.robot.executor import RobotExecutor
from pn2code.robot.monitor import Monitor
from pn2code.robot.motion_fault import MotionFault
from pn2code.robot.parts import Parts
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.scene import load
from pn2code.robot.transforms import matrix_of

DATA: dict[str, Any] = tomllib.loads(TOML)


def cell_of(**changed: Any) -> tuple[RobotCell | None, list[str]]:
    """The cell with keys of the door or the clamp replaced, and what is said."""
    devices = tomllib.loads(TOML)["devices"]
    axes = devices["mill"]["axes"]
    for name, value in changed.items():
        axis, _, key = name.partition("__")
        if not key:
            axes[axis] = value
        elif value is None:
            del axes[axis][key]
        else:
            axes[axis][key] = value
    d = Diagnostics()
    found = load({**DATA, "devices": devices}, Path(), nowhere, d)
    return found, [e.message for e in d.errors]


CELL, _SAID = cell_of()


def test_the_axes_of_a_device_are_what_the_file_says() -> None:
    assert CELL is not None and not _SAID
    (mill,) = CELL.devices
    assert CELL.robot("mill") is mill and [r.name for r in CELL.robots] == ["arm"]
    assert mill.is_device and mill.arm.axes == ("door", "vice_1", "vice_2")
    assert mill.home == (0.0, 0.02, 0.02)
    door, one, other = mill.kinematics.link_frames(np.array([[0.5, 0.03, 0.03]]))[:3]
    assert np.allclose(door[0, :3, 3], (0.78, 0.5, 0.85))
    # The jaws close along the x of the clamp, which is the y of the world.
    assert np.allclose(one[0, :3, 3], (1.0, 0.03, 0.62))
    assert np.allclose(other[0, :3, 3], (1.0, -0.03, 0.62))
    shown = describe(CELL)["robots"]
    assert [r["name"] for r in shown] == ["arm", "mill"]
    assert [j.get("slides") for j in shown[1]["joints"]] == [True] * 3


def test_a_swing_turns_about_the_z_of_its_pose() -> None:
    leaf = {"name": "leaf", "size": [0.5, 0.02, 0.4], "pose": {"x": 0.25}}
    cell, said = cell_of(
        door={"kind": "swing", "pose": {"x": 2.0}, "from": 0.0, "to": 90.0, "objects": [leaf]}
    )
    assert cell is not None and not said
    mill = cell.robot("mill")
    executor = RobotExecutor(mill, cell.motion)
    motion = executor.begin(MoveExternal((Along("door", math.radians(90.0), False),)), 0.0)
    # 90 degrees at 60 degrees/s, and 0.5 s to be fast, with 0.2 s of the acceleration.
    assert motion.kind == "axis" and motion.duration == pytest.approx(90.0 / 60.0 + 0.5 + 0.2)
    frame = mill.kinematics.link_frames(np.array([executor.motion.q(motion.ends)]))[0][0]  # type: ignore[union-attr]
    assert np.allclose(frame @ (0.5, 0.0, 0.0, 1.0), (2.0, 0.5, 0.0, 1.0))


def test_how_long_it_takes_follows_from_stroke_and_speed() -> None:
    assert CELL is not None
    executor = RobotExecutor(CELL.robot("mill"), CELL.motion)
    whole = executor.begin(MoveExternal((Along("door", 0.9, True),)), 0.0).duration
    assert whole == pytest.approx(0.9 / 0.6 + 0.6 / 1.0 + 1.0 / 10.0)
    executor.finish()
    assert executor.q[0] == 0.9
    half = executor.begin(MoveExternal((Along("door", 0.0, True),), 0.5), whole).duration
    assert half == pytest.approx(0.9 / 0.3 + 0.3 / 1.0 + 1.0 / 10.0)
    executor.finish()
    # Of a clamp the gap is what is commanded: 0.08 m at 0.05 m/s, each jaw half of it.
    gap = executor.begin(MoveExternal((Along("vice", 0.12, True),)), 0.0)
    assert gap.duration == pytest.approx(0.08 / 0.05 + math.sqrt(0.05 / 10.0) * 2.0, abs=0.05)
    executor.finish()
    assert executor.q.tolist() == [0.0, 0.06, 0.06]


def test_a_device_refuses_what_it_cannot_do() -> None:
    assert CELL is not None
    executor = RobotExecutor(CELL.robot("mill"), CELL.motion)
    for command, words in (
        (MoveExternal((Along("door", 0.95, True),)), "`door` would be at 950.00 mm, outside 0.00"),
        (MoveExternal((Along("vice", 0.01, True),)), "`vice` would be at 10.00 mm, outside 20.00"),
        (MoveExternal((Along("lid", 0.1, True),)), "it has no axis that slides `lid`"),
        (MoveExternal((Along("door", 0.1, False),)), "it has no axis that turns `door`"),
        (MoveHome(), "it has no arm"),
    ):
        with pytest.raises(MotionFault, match=words) as fault:
            executor.begin(command, 0.0)
        assert "device `mill`: " in str(fault.value) and "TCP" not in str(fault.value)


def test_what_is_wrong_with_axes_is_said() -> None:
    for changed, words in (
        ({"door__to": 0.0}, "a number above `from` is expected"),
        ({"door__home": 2.0}, "`door` begins at 2 m, outside 0 .. 0.9"),
        ({"vice__home": None}, "`vice` begins at 0 m, outside 0.02 .. 0.12"),
        ({"vice__from": -0.01}, "a gap from 0 is expected"),
        ({"vice__holds": "inVise"}, "names `inVise`, which is no place of `[places]`"),
        (
            {"vice__pose": {"x": 3.0, "z": 0.62}},
            "opens to 0.12 m, but what it holds, at `inVice`, is 2 m beside",
        ),
        (
            {"vice__pose": {"x": 1.0, "z": 0.2, "yaw": 90.0}},
            "along the z of its `pose`, but what it holds, at `inVice`, is 0.475 m away",
        ),
        (
            {"vice__pose": {"x": 1.5, "z": 0.62, "yaw": 90.0}},
            "along the y of its `pose`, but what it holds, at `inVice`, is 0.5 m away",
        ),
        ({"door__direction": [0.0, 0.0, 0.0]}, "three numbers, not all of them 0"),
        ({"stand": DATA["devices"]["mill"]["axes"]["door"]}, "are called `stand`"),
        ({"vice_1": DATA["devices"]["mill"]["axes"]["door"]}, "are called `vice_1`"),
        ({"door__objects": []}, "objects` is `[]`, but a list of at least one table is expected"),
        ({"vice__may_be_empty": 1}, "`true` or `false` is expected"),
    ):
        cell, said = cell_of(**changed)
        assert cell is None and any(words in e for e in said), (changed, said)


def test_a_device_without_axes_has_no_table_of_them() -> None:
    data: dict[str, Any] = {**DATA, "devices": {"mill": {"instance": "Mill", "axes": {}}}}
    d = Diagnostics()
    assert load(data, Path(), nowhere, d) is None
    assert [e.message for e in d.errors] == ["device `mill` has `axes`, but none is named"]


@pytest.mark.parametrize("name", ["scene", "self", "floor"])
def test_no_device_has_the_name_of_what_arms_are_compared_with(name: str, tmp_path: Path) -> None:
    d = Diagnostics()
    toml = TOML.replace("devices.mill", f"devices.{name}")
    load_cell(door_cell(tmp_path / "cell", toml=toml) / "cell.toml", d)
    assert [e.message for e in d.errors] == [f"`{name}` is not a device name"]


def test_a_sensor_sees_an_axis_where_it_can_be(tmp_path: Path) -> None:
    for at, says in (("0.9", False), ("5.0", True), ("-0.1", True)):
        d = Diagnostics()
        eye = f'[sensors.eye]\nvariable = "there"\nsees = "mill.door"\nat = {at}\n'
        load_cell(door_cell(tmp_path / at, toml=TOML + eye) / "cell.toml", d)
        assert any("where axis `mill.door` never is" in e.message for e in d.errors) is says, at


def test_primitives_name_axes_that_are_there(tmp_path: Path) -> None:
    for old, new, words in (
        (
            'axis = "door", to = 0.9',
            'axis = "dor", to = 0.9',
            "no robot or device has an axis `dor`",
        ),
        ('axis = "door", to = 0.9', 'axis = "door", to = 1.9', "`to` is 1.9, but axis `door` goes"),
        ('axis = "vice" }', 'axis = "vice", track = "vice" }', "no robot has a track `vice`"),
    ):
        d = Diagnostics()
        assert load_cell(door_cell(tmp_path, toml=TOML.replace(old, new)), d) is None
        assert any(words in e.message for e in d.errors), [e.message for e in d.errors]


# --- distances -----------------------------------------------------------------------------------


@pytest.mark.bullet
def test_an_arm_in_a_closed_door_is_a_collision_with_both_names() -> None:
    assert CELL is not None
    backend = BulletBackend(CELL, looks=False)
    try:
        monitor = Monitor(CELL, backend)
        arm = CELL.robot("arm")
        found = arm.kinematics.nearest(
            np.linalg.inv(arm.T_world_base) @ matrix_of(pose_mm(780, 0, 900, 180, 0, 0)), arm.home
        )
        assert found is not None
        shut = monitor.check(0.0, {"arm": found.q, "mill": np.array([0.0, 0.02, 0.02])})
        assert shut.fault is not None and "`mill/door` collide" in shut.fault.message
        wide = monitor.check(1.0, {"arm": found.q, "mill": np.array([0.9, 0.02, 0.02])})
        assert wide.fault is None
        assert [s.is_device for s in wide.samples] == [False, True]
        assert not [e for e in monitor.minima() if e.robot == "mill" and e.measure == "condition"]
    finally:
        backend.close()


class _Swept:
    """Legs of the arm and the mill against each other."""

    def __init__(self) -> None:
        assert CELL is not None
        self.backend = BulletBackend(CELL, looks=False)
        self.planner = Planner(CELL)
        self.comparison = Comparison(CELL, self.planner, Shown(self.backend))
        at = self.planner.leg(self.planner.home("arm"), MoveLinear(pose_mm(600, 0, 900, 180, 0, 0)))
        assert at.fault is None
        self.into = self.planner.leg(at.end, MoveLinear(pose_mm(1000, 0, 900, 180, 0, 0)))

    def door(self, begin: float, end: float) -> Leg:
        first = self.planner.leg(self.planner.home("mill"), self.to(begin))
        return self.planner.leg(first.end, self.to(end))

    @staticmethod
    def to(position: float) -> MoveExternal:
        return MoveExternal((Along("door", position, True),))


@pytest.fixture(scope="module")
def swept() -> Any:
    out = _Swept()
    yield out
    out.backend.close()


@pytest.mark.bullet
def test_a_door_is_swept_wherever_it_can_be(swept: _Swept) -> None:
    """It is open before and after, and shut for a moment between: no two positions would show that."""
    comparison, planner = swept.comparison, swept.planner
    standing = planner.standing(planner.home("mill"))
    assert comparison.two((swept.into, ()), (standing, ())).outcome == "touch"
    wide = swept.door(0.9, 0.9)
    assert comparison.two((swept.into, ()), (wide, ())).outcome == "clear"
    closing = swept.door(0.9, 0.0)
    apart = comparison.two((swept.into, ()), (closing, ()))
    assert apart.outcome == "touch" and apart.where is not None
    assert {apart.where.a.split("/")[0], apart.where.b} == {"arm", "mill/door"}
    ajar = comparison.two((swept.into, ()), (swept.door(0.9, 0.75), ()))
    assert ajar.outcome == "clear" and ajar.least > 0.0


@pytest.mark.bullet
def test_a_part_in_a_clamp_that_is_not_open_cannot_be_taken_away(swept: _Swept) -> None:
    assert CELL is not None
    planner = swept.planner
    down = planner.leg(swept.into.end, MoveLinear(pose_mm(1000, 0, 750, 180, 0, 0)))
    up = planner.leg(down.end, MoveLinear(pose_mm(1000, 0, 900, 180, 0, 0)))
    parts = Parts(CELL)
    blank = parts.present["blank.1"]
    arm = CELL.robot("arm")
    tcp = arm.T_world_base @ down.end.T_base_tcp
    parts.present["blank.1"] = type(blank)(
        "blank.1", blank.kind, matrix_of(pose_mm(1000, 0, 675, 0, 0, 0))
    )
    parts.handle("arm", Handling("takes", "blank"), tcp)
    (held,) = holding(CELL, blank.kind, matrix_of(CELL.places["inVice"]))
    assert held.name == "mill/vice" and held.holds(np.array([0.0, 0.03, 0.03]))
    contents = Contents(0, parts)

    def pulled(moving: Leg, clamp: Leg) -> Apart | None:
        return swept.comparison._pulled(moving, contents, clamp)

    shut = planner.standing(planner.home("mill"))
    found = pulled(up, shut)
    assert found is not None and "pulls `blank.1` out of `mill/vice`" in touch_in_words(found)
    opening = planner.leg(planner.home("mill"), MoveExternal((Along("vice", 0.12, True),)))
    assert pulled(up, opening) is not None  # nobody knows how far it is
    assert pulled(up, planner.standing(opening.end)) is None
    assert pulled(down, shut) is None  # it comes from elsewhere
    rests = planner.leg(down.end, ToolAction("grip", 0.5))
    assert pulled(rests, shut) is None
