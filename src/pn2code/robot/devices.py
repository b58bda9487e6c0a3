"""Devices of which something moves: doors, clamps, belts.

Each is a robot without joints, of which all axes are external ones.

devices = read_devices(t, Around(folder, places, 0.2))    # of [devices]; those without `axes` are left out

So everything that knows of robots knows of them: planner, backends, sweeps, pictures.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import field, replace
from pathlib import Path

import numpy as np
from lxml import etree

from pn2code.base.frozen import frozen
from pn2code.cell_file.devices import DEVICE_AXIS, DEVICE_PLACE
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes, urdf
from pn2code.robot.belt_lines import expect_lines
from pn2code.robot.carried import STAND, add_joint, add_limit, add_shape, axis_words
from pn2code.robot.commands import Pose
from pn2code.robot.device_kinematics import DeviceKinematics
from pn2code.robot.external import Belt, Clamp, ExternalAxis, Externals
from pn2code.robot.model import Arm
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.scene_objects import SceneObject, read_colour
from pn2code.robot.solid_objects import read_solids
from pn2code.robot.table import Table
from pn2code.robot.table_poses import NO_POSE, read_pose
from pn2code.robot.transforms import Array, inverse, matrix_of, pose_of

_ENDLESS = 1e6
"""m: so far a belt can run."""
_SAME = 1e-6
"""m: so near is the same."""
_PACE = ("speed", "acceleration", "jerk")


@frozen(eq=False)
class _Read:
    """An axis of a device as it is in the file: one that moves, or both jaws of a clamp."""

    moved: tuple[ExternalAxis, ...]
    clamp: Clamp | None = None


@frozen(eq=False)
class Around:
    """What axes are read with.

    Args:
        folder: of meshes; places: by name.
        far: m: from the frame of a part to its furthest point, of the largest kind; 0: there are no parts.
        T_world_base: where the device stands.
    """

    folder: Path
    places: Mapping[str, Pose]
    far: float
    T_world_base: Array = field(default_factory=lambda: np.eye(4))

    def seen_from(self, frame: Array, place: str) -> tuple[float, float, float]:
        """Where a place is in a frame of the device, m."""
        spot = inverse(self.T_world_base @ frame) @ matrix_of(self.places[place])
        x, y, z = spot[:3, 3].tolist()
        return x, y, z


def read_devices(t: Table, around: Around) -> tuple[CellRobot, ...]:
    """The devices of which something moves; what is wrong is reported."""
    out = []
    for name, data in t.data.items():
        if not isinstance(data, Mapping) or "axes" not in data:
            continue  # what is no table is reported where its page is read
        if not data["axes"]:
            t.d.error(
                codes.ROBOT_VALUE,
                f"device `{name}` has `axes`, but none is named",
                t.inside(name).at("axes"),
                hint=f"add a table `[devices.{name}.axes.NAME]`, or remove `axes`",
            )
            continue
        base = read_pose(t.only(name, DEVICE_PLACE), "base")
        axes = _axes(t.inside(name, "axes"), name, replace(around, T_world_base=matrix_of(base)))
        if axes:
            out.append(device_of(name, axes, base))
    return tuple(out)


def device_of(name: str, axes: Externals, base: Pose = NO_POSE) -> CellRobot:
    """A device with these axes."""
    tree = urdf.tree_of(Path(name), _tree(name, axes))
    arm = Arm(
        name,
        tree,
        STAND,
        (),
        np.array([a.lower for a in axes.tables]),
        np.array([a.upper if a.belt is None else _ENDLESS for a in axes.tables]),
        np.array([a.velocity for a in axes.tables]),
        tuple(a.name for a in axes.tables),
    )
    home = tuple(a.home for a in axes.tables)
    return CellRobot(name, arm, None, DeviceKinematics(arm, axes), base, home, None, axes)


def _axes(t: Table, device: str, around: Around) -> Externals:
    found = [
        read
        for name, table in t.named(DEVICE_AXIS)
        if (read := _axis(table, name, around)) is not None
    ]
    tables = tuple(a for read in found for a in read.moved)
    names = [a.name for a in tables]
    for name in (STAND, *names):
        if names.count(name) + (name == STAND) > 1:
            t.d.error(
                codes.ROBOT_VALUE,
                f"two parts of device `{device}` are called `{name}`",
                t.at(),
                hint=f"choose other names; `{STAND}` is what does not move, and the jaws of a clamp have its name with "
                "`_1` and `_2`",
            )
            return Externals()
    tables = expect_lines(t, tables)
    return Externals((), tables, tuple(read.clamp for read in found if read.clamp is not None))


def _axis(t: Table, name: str, around: Around) -> _Read | None:
    before = len(t.d.errors)
    kind = t.text("kind")
    if kind != t.data.get("kind", kind):
        return None  # what else there may be is not known
    if kind == "belt":
        return _belt(t, name, around)
    slides = kind != "swing"
    numbers = {k: t.number(k) for k in ("from", "to", "home", *_PACE)}
    for key in ("from", "to"):
        t.has(key)
    frame = matrix_of(read_pose(t, "pose"))
    direction = np.array([0.0, 0.0, 1.0])
    objects: tuple[SceneObject, ...] = ()
    holds, may_be_empty = "", False
    if kind == "clamp":
        objects = (_jaw(t),)
        holds, may_be_empty = _place(t, "holds", around.places), t.flag("may_be_empty")
    else:
        t.has("objects")
        objects = read_solids(t.tables("objects"), around.folder)
    if kind == "slide":
        direction = np.array(t.numbers("direction"))
        if not np.linalg.norm(direction) > 1e-9:
            t.wrong("direction", t.expected("direction"))
            return None
        direction = direction / np.linalg.norm(direction)
    t.done()
    if len(t.d.errors) == before:
        _expect_order(t, name, kind, numbers)
        if holds and len(t.d.errors) == before:
            _expect_between(
                t, name, numbers["to"], holds, (around.seen_from(frame, holds), around.far)
            )
    if len(t.d.errors) != before:
        return None
    factor = 1.0 if slides else math.radians(1.0)
    lower, upper, home, *pace = (factor * numbers[k] for k in ("from", "to", "home", *_PACE))
    speed, acceleration, jerk = pace
    own = ExternalAxis(
        name, slides, frame, direction, lower, upper, speed, acceleration, jerk, home,
        objects=objects,
    )  # fmt: skip
    return _Read((own,)) if kind != "clamp" else _clamped(own, holds, may_be_empty)


def _place(t: Table, key: str, places: Mapping[str, Pose]) -> str:
    """The name of a place that is there; "": none is named."""
    name = t.text(key)
    if name and name not in places:
        near = did_you_mean(name, tuple(places)) or f"add a table `[places.{name}]`"
        t.wrong_name(key, name, "place of `[places]`", near)
    return name


def _belt(t: Table, name: str, around: Around) -> _Read | None:
    before = len(t.d.errors)
    length, width, height = (t.number(k) for k in ("length", "width", "height"))
    for key in ("length", "width"):
        t.has(key)
    speed, acceleration, jerk = (t.number(k) for k in _PACE)
    pose = read_pose(t, "pose")
    frame = matrix_of(pose)
    stop = _place(t, "stop", around.places)
    drives = t.texts("drives")
    colour = read_colour(t)
    t.done()
    if abs(float((around.T_world_base @ frame)[2, 2]) - 1.0) > 1e-9:
        t.d.error(
            codes.ROBOT_VALUE,
            f"belt `{name}` is not level, so that what stands on it would slide",
            t.at("pose"),
            hint="leave `roll` and `pitch` of its `pose`, and of the `base` of its device, out",
        )
    if len(t.d.errors) == before and stop:
        along, beside, above = around.seen_from(frame, stop)
        if not -_SAME <= along <= length + _SAME:
            t.d.error(
                codes.ROBOT_VALUE,
                f"belt `{name}` is {length:g} m long, but its stop `{stop}` is at {along:g} m: "
                "no part on it comes there",
                t.at("stop"),
                hint=f"it runs from its `pose` along the x of that; correct this or `[places.{stop}]`",
            )
        elif abs(beside) > width / 2.0 + _SAME or above < -_SAME:
            is_beside = above >= -_SAME
            where = (
                f"{abs(beside):g} m beside its middle"
                if is_beside
                else f"{-above:g} m below its top"
            )
            t.d.error(
                codes.ROBOT_VALUE,
                f"the stop of belt `{name}`, `{stop}`, is {where}: no part on it comes there",
                t.at("stop"),
                hint=f"it is {width:g} m wide, and parts are on top of it; correct its `pose` or `[places.{stop}]`",
            )
    if len(t.d.errors) != before:
        return None
    middle = pose_of(frame @ matrix_of(Pose(length / 2.0, 0.0, -height / 2.0, 0.0, 0.0, 0.0)))
    body = SceneObject(name, "box", middle, colour, size=(length, width, height))
    return _Read(
        (
            ExternalAxis(
                name, True, frame, np.array([1.0, 0.0, 0.0]), 0.0, length, speed, acceleration,
                jerk, 0.0, height=height, objects=(body,), belt=Belt(width, stop, drives, length),
            ),
        )
    )  # fmt: skip


def _expect_between(
    t: Table, name: str, widest: float, called: str, at: tuple[tuple[float, float, float], float]
) -> None:
    """What a clamp holds must be between its jaws; `at`: where it is seen from the clamp, and how far parts reach."""
    spot, far = at
    along = abs(spot[0])
    if along > widest / 2.0 + _SAME:
        t.d.error(
            codes.ROBOT_VALUE,
            f"clamp `{name}` opens to {widest:g} m, but what it holds, at `{called}`, is {along:g} m beside the "
            "middle between its jaws",
            t.at("holds"),
            hint=f"the jaws close along the x of its `pose`; correct it or `[places.{called}]`",
        )
        return
    for axis, off, size in zip("yz", spot[1:], t.numbers("jaw")[1:], strict=True):
        if far and abs(off) > size / 2.0 + far + _SAME:
            t.d.error(
                codes.ROBOT_VALUE,
                f"the jaws of clamp `{name}` reach {size / 2.0:g} m along the {axis} of its `pose`, but what it holds, "
                f"at `{called}`, is {abs(off):g} m away: they touch no part there",
                t.at("holds"),
                hint=f"correct its `pose` or `[places.{called}]`",
            )
            return


def _expect_order(t: Table, name: str, kind: str, numbers: Mapping[str, float]) -> None:
    unit = "degrees" if kind == "swing" else "m"
    if not numbers["from"] < numbers["to"]:
        t.wrong("to", "a number above `from`")
    elif kind == "clamp" and numbers["from"] < 0.0:
        t.wrong("from", "a gap from 0")
    elif not numbers["from"] <= numbers["home"] <= numbers["to"]:
        t.d.error(
            codes.ROBOT_VALUE,
            f"`{name}` begins at {numbers['home']:g} {unit}, outside {numbers['from']:g} .. {numbers['to']:g}",
            t.at("home") if "home" in t.data else t.at(),
            hint="`home` is where it is when a run begins; without the key that is 0",
        )


def _jaw(t: Table) -> SceneObject:
    """One of both jaws, with the face that holds in the plane x = 0 of its frame."""
    x, y, z = t.numbers("jaw")
    pose = Pose(x / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    return SceneObject("jaw", "box", pose, read_colour(t), size=(x, y, z))


def _clamped(gap: ExternalAxis, place: str, may_be_empty: bool) -> _Read:
    """Both jaws: each of them goes half of the gap, in half of the speed."""
    jaws = []
    for number, turn in ((1, 0.0), (2, math.pi)):
        frame = gap.T_base_axis @ matrix_of(Pose(0.0, 0.0, 0.0, 0.0, 0.0, turn))
        halves = (gap.lower, gap.upper, gap.velocity, gap.acceleration, gap.jerk, gap.home)
        lower, upper, velocity, acceleration, jerk, home = (v / 2.0 for v in halves)
        jaws.append(
            ExternalAxis(
                f"{gap.name}_{number}", True, frame, np.array([1.0, 0.0, 0.0]), lower, upper,
                velocity, acceleration, jerk, home, objects=gap.objects,
            )
        )  # fmt: skip
    one, other = jaws
    clamp = Clamp(replace(gap, objects=()), (one.name, other.name), place, may_be_empty)
    return _Read((one, other), clamp)


def _tree(device: str, axes: Externals) -> etree._Element:
    out = etree.Element("robot", name=device)
    etree.SubElement(out, "link", name=STAND)
    for axis in axes.tables:
        link = etree.SubElement(out, "link", name=axis.name)
        # The body of a belt stands, whatever the belt does: it is a thing of the scene.
        for number, thing in enumerate(axis.objects if axis.belt is None else ()):
            add_shape(link, thing, f"{axis.name}_{number}")
        kind = "prismatic" if axis.is_track else "revolute"
        joint = add_joint(out, axis.name, kind, STAND, axis.name, pose_of(axis.T_base_axis))
        etree.SubElement(joint, "axis", xyz=axis_words(axis.direction))
        add_limit(joint, axis.lower, axis.upper, axis.velocity)
    return out


def touched(devices: tuple[CellRobot, ...]) -> Iterator[tuple[str, str]]:
    """Both jaws of each clamp, as contact rules name them."""
    for device in devices:
        for clamp in device.axes.clamps:
            one, other = clamp.jaws
            yield f"{device.name}/{one}", f"{device.name}/{other}"
