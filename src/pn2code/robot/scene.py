"""The cell as the robots see it: arms, tools, bases, motion limits, scene objects.

    cell = load({"robots": ..., "motion": ..., "scene": ...}, folder, at, d)

`load` takes the raw sections of cell.toml (lengths in m, angles in degrees), reports every mistake
with its line, and gives a `RobotCell` in SI units. A panel with ribs is one kind of scene object
beside boxes, cylinders and meshes; nothing here knows what the cell is for.
"""

from __future__ import annotations

import fnmatch
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.keys import in_words
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.commands import Pose
from pn2code.robot.kinematics import BRANCH_NAMES, Branch, Kinematics
from pn2code.robot.model import AXES, Arm, Tool, find_arm, find_tool
from pn2code.robot.motion import MotionLimits
from pn2code.robot.transforms import Array, matrix_of

Locate = Callable[..., Origin]
"""Origin of a key, given its path: `Locator.origin` of `pn2code.cell.toml_file`."""


@frozen
class MotionConfig:
    """`[motion]` in SI units.

    Args:
        joint_speed: fraction (0..1] of the axis speeds.
        joint_acceleration: rad/s2; joint_jerk rad/s3.
        linear_speed: m/s; linear_acceleration m/s2; linear_jerk m/s3.
        angular_speed: of the tool's turning on linear moves, rad/s.
        measure_duration: how long a measurement takes, s.
        sample: spacing of the samples that are checked, s.
    """

    joint_speed: float = 0.5
    joint_acceleration: float = math.radians(200.0)
    joint_jerk: float = math.radians(1000.0)
    linear_speed: float = 0.05
    linear_acceleration: float = 0.5
    linear_jerk: float = 5.0
    angular_speed: float = math.radians(30.0)
    measure_duration: float = 1.0
    sample: float = 0.02


@frozen
class PanelConfig:
    """A piece of a cylindrical shell along x, with ribs and stringers inside; m and rad.

    Args:
        radius: of the middle of the skin, about the line (y, z) = (axis_y, axis_z).
        facing: direction of arc angle 0, from +y towards +z.
        arc_from: the skin's edges, arc angles about +x; arc_to likewise.
        ribs: x of the ribs; rib_height: how far they stand inwards.
        stringer_pitch: arc angle between stringers (0: none); none lies at arc angle 0.
        stands: whether it rests on stands.
        joint: whether two skins meet at arc angle 0 (drawn as a line).
    """

    radius: float
    axis_y: float
    axis_z: float
    x_from: float
    x_to: float
    arc_from: float
    arc_to: float
    facing: float = 0.0
    skin: float = 0.003
    ribs: tuple[float, ...] = ()
    rib_height: float = 0.07
    rib_thickness: float = 0.006
    stringer_pitch: float = 0.0
    stringer_height: float = 0.025
    stands: bool = True
    joint: bool = False


Colour = tuple[float, float, float, float]


@frozen
class SceneObject:
    """A further thing in the cell: a box, a cylinder along its z, or a mesh.

    Args:
        size: of a box: full lengths.
        radius: of a cylinder; length likewise.
        mesh: path of an OBJ or STL file; collisions are checked against its convex hull.
        scale: of a mesh.
    """

    name: str
    kind: Literal["box", "cylinder", "mesh"]
    pose: Pose
    colour: Colour = (0.6, 0.6, 0.62, 1.0)
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    length: float = 0.0
    mesh: Path | None = None
    scale: float = 1.0


@frozen
class ContactRule:
    """Parts that may come together: names `body/link` with `*`, and how deep they may overlap (m)."""

    a: str
    b: str
    depth: float


@dataclass(frozen=True, slots=True, eq=False)
class CellRobot:
    """One robot of the cell.

    Args:
        base: of its base frame in the world.
        home: joint position, rad.
        branch: the only one joint moves may end in; None: the fastest to reach.
    """

    name: str
    arm: Arm
    tool: Tool | None
    kinematics: Kinematics
    base: Pose
    home: tuple[float, ...]
    branch: Branch | None

    @property
    def T_world_base(self) -> Array:  # noqa: N802
        """The base frame."""
        return matrix_of(self.base)

    def limits(self, motion: MotionConfig) -> MotionLimits:
        """What this arm may do under a motion configuration."""
        ones = np.ones(AXES)
        return MotionLimits(
            velocity=self.arm.velocity * motion.joint_speed,
            acceleration=ones * motion.joint_acceleration,
            jerk=ones * motion.joint_jerk,
            axis_velocity=self.arm.velocity,
            linear_velocity=motion.linear_speed,
            linear_acceleration=motion.linear_acceleration,
            linear_jerk=motion.linear_jerk,
            angular_velocity=motion.angular_speed,
        )


@dataclass(frozen=True, slots=True, eq=False)
class SceneConfig:
    """Everything around the robots.

    Args:
        contacts: parts that may come together; all others must keep apart.
        warning_clearance: closer than this (m) is reported, though not a collision.
    """

    panel: PanelConfig | None = None
    objects: tuple[SceneObject, ...] = ()
    floor: bool = True
    contacts: tuple[ContactRule, ...] = ()
    warning_clearance: float = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class RobotCell:
    """Robots, motion limits and scene: what backends, monitor and executors are built from."""

    robots: tuple[CellRobot, ...]
    motion: MotionConfig
    scene: SceneConfig

    def robot(self, name: str) -> CellRobot:
        """The robot of that name; KeyError if there is none."""
        for robot in self.robots:
            if robot.name == name:
                return robot
        raise KeyError(name)


def load(
    geometry: Mapping[str, Any],
    folder: Path,
    at: Locate,
    d: Diagnostics,
    *,
    partial: bool = False,
) -> RobotCell | None:
    """The robot cell of the raw sections `robots`, `motion`, `scene`; None if there are mistakes.

    Args:
        folder: where relative paths of models and meshes start.
        at: gives the origin of a key path, for messages.
        partial: robots of which nothing is said are left out; without, it is an error.
    """
    before = len(d.errors)
    motion = _motion(_Table(geometry.get("motion", {}), ("motion",), at, d, geometry))
    robots = tuple(
        robot
        for name, table in geometry.get("robots", {}).items()
        if (table or not partial)
        and (robot := _robot(_Table(table, ("robots", name), at, d, geometry), name, folder))
        is not None
    )
    names = tuple(geometry.get("robots", {}))
    scene = _scene(
        _Table(geometry.get("scene", {}), ("scene",), at, d, geometry), robots, names, folder
    )
    return RobotCell(robots, motion, scene) if len(d.errors) == before else None


class _Table:
    """Typed access to one table, reporting what is wrong; unknown keys by `done`."""

    def __init__(
        self, data: Any, path: tuple[str | int, ...], at: Locate, d: Diagnostics, whole: object
    ) -> None:
        self.path, self._at, self.d, self._whole = path, at, d, whole
        self._used: list[str] = []
        self.data: Mapping[str, Any] = data if isinstance(data, Mapping) else {}
        if not isinstance(data, Mapping):
            d.error(codes.ROBOT_VALUE, f"{self._words()} must be a table", at(*path))

    def at(self, key: str = "") -> Origin:
        return self._at(*self.path, key) if key else self._at(*self.path)

    def _words(self, *key: str) -> str:
        return in_words((*self.path, *key), self._whole)

    def wrong(self, key: str, expected: str, hint: str = "") -> None:
        self.d.error(
            codes.ROBOT_VALUE,
            f"{self._words(key)} is `{self.data[key]}`, but {expected} is expected",
            self.at(key),
            hint=hint,
        )

    def has(self, key: str, required: bool, expected: str) -> bool:
        self._used.append(key)
        if key not in self.data and required:
            self.d.error(
                codes.ROBOT_KEY,
                f"{self._words(key)} is missing",
                self.at(),
                hint=f"add `{key} = ...`: {expected}",
            )
        return key in self.data

    def number(
        self,
        key: str,
        default: float | None = None,
        *,
        low: float = -math.inf,
        high: float = math.inf,
        open_low: bool = False,
    ) -> float:
        bounds = f" {'above' if open_low else 'from'} {low:g}" if low > -math.inf else ""
        bounds += f" to {high:g}" if high < math.inf else ""
        expected = f"a number{bounds}"
        fallback = 1.0 if default is None else default
        if not self.has(key, default is None, expected):
            return fallback
        value = self.data[key]
        if not _is_number(value) or not (low < value if open_low else low <= value) or value > high:
            self.wrong(key, expected)
            return fallback
        return float(value)

    def positive(self, key: str, default: float | None = None, *, high: float = math.inf) -> float:
        return self.number(key, default, low=0.0, high=high, open_low=True)

    def numbers(self, key: str, count: int | None, default: tuple[float, ...]) -> tuple[float, ...]:
        expected = "a list of numbers" if count is None else f"a list of {count} numbers"
        if not self.has(key, False, expected):
            return default
        value = self.data[key]
        if (
            not isinstance(value, list)
            or not all(map(_is_number, value))
            or len(value) != (len(value) if count is None else count)
        ):
            self.wrong(key, expected)
            return default
        return tuple(map(float, value))

    def text(self, key: str, default: str | None = None, expected: str = "a name") -> str:
        if not self.has(key, default is None, expected):
            return default or ""
        value = self.data[key]
        if not isinstance(value, str) or not value:
            self.wrong(key, expected)
            return default or ""
        return value

    def flag(self, key: str, default: bool) -> bool:
        if not self.has(key, False, "true or false"):
            return default
        if not isinstance(self.data[key], bool):
            self.wrong(key, "`true` or `false`")
            return default
        return bool(self.data[key])

    def table(self, key: str) -> _Table:
        self._used.append(key)
        return _Table(self.data[key], (*self.path, key), self._at, self.d, self._whole)

    def tables(self, key: str) -> list[_Table]:
        self._used.append(key)
        value = self.data.get(key, [])
        if not isinstance(value, list):
            self.wrong(key, "a list of tables")
            return []
        return [
            _Table(v, (*self.path, key, i), self._at, self.d, self._whole)
            for i, v in enumerate(value)
        ]

    def done(self) -> None:
        for key in self.data:
            if key not in self._used:
                self.d.error(
                    codes.ROBOT_KEY,
                    f"unknown key `{key}` in {self._words()}",
                    self.at(key),
                    hint=did_you_mean(
                        key, self._used, f"known keys: {', '.join(sorted(set(self._used)))}"
                    ),
                )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _motion(t: _Table) -> MotionConfig:
    out = MotionConfig(
        joint_speed=t.positive("joint_speed", 0.5, high=1.0),
        joint_acceleration=math.radians(t.positive("joint_acceleration_deg_s2", 200.0)),
        joint_jerk=math.radians(t.positive("joint_jerk_deg_s3", 1000.0)),
        linear_speed=t.positive("linear_speed", 0.05),
        linear_acceleration=t.positive("linear_acceleration", 0.5),
        linear_jerk=t.positive("linear_jerk", 5.0),
        angular_speed=math.radians(t.positive("angular_speed_deg_s", 30.0)),
        measure_duration=t.number("measure_s", 1.0, low=0.0),
        sample=t.positive("sample_s", 0.02, high=1.0),
    )
    t.done()
    return out


def _pose(t: _Table, key: str, *, required: bool = False) -> Pose:
    if not t.has(key, required, "a table { x, y, z, roll, pitch, yaw }: m, degrees"):
        return Pose(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    p = t.table(key)
    x, y, z = (p.number(k, 0.0) for k in ("x", "y", "z"))
    rx, ry, rz = (math.radians(p.number(k, 0.0)) for k in ("roll", "pitch", "yaw"))
    p.done()
    return Pose(x, y, z, rx, ry, rz)


def _robot(t: _Table, name: str, folder: Path) -> CellRobot | None:
    t.has("instance", False, "")  # the pages of the net are not our business
    model = t.text("model", None, "the name of a robot model, or a .urdf file")
    arm = find_arm(model, folder, t.at("model"), t.d) if model else None
    tool_name = t.text("tool", "none", "the name of an end effector, or a .urdf file")
    tool = None if tool_name == "none" else find_tool(tool_name, folder, t.at("tool"), t.d)
    base = _pose(t, "base", required=True)
    home_deg = t.numbers("home", AXES, (0.0, -90.0, 90.0, 0.0, 0.0, 0.0))
    branch_name = t.text("branch", "any")
    if branch_name != "any" and branch_name not in BRANCH_NAMES:
        t.wrong("branch", f"one of {', '.join(BRANCH_NAMES)}")
    t.done()
    if arm is None or (tool is None and tool_name != "none"):
        return None
    home = tuple(math.radians(v) for v in home_deg)
    for i, value in enumerate(home):
        low, high = arm.lower[i], arm.upper[i]
        if not low - 1e-9 <= value <= high + 1e-9:
            t.d.error(
                codes.ROBOT_VALUE,
                f"HOME of `{name}` puts axis {i + 1} at {home_deg[i]:g} degrees, outside "
                f"{math.degrees(low):g} .. {math.degrees(high):g}",
                t.at("home"),
            )
    kinematics = Kinematics.of(arm, tool, t.at("model"), t.d)
    if kinematics is None:
        return None
    return CellRobot(name, arm, tool, kinematics, base, home, BRANCH_NAMES.get(branch_name))


def _scene(
    t: _Table, robots: tuple[CellRobot, ...], names: tuple[str, ...], folder: Path
) -> SceneConfig:
    panel = _panel(t.table("panel")) if t.has("panel", False, "") else None
    depth = t.number("tool_contact_depth", 0.0, low=0.0)
    contacts = _default_contacts(robots, depth) if depth > 0.0 else []
    objects = tuple(o for e in t.tables("objects") if (o := _object(e, folder)) is not None)
    _named_once(t, objects)
    things = [*names, "panel", "floor", *(o.name for o in objects)]
    for c in t.tables("contacts"):
        contacts.append(_contact(c, things))
    out = SceneConfig(
        panel=panel,
        objects=objects,
        floor=t.flag("floor", True),
        contacts=tuple(contacts),
        warning_clearance=t.number("warning_clearance", 0.02, low=0.0),
    )
    t.done()
    return out


def _contact(t: _Table, things: list[str]) -> ContactRule:
    """A rule for parts of things that are there."""
    rule = ContactRule(t.text("a"), t.text("b"), t.number("depth", 0.0, low=0.0))
    t.done()
    for key, name in (("a", rule.a), ("b", rule.b)):
        thing = name.split("/")[0]
        if name and not any(fnmatch.fnmatchcase(x, thing) for x in things):
            near = did_you_mean(thing, things, f"known are {', '.join(f'`{x}`' for x in things)}")
            t.wrong(key, "a part of a robot or of the scene", near)
    return rule


def _default_contacts(robots: tuple[CellRobot, ...], depth: float) -> list[ContactRule]:
    """The tools' contact links may touch the skin of the panel, and each other."""
    tips = [
        f"{r.name}/tool_{link}"
        for r in robots
        if r.tool is not None
        for link in r.tool.contact_links
    ]
    touching = [ContactRule(tip, "panel/skin", depth) for tip in tips]
    meeting = [
        ContactRule(a, b, 1e-3)
        for i, a in enumerate(tips)
        for b in tips[i + 1 :]
        if a.split("/")[0] != b.split("/")[0]
    ]
    return touching + meeting


def _panel(t: _Table) -> PanelConfig:
    out = PanelConfig(
        radius=t.positive("radius"),
        axis_y=t.number("axis_y"),
        axis_z=t.number("axis_z"),
        x_from=t.number("x_from"),
        x_to=t.number("x_to"),
        arc_from=math.radians(t.number("arc_from", None, low=-180.0, high=180.0)),
        arc_to=math.radians(t.number("arc_to", None, low=-180.0, high=180.0)),
        facing=math.radians(t.number("facing", 0.0)),
        skin=t.positive("skin", 0.003),
        ribs=t.numbers("ribs", None, ()),
        rib_height=t.positive("rib_height", 0.07),
        rib_thickness=t.positive("rib_thickness", 0.006),
        stringer_pitch=math.radians(t.number("stringer_pitch", 0.0, low=0.0, high=90.0)),
        stringer_height=t.positive("stringer_height", 0.025),
        stands=t.flag("stands", True),
        joint=t.flag("joint", False),
    )
    t.done()
    for low, high in (("x_from", "x_to"), ("arc_from", "arc_to")):
        both = (t.data.get(low), t.data.get(high))
        if all(map(_is_number, both)) and not getattr(out, low) < getattr(out, high):
            t.wrong(high, f"a number above `{low}`")
    return out


def _colour(t: _Table) -> Colour:
    """Red, green, blue, and how opaque."""
    grey = (0.6, 0.6, 0.62)
    found = t.numbers("colour", None, grey)
    if len(found) not in (3, 4) or not all(0.0 <= v <= 1.0 for v in found):
        t.wrong("colour", "a list of three or four numbers from 0 to 1")
        found = grey
    r, g, b = found[:3]
    return (r, g, b, found[3] if len(found) == 4 else 1.0)


def _named_once(t: _Table, objects: tuple[SceneObject, ...]) -> None:
    """Reports names that two objects have: messages and contact rules name them."""
    seen: set[str] = set()
    for o in objects:
        if o.name in seen:
            t.d.error(
                codes.ROBOT_VALUE,
                f"two objects of the scene are called `{o.name}`",
                t.at("objects"),
                hint="give each a name of its own",
            )
        seen.add(o.name)


def _object(t: _Table, folder: Path) -> SceneObject | None:
    name = t.text("name")
    kind = t.text("kind", "box", "`box`, `cylinder` or `mesh`")
    pose = _pose(t, "pose")
    colour = _colour(t)
    out: SceneObject | None = None
    if kind == "box":
        t.has("size", True, "three numbers: full lengths, m")
        x, y, z = t.numbers("size", 3, (1.0, 1.0, 1.0))
        if min(x, y, z) <= 0.0:
            t.wrong("size", "three numbers above 0")
        out = SceneObject(name, "box", pose, colour, size=(x, y, z))
    elif kind == "cylinder":
        radius, length = t.positive("radius"), t.positive("length")
        out = SceneObject(name, "cylinder", pose, colour, radius=radius, length=length)
    elif kind == "mesh":
        file = folder / t.text("file", None, "an OBJ or STL file, relative to cell.toml")
        if "file" in t.data and not (file.is_file() and file.suffix.lower() in (".obj", ".stl")):
            t.wrong("file", "the path of an OBJ or STL file that exists")
        scale = t.positive("scale", 1.0)
        out = SceneObject(name, "mesh", pose, colour, mesh=file, scale=scale)
    else:
        t.wrong("kind", "`box`, `cylinder` or `mesh`")
        return None
    t.done()
    return out
