"""Reads the cell as the robots see it from cell.toml: arms, tools, bases, motion limits, scene objects.

    cell = load({"robots": ..., "motion": ..., "scene": ...}, folder, at, d)

`load` takes the raw sections of cell.toml (lengths in m, angles in degrees), reports every mistake
with its line, and gives a `RobotCell` in SI units. A panel with ribs is one kind of scene object
beside boxes, cylinders and meshes; nothing here knows what the cell is for.
"""

from __future__ import annotations

import fnmatch
import glob
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pn2code.cell_file.arms import MOTION, ROBOT
from pn2code.cell_file.keys import Section
from pn2code.cell_file.scene import SCENE
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.carried import WithAxes, with_axes
from pn2code.robot.collision_meshes import unread_meshes
from pn2code.robot.devices import Around, read_devices, touched
from pn2code.robot.external import read_axes
from pn2code.robot.frames import Frames, read_frames
from pn2code.robot.hulls import Hull
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import Arm, Tool, find_arm, find_tool
from pn2code.robot.parts_table import PartKind, read_kinds, read_places
from pn2code.robot.robot_cell import (
    PART_CONTACT,
    CellRobot,
    ContactRule,
    MotionConfig,
    PanelConfig,
    RobotCell,
    SceneConfig,
)
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.solid_objects import read_solids
from pn2code.robot.table import Locate, Table, is_number
from pn2code.robot.table_poses import read_own_pose, read_pose
from pn2code.robot.tool_contacts import also_of_tools, coupling
from pn2code.robot.tools_table import ToolKind, expect_somewhere, read_tools
from pn2code.robot.transforms import Array, matrix_of
from pn2code.robot.zones import unread
from pn2code.robot.zones_table import read_zones

RADIANS = "angles in cell.toml are in degrees; if these are radians, multiply them by 57.2958"
FEW_RADIANS = 3.2
"""No axis at HOME is further from 0: written in radians this is half a turn, in degrees next to nothing."""


def in_radians(angles: Sequence[float]) -> bool:
    """Whether the angles of HOME look as if they were written in radians."""
    return max(map(abs, angles)) < FEW_RADIANS and sum(abs(q) > 0.5 for q in angles) > 1


def load(
    geometry: Mapping[str, Any],
    folder: Path,
    at: Locate,
    d: Diagnostics,
    *,
    partial: bool = False,
) -> RobotCell | None:
    """The robot cell of the raw sections `robots`, `devices`, `motion`, `scene`; None if there are mistakes.

    Args:
        folder: where relative paths of models and meshes start.
        at: gives the origin of a key path, for messages.
        partial: robots of which nothing is said are left out; without, it is an error.
    """
    before = len(d.errors)

    def table(name: str, keys: Section | None) -> Table:
        return Table(geometry.get(name, {}), (name,), at, d, geometry, keys)

    motion = _motion(table("motion", MOTION))
    kinds = read_kinds(table("parts", None), folder)
    places = read_places(table("places", None))
    primitives = geometry.get("primitives", {})
    tools = read_tools(table("tools", None), folder, kinds, places)
    robots = tuple(
        robot
        for name, robot_table in table("robots", None).named(ROBOT)
        if (robot_table.data or not partial)
        and (robot := _robot(robot_table, name, folder, tools)) is not None
    )
    names = tuple(geometry.get("robots", {}))
    expect_somewhere(
        table("tools", None),
        tools,
        {r.name: r.begins_with for r in robots},
        _uncoupled(primitives),
    )
    plates = [f"{r.name}.{a.name}" for r in robots for a in r.axes.tables]
    frames = read_frames(table("frames", None), plates)
    named = dict(table("robots", None).named(ROBOT))
    taken = _said_of(primitives, "takes")
    robots = tuple(_loaded(_with_frames(r, frames), kinds, taken, named[r.name]) for r in robots)
    hulls = [hull for k in kinds.values() for hull in Hull.of(k.shape)]
    around = Around(folder, places, max((h.radius for h in hulls), default=0.0))
    devices = read_devices(table("devices", None), around)
    scene = _scene(table("scene", SCENE), robots, devices, names, (kinds, tools), folder)
    zones = read_zones(table("zones", None))
    _expect_own_names(table("tools", None), tools, robots)
    if len(d.errors) != before:
        return None
    cell = RobotCell(robots, motion, scene, kinds, places, frames.standing, devices, zones, tools)
    trees = [r.arm.urdf for r in robots]
    trees += [t.urdf for t in (*(r.tool for r in robots), *(k.tool for k in tools.values())) if t]
    for path, says in unread_meshes(trees):
        d.error(
            codes.ROBOT_URDF,
            says,
            Origin(str(path)),
            hint="let it be a box, a cylinder, a sphere, a capsule, or an OBJ or STL file",
        )
    for name in unread(cell) if zones else ():
        d.error(
            codes.ROBOT_VALUE,
            f"a shape of `{name}` cannot be read, so that nobody knows whether it is in a zone",
            table("zones", None).at(),
            hint="let it be a box, a cylinder, a sphere, a capsule, or an OBJ or STL file of a body that is "
            "not flat",
        )
    return cell if len(d.errors) == before else None


def _with_frames(robot: CellRobot, frames: Frames) -> CellRobot:
    """A robot with the frames that turn with its turntables."""
    turning = {
        name: (robot.index(axis), pose)
        for name, (owner, axis, pose) in frames.turning.items()
        if owner == robot.name
    }
    return replace(robot, turning=turning) if turning else robot


def _said_of(primitives: object, key: str) -> tuple[str, ...]:
    """What the primitives say of a key, in order: the kinds of parts that are taken."""
    tables = primitives.values() if isinstance(primitives, Mapping) else ()
    found = [t.get(key) for t in tables if isinstance(t, Mapping)]
    return tuple(dict.fromkeys(k for k in found if isinstance(k, str)))


def _uncoupled(primitives: object) -> dict[str, list[str]]:
    """By tool, the primitives that uncouple it."""
    out: dict[str, list[str]] = {}
    for name, t in primitives.items() if isinstance(primitives, Mapping) else ():
        if isinstance(t, Mapping) and isinstance(t.get("uncouples"), str):
            out.setdefault(t["uncouples"], []).append(name)
    return out


def _loaded(
    robot: CellRobot, kinds: Mapping[str, PartKind], taken: tuple[str, ...], t: Table
) -> CellRobot:
    """A robot with what it carries, which may slow it down."""
    carries = robot.carries if "carries" in t.data else taken
    for name in robot.carries:
        if name not in kinds:
            known = ", ".join(f"`{k}`" for k in kinds)
            otherwise = f"known kinds: {known}" if known else f"add `[parts.{name}]`"
            t.wrong_name(
                "carries", name, "kind of parts", did_you_mean(name, tuple(kinds), otherwise)
            )
    robot = replace(robot, carries=carries)
    rating = robot.arm.urdf.rating
    if rating is None or not rating.derating:
        return robot

    def pace(tool: str) -> tuple[float, float]:
        return rating.factors(max(load.mass for load in robot.loads_with(tool, kinds, carries)))

    return replace(robot, pace=pace(""), paces={name: pace(name) for name in robot.tools})


def _motion(t: Table) -> MotionConfig:
    out = MotionConfig(
        joint_speed=t.number("joint_speed"),
        joint_acceleration=math.radians(t.number("joint_acceleration_deg_s2")),
        joint_jerk=math.radians(t.number("joint_jerk_deg_s3")),
        slide_acceleration=t.number("slide_acceleration"),
        slide_jerk=t.number("slide_jerk"),
        linear_speed=t.number("linear_speed"),
        linear_acceleration=t.number("linear_acceleration"),
        linear_jerk=t.number("linear_jerk"),
        angular_speed=math.radians(t.number("angular_speed_deg_s")),
        measure_duration=t.number("measure_s"),
        sample=t.number("sample_s"),
    )
    t.done()
    return out


def _robot(t: Table, name: str, folder: Path, tools: Mapping[str, ToolKind]) -> CellRobot | None:
    model = t.text("model")
    arm = find_arm(model, folder, t.at("model"), t.d) if model else None
    tool_name = t.text("tool")
    tool = None if tool_name == "none" else find_tool(tool_name, folder, t.at("tool"), t.d)
    base = read_pose(t, "base")
    home_deg = t.numbers("home")
    branch_name = t.text("branch")
    arm_angle = t.number("arm_angle")
    carries = t.texts("carries")
    axes = read_axes(t, name, base, folder)
    frames = t.table("tcps").named(t.inner("tcps")) if t.has("tcps") else ()
    further = {key: matrix_of(read_own_pose(p)) for key, p in frames}
    changed = _changed(t, tools)
    begins_with = t.text("begins_with")
    if begins_with and begins_with not in t.texts("tools"):
        t.wrong("begins_with", "one of `tools` of the robot", did_you_mean(begins_with, changed))
    t.done()
    if arm is None or (tool is None and tool_name != "none"):
        return None
    home = _home(t, name, arm, home_deg)
    kinematics = Kinematics.of(arm, tool, t.at("model"), t.d)
    if kinematics is None or home is None:
        return None
    _expect_wrist(arm, kinematics, t.d)
    _expect_links_apart(arm, tool, t)
    branch = {str(b): b for b in kinematics.branches}.get(branch_name)
    if branch is None and branch_name != "any":
        own_names = ", ".join(f"`{b}`" for b in kinematics.branches)
        t.wrong("branch", f"a branch of `{model}` ({own_names}) or `any`")
    further |= {
        key: kinematics.T_flange_tcp @ kind.tool.T_flange_tcp for key, kind in changed.items()
    }
    tcps = {
        key: own
        for key, frame in further.items()
        if (own := Kinematics.to(arm, frame, t.at("model"), t.d)) is not None
    }
    if kinematics.arm_angle is not None:
        angle = math.radians(arm_angle)
        kinematics = kinematics.with_arm_angle(angle)
        tcps = {key: own.with_arm_angle(angle) for key, own in tcps.items()}
    elif "arm_angle" in t.data:
        t.d.error(
            codes.ROBOT_VALUE,
            f"robot `{name}` has an `arm_angle`, but its arm `{model}` has {len(arm.lower)} axes",
            t.at("arm_angle"),
            hint="only arms with seven axes have one; leave the key out",
        )
    robot = CellRobot(
        name,
        arm,
        tool,
        kinematics,
        base,
        home,
        branch,
        tcps=tcps,
        carries=carries,
        tools=changed,
        begins_with=begins_with,
    )
    if not axes:
        return robot
    whole = with_axes(arm, axes, name, t.at("axes"), t.d)
    if whole is None:
        return None
    home = (*(a.home for a in axes.tracks), *home, *(a.home for a in axes.tables))
    carried = WithAxes(kinematics, axes, whole)
    tcps = {key: WithAxes(own, axes, whole) for key, own in tcps.items()}
    return replace(robot, arm=whole, kinematics=carried, home=home, axes=axes, tcps=tcps)


def _changed(t: Table, tools: Mapping[str, ToolKind]) -> dict[str, ToolKind]:
    """The tools that a robot changes."""
    frames = t.data.get("tcps")
    for name in t.texts("tools"):
        if name not in tools:
            known = ", ".join(f"`{k}`" for k in tools)
            otherwise = f"known tools: {known}" if known else f"add `[tools.{name}]`"
            t.wrong_name("tools", name, "tool", did_you_mean(name, tuple(tools), otherwise))
        elif isinstance(frames, Mapping) and name in frames:
            t.wrong_name("tools", name, "name of its own", "`tcps` has a tool frame of that name")
    return {name: tools[name] for name in t.texts("tools") if name in tools}


def _expect_wrist(arm: Arm, kinematics: Kinematics, d: Diagnostics) -> None:
    """Where an arm says moments, it has the wrist that they are about: no others are looked at."""
    rating = arm.urdf.rating
    if rating is not None and rating.moments and kinematics.wrist_in_flange is None:
        d.error(
            codes.ROBOT_URDF,
            f"`moments` are about axes 4, 5 and 6 of a spherical wrist, and `{arm.name}` has none",
            Origin(str(arm.urdf.path)),
            hint="leave `moments` out; `payload` is looked at for every arm",
        )


def _home(t: Table, name: str, arm: Arm, numbers: tuple[float, ...]) -> tuple[float, ...] | None:
    """HOME of an arm: degrees, and m of axes that slide; None: it has not as many numbers as the arm has axes."""
    count = len(arm.lower)
    if len(numbers) != count:
        said = "" if "home" in t.data else ", where nothing is said,"
        t.d.error(
            codes.ROBOT_VALUE,
            f"HOME of `{name}`{said} has {len(numbers)} numbers, but its arm `{arm.name}` has {count} axes",
            t.at("home") if "home" in t.data else t.at(),
            hint=f"`home` has a number for each of {', '.join(arm.axes)}, in degrees"
            + (", of what slides in m" if any(map(arm.slides, range(count))) else ""),
        )
        return None
    counted = [v if arm.slides(i) else math.radians(v) for i, v in enumerate(numbers)]
    home = arm.meant(np.array(counted))
    for i, margin in enumerate(arm.margins(home)):
        if margin < -1e-9:
            t.d.error(
                codes.ROBOT_VALUE,
                f"HOME of `{name}` puts axis {i + 1} at {_outside(arm, i, home, numbers[i])}",
                t.at("home"),
                hint=RADIANS if in_radians(numbers) else "",
            )
    return tuple(home.tolist())


def _outside(arm: Arm, axis: int, home: Array, said: float) -> str:
    """In the units of the file."""
    if arm.slides(axis):
        return f"{said:.12g} m, outside {arm.lower[axis]:g} .. {arm.upper[axis]:g}"
    low, high, how = arm.lower[axis], arm.upper[axis], ""
    if low - 1e-9 <= home[axis] <= high + 1e-9:
        coupled = next(c for i, _, c in arm.coupled() if i == axis)
        low, high, how = coupled.lower, coupled.upper, f" (counted with `{coupled.other}`)"
    return f"{said:.12g} degrees{how}, outside {math.degrees(low):g} .. {math.degrees(high):g}"


def _scene(
    t: Table,
    robots: tuple[CellRobot, ...],
    devices: tuple[CellRobot, ...],
    names: tuple[str, ...],
    carried: tuple[Mapping[str, PartKind], Mapping[str, ToolKind]],
    folder: Path,
) -> SceneConfig:
    kinds, tools = carried
    panel = _panel(t.table("panel")) if t.has("panel") else None
    depth = t.number("tool_contact_depth")
    contacts = _default_contacts(robots, depth) if depth > 0.0 else []
    objects = read_solids(t.tables("objects"), folder, solid=bool(kinds))
    plates = [f"{r.name}/{a.name}" for r in devices for a in r.carrying]
    contacts += [*_gripping(robots, kinds, objects, plates), *_clamping(devices, kinds)]
    contacts += coupling(robots, tools)
    _expect_holders(t, tools, objects)
    _named_once(
        t, objects, {**dict.fromkeys(kinds, "kind of parts"), **dict.fromkeys(tools, "tool")}
    )
    things = [
        *names,
        *(r.name for r in devices),
        "panel",
        "floor",
        *(o.name for o in objects),
        *(f"{k}.1" for k in kinds),
        *tools,
    ]
    for c in t.tables("contacts"):
        contacts += also_of_tools(_contact(c, things), tools)
    out = SceneConfig(
        panel=panel,
        objects=objects,
        floor=t.flag("floor"),
        contacts=tuple(contacts),
        warning_clearance=t.number("warning_clearance"),
    )
    t.done()
    return out


def _expect_own_names(
    t: Table, tools: Mapping[str, ToolKind], robots: tuple[CellRobot, ...]
) -> None:
    """No tool is called as a part of a robot that changes tools: carried it would be `left/plate` as that is."""
    for robot in robots:
        for name in tools:
            if robot.tools and name in robot.arm.urdf.links:
                t.d.error(
                    codes.ROBOT_VALUE,
                    f"a tool and a part or an axis of robot `{robot.name}` are called `{name}`",
                    t.at(name),
                    hint="give each a name of its own: messages and contact rules name them",
                )


def _expect_holders(
    t: Table, tools: Mapping[str, ToolKind], objects: tuple[SceneObject, ...]
) -> None:
    """What holds tools is among the objects of the scene."""
    known = [o.name for o in objects]
    for name, kind in tools.items():
        for holder in kind.holders:
            if holder not in known:
                t.d.error(
                    codes.ROBOT_VALUE,
                    f"`tools.{name}.holders` names `{holder}`, which is no object of the scene",
                    t.at(),
                    hint=did_you_mean(holder, known, "it names `[scene] objects`"),
                )


def _contact(t: Table, things: list[str]) -> ContactRule:
    """A rule for parts of things that are there."""
    rule = ContactRule(t.text("a"), t.text("b"), t.number("depth"))
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


def _expect_links_apart(arm: Arm, tool: Tool | None, t: Table) -> None:
    """Tool and arm become one tree of links, and the names of the tool's get a prefix."""
    links = () if tool is None else (x for x in tool.urdf.links if f"tool_{x}" in arm.urdf.links)
    for link in links:
        t.d.error(
            codes.ROBOT_VALUE,
            f"the link `tool_{link}` of the arm `{arm.name}` has the name that `{link}` of the tool gets",
            t.at("tool"),
            hint="give one of them another name in its file",
        )


def _gripping(
    robots: tuple[CellRobot, ...],
    kinds: Mapping[str, PartKind],
    objects: tuple[SceneObject, ...],
    belts: list[str],
) -> list[ContactRule]:
    """The tools' contact links may touch parts, and parts that are carried what they are taken from and put on."""
    tips = [f"{r.name}/tool_{x}" for r in robots if r.tool for x in r.tool.contact_links]
    things = [
        "floor",
        "panel/*",
        *belts,
        *(glob.escape(o.name) for o in objects),
        *(f"{kind}.*" for kind in kinds),
        *(f"{r.name}/{table}" for r in robots for table in r.arm.tables),
    ]
    return [
        rule
        for kind in kinds
        for rule in (
            *(ContactRule(tip, f"{kind}.*", PART_CONTACT) for tip in tips),
            *(ContactRule(f"*/{kind}.*", thing, PART_CONTACT) for thing in things),
        )
    ]


def _clamping(
    devices: tuple[CellRobot, ...], kinds: Mapping[str, PartKind]
) -> Iterator[ContactRule]:
    """The jaws of clamps may touch parts, and each other."""
    for jaws in touched(devices):
        yield ContactRule(*jaws, PART_CONTACT)
        for jaw in jaws:
            for kind in kinds:
                yield ContactRule(jaw, f"{kind}.*", PART_CONTACT)
                yield ContactRule(jaw, f"*/{kind}.*", PART_CONTACT)


def _panel(t: Table) -> PanelConfig:
    out = PanelConfig(
        radius=t.number("radius"),
        axis_y=t.number("axis_y"),
        axis_z=t.number("axis_z"),
        x_from=t.number("x_from"),
        x_to=t.number("x_to"),
        arc_from=math.radians(t.number("arc_from")),
        arc_to=math.radians(t.number("arc_to")),
        facing=math.radians(t.number("facing")),
        skin=t.number("skin"),
        ribs=t.numbers("ribs"),
        rib_height=t.number("rib_height"),
        rib_thickness=t.number("rib_thickness"),
        stringer_pitch=math.radians(t.number("stringer_pitch")),
        stringer_height=t.number("stringer_height"),
        stands=t.flag("stands"),
        joint=t.flag("joint"),
    )
    t.done()
    for low, high in (("x_from", "x_to"), ("arc_from", "arc_to")):
        both = (t.data.get(low), t.data.get(high))
        if all(map(is_number, both)) and not getattr(out, low) < getattr(out, high):
            t.wrong(high, f"a number above `{low}`")
    return out


def _named_once(t: Table, objects: tuple[SceneObject, ...], others: Mapping[str, str]) -> None:
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
        if o.name.split(".")[0] in others:
            t.d.error(
                codes.ROBOT_VALUE,
                f"an object of the scene and a {others[o.name.split('.')[0]]} are called `{o.name.split('.')[0]}`",
                t.at("objects"),
                hint="give each a name of its own",
            )
