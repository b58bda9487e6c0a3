"""The cell as the robots see it, in SI units: arms, tools, bases, motion limits, scene objects, devices that move."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import Literal

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.robot import payload
from pn2code.robot.carried import STAND
from pn2code.robot.commands import Pose
from pn2code.robot.external import ExternalAxis, Externals
from pn2code.robot.kinematics import Branch, Kinematics
from pn2code.robot.model import Arm, Tool
from pn2code.robot.parts_table import PartKind
from pn2code.robot.payload import Load
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.time_law import MotionLimits
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, matrix_of
from pn2code.robot.zones_table import Zone

PART_CONTACT = 1e-3
"""m: parts are taken from what they rest on, and tools touch them: so deep they may overlap."""


@frozen
class MotionConfig:
    """`[motion]` in SI units.

    Args:
        joint_speed: fraction (0..1] of the axis speeds.
        joint_acceleration: rad/s2; joint_jerk rad/s3.
        slide_acceleration: of axes of an arm that slide, m/s2; slide_jerk m/s3.
        linear_speed: m/s; linear_acceleration m/s2; linear_jerk m/s3.
        angular_speed: of the tool's turning on linear moves, rad/s.
        measure_duration: how long a measurement takes, s.
        sample: spacing of the samples that are checked, s.
    """

    joint_speed: float = 0.5
    joint_acceleration: float = math.radians(200.0)
    joint_jerk: float = math.radians(1000.0)
    slide_acceleration: float = 2.0
    slide_jerk: float = 20.0
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


@frozen
class ContactRule:
    """Parts that may come together: names `body/link` with `*`, and how deep they may overlap (m).

    Args:
        led: it is permitted only with what a move leads to or comes from (`led_contacts`), because `a` is of a tool
            that grips parts of the kind `b`, of what couples the tool `b`, a tool that `b` holds in its rack, or a part
            that is carried; "": with all that have such names.
    """

    a: str
    b: str
    depth: float
    led: Literal["", "tool", "part"] = ""


@frozen(eq=False)
class CellRobot:
    """One robot of the cell.

    Args:
        base: of its base frame in the world.
        home: joint position, rad (m of what slides).
        branch: the only one joint moves may end in; None: the fastest to reach.
        axes: its external ones; `home` has all.
        tcps: kinematics to further tool frames, by name.
        carries: kinds of parts that it may take, by name; pace: what its heaviest load leaves of the speeds and the
            accelerations of its axes; paces: the same with each of its tools.
        tools: those that it couples, at the TCP of `tool`; in `tcps` is the TCP of each.
        begins_with: which of them it has at the start, "": none.
        turning: frames that turn with a turntable of it, by name: the axis, by its index, and the pose on its plate.
    """

    name: str
    arm: Arm
    tool: Tool | None
    kinematics: Kinematics
    base: Pose
    home: tuple[float, ...]
    branch: Branch | None
    axes: Externals = field(default_factory=Externals)
    turning: Mapping[str, tuple[int, Pose]] = field(default_factory=dict)
    tcps: Mapping[str, Kinematics] = field(default_factory=dict)
    carries: tuple[str, ...] = ()
    pace: tuple[float, float] = (1.0, 1.0)
    tools: Mapping[str, ToolKind] = field(default_factory=dict)
    begins_with: str = ""
    paces: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def loads(self, kinds: Mapping[str, PartKind], taken: Collection[str]) -> Iterator[Load]:
        """What hangs on its flange: the tool, alone and with parts of these kinds; with each tool that it may have."""
        for tool in ("", *self.tools):
            yield from self.loads_with(tool, kinds, taken)

    def loads_with(
        self, tool: str, kinds: Mapping[str, PartKind], taken: Collection[str]
    ) -> Iterator[Load]:
        """The same with one of its tools in use; "": with none."""
        if tool:
            frame = self.tcps[tool].T_flange_tcp
            kinds_of = self.tools[tool].takes
        else:
            frame = self.kinematics.T_flange_tcp
            kinds_of = () if self.tools else tuple(kinds)  # a coupling grips nothing
        own = (kinds[k] for k in taken if k in kinds and k in kinds_of)
        yield from payload.loads(self._hangs(tool), frame, own)

    def of_tool(self, tool: str, frame: Array) -> Array:
        """Where the TCP of one of its tools is when its own, the coupling, is at `frame`; "": no tool is in use."""
        return np.asarray(frame @ self.tools[tool].tool.T_flange_tcp) if tool else frame

    def _hangs(self, tool: str) -> tuple[str, float, Array] | None:
        """Name, mass and centre of the tool, with what couples it."""
        if tool:
            return self.tools[tool].with_coupling(self.tool)
        if self.tool is None:
            return None
        return self.tool.name, self.tool.urdf.mass, self.tool.urdf.centre

    def overload(self, kinds: Mapping[str, PartKind], taken: Collection[str]) -> str:
        """Why it may not carry what it takes, in words that name tool and part; "": it may, or nothing is said."""
        rating = self.arm.urdf.rating
        if rating is None:
            return ""
        centre = self.kinematics.alone.wrist_in_flange
        for load in self.loads(kinds, taken):
            if why := rating.exceeded(load, centre):
                return f"robot `{self.name}` (`{self.arm.name}`) carries {load.words}, {why}"
        return ""

    def overload_of(self, parts: Iterable[tuple[str, float, Array]], tool: str = "") -> str:
        """Why it may not carry these together (name, kg, where in the frame of the TCP), in words; "": it may.

        `tool`: which of its tools is in use, "" if none is; the TCP is that of `tool` of the robot in any case.
        """
        rating = self.arm.urdf.rating
        if rating is None:
            return ""
        frame = self.kinematics.T_flange_tcp
        load = payload.together(
            self._hangs(tool), ((n, m, (frame @ T)[:3, 3]) for n, m, T in parts)
        )
        if why := rating.exceeded(load, self.kinematics.alone.wrist_in_flange):
            return f"it carries {load.words}, {why}"
        if any(
            f < p - 1e-9
            for f, p in zip(rating.factors(load.mass), self.paces.get(tool, self.pace), strict=True)
        ):
            return f"it carries {load.words}, {load.mass:g} kg, for which its speeds are too high"
        return ""

    @property
    def carrying(self) -> tuple[ExternalAxis, ...]:
        """The axes with which parts go that stand on them: turntables of a robot, those of a device but for jaws."""
        jaws = {name for clamp in self.axes.clamps for name in clamp.jaws}
        return tuple(a for a in self.axes.tables if a.name not in jaws)

    @property
    def belts(self) -> tuple[ExternalAxis, ...]:
        """Those that are belts."""
        return tuple(a for a in self.axes.tables if a.belt is not None)

    def plate(self, plate: str) -> ExternalAxis:
        """That of a name as parts have it (`Part.plate`): "left/plate"."""
        return next(a for a in self.carrying if plate == f"{self.name}/{a.name}")

    def T_world_plate(self, axis: ExternalAxis, q: Sequence[float] | Array) -> Array:  # noqa: N802
        """Where one of these is, with what goes with it."""
        return np.asarray(self.T_world_base @ axis.at(q[self.index(axis.name)]))

    def is_at(self, axis: str, q: Sequence[float] | Array, position: float) -> bool:
        """Whether an axis is at a position (m, degrees), to 1 mm or 0.1 degrees; of a clamp that is its gap."""
        own = self.axes.axis(axis)
        assert own is not None, "the cell has been checked"
        moved = [name for name, _ in self.axes.moved(axis, position)]
        now = sum(float(q[self.index(name)]) for name in moved)
        off = abs(now - position) if own.is_track else abs(math.degrees(now) - position)
        return off <= (0.001 if own.is_track else 0.1)

    @property
    def is_device(self) -> bool:
        """Whether it is a device, which has external axes and no arm."""
        joints = self.kinematics.joints
        return joints.start == joints.stop

    @property
    def words(self) -> str:
        """What it is, for messages."""
        return f"{'device' if self.is_device else 'robot'} `{self.name}`"

    @property
    def root(self) -> str:
        """The base link of its arm: what stands on the floor, or on a track."""
        tree = self.arm.urdf
        mount = next((j for j in tree.joints if j.name == f"{STAND}_mount"), None)
        return mount.child if self.axes and mount is not None else tree.root

    @property
    def T_world_base(self) -> Array:  # noqa: N802
        """The base frame."""
        return matrix_of(self.base)

    def index(self, axis: str) -> int:
        """Where an external axis is in joint positions; KeyError if there is none so called."""
        joints = self.kinematics.joints
        return self.axes.index(axis, joints.stop - joints.start)

    def limits(self, motion: MotionConfig, tool: str = "") -> MotionLimits:
        """What this arm may do under a motion configuration, with one of its tools in use."""
        ones = np.ones(len(self.arm.velocity))
        fast, ramp = self.paces.get(tool, self.pace)
        most = self.arm.velocity * fast
        velocity = most * motion.joint_speed
        acceleration, jerk = ones * motion.joint_acceleration, ones * motion.joint_jerk
        sliding = self.kinematics.joints.start + np.flatnonzero(self.kinematics.alone.slides)
        acceleration[sliding], jerk[sliding] = motion.slide_acceleration, motion.slide_jerk
        acceleration *= ramp
        for axis in self.axes:
            i = self.index(axis.name)
            velocity[i], acceleration[i], jerk[i] = axis.velocity, axis.acceleration, axis.jerk
            most[i] = axis.velocity
        return MotionLimits(
            velocity=velocity,
            acceleration=acceleration,
            jerk=jerk,
            axis_velocity=most,
            linear_velocity=motion.linear_speed,
            linear_acceleration=motion.linear_acceleration * ramp,
            linear_jerk=motion.linear_jerk,
            angular_velocity=motion.angular_speed,
        )


@frozen(eq=False)
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


@frozen(eq=False)
class RobotCell:
    """Robots, motion limits, scene and parts: what backends, monitor and executors are built from.

    Args:
        devices: those of which something moves, in the form of robots without joints.
        parts: the kinds of parts that are carried, by name.
        places: poses in the world that have a name.
        frames: in which moves can be given, by name; each in the world.
        zones: boxes in the room, by name.
        tools: those that robots couple, by name.
    """

    robots: tuple[CellRobot, ...]
    motion: MotionConfig
    scene: SceneConfig
    parts: Mapping[str, PartKind] = field(default_factory=dict)
    places: Mapping[str, Pose] = field(default_factory=dict)
    frames: Mapping[str, Pose] = field(default_factory=dict)
    devices: tuple[CellRobot, ...] = ()
    zones: Mapping[str, Zone] = field(default_factory=dict)
    tools: Mapping[str, ToolKind] = field(default_factory=dict)

    @property
    def kinds(self) -> tuple[PartKind | ToolKind, ...]:
        """All that may lie somewhere or be carried: the kinds of parts, and the tools."""
        return (*self.parts.values(), *self.tools.values())

    @property
    def moving(self) -> tuple[CellRobot, ...]:
        """All that moves: the robots, then the devices."""
        return (*self.robots, *self.devices)

    def robot(self, name: str) -> CellRobot:
        """The robot of that name, or the device that moves; KeyError if there is none."""
        for robot in self.moving:
            if robot.name == name:
                return robot
        raise KeyError(name)
