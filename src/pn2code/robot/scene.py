"""Reads the cell as the robots see it from cell.toml: arms, tools, bases, motion limits, scene objects.

    cell = load({"robots": ..., "motion": ..., "scene": ...}, folder, at, d)

`load` takes the raw sections of cell.toml (lengths in m, angles in degrees), reports every mistake
with its line, and gives a `RobotCell` in SI units. A panel with ribs is one kind of scene object
beside boxes, cylinders and meshes; nothing here knows what the cell is for.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pn2code.cell_file.arms import MOTION, ROBOT
from pn2code.cell_file.keys import Section
from pn2code.cell_file.scene import SCENE
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.collision_meshes import unread_meshes
from pn2code.robot.devices import Around, read_devices
from pn2code.robot.frames import Frames, read_frames
from pn2code.robot.hulls import Hull
from pn2code.robot.names_in_contacts import expect_things
from pn2code.robot.parts_table import PartKind, read_kinds, read_places
from pn2code.robot.read_robot import read_robot
from pn2code.robot.read_scene import read_scene
from pn2code.robot.robot_cell import CellRobot, MotionConfig, RobotCell
from pn2code.robot.table import Locate, Table
from pn2code.robot.tools_table import ToolKind, expect_holders, expect_somewhere, read_tools
from pn2code.robot.zones import unread
from pn2code.robot.zones_table import read_zones


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
        and (robot := read_robot(robot_table, name, folder, tools)) is not None
    )
    names = tuple(geometry.get("robots", {}))
    expect_somewhere(
        table("tools", None),
        tools,
        {r.name: r.begins_with for r in robots},
        _uncoupled(primitives),
    )
    plates = [f"{r.name}.{a.name}" for r in robots for a in r.axes.tables]
    plates += _axes_of_others(geometry.get("robots", {}), [r.name for r in robots])
    frames = read_frames(table("frames", None), plates)
    named = dict(table("robots", None).named(ROBOT))
    taken = _said_of(primitives, "takes")
    robots = tuple(_loaded(_with_frames(r, frames), kinds, taken, named[r.name]) for r in robots)
    hulls = [hull for k in kinds.values() for hull in Hull.of(k.shape)]
    around = Around(folder, places, max((h.radius for h in hulls), default=0.0))
    devices = read_devices(table("devices", None), around)
    scene = read_scene(table("scene", SCENE), robots, devices, names, (kinds, tools), folder)
    expect_holders(table("tools", None), tools, scene.objects)
    zones = read_zones(table("zones", None))
    _expect_own_names(table("tools", None), tools, robots)
    if len(d.errors) != before:
        return None
    cell = RobotCell(robots, motion, scene, kinds, places, frames.standing, devices, zones, tools)
    expect_things(table("scene", SCENE), cell)
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


def _axes_of_others(said: object, read: Collection[str]) -> Iterator[str]:
    """The external axes of robots that could not be read: frames that name one of them are no second mistake."""
    for name, robot in said.items() if isinstance(said, Mapping) else ():
        axes = robot.get("axes") if isinstance(robot, Mapping) else None
        if name not in read and isinstance(axes, Mapping):
            yield from (f"{name}.{axis}" for axis in axes)


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
