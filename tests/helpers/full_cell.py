"""A cell.toml that says everything that one may say, and all of its keys as `pn2code.cell_file` knows them.

for path, key in keys(FULL):
    path      # ("supervisor", "reply_timeout_s")
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from tools.misspell.mutants import as_toml

from pn2code.cell.load import load
from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.whole import FILE, PLACED
from pn2code.diagnostics import Diagnostics
from pn2code.properties.sources import from_cell
from pn2code.robot import scene

FULL: dict[str, Any] = tomllib.loads("""
net.file = "cell.cpn"
storage.LENGTH = "float32"
values.parts = 7
capacity.Buffer = 9

[motion]
joint_speed = 0.7
joint_acceleration_deg_s2 = 150.0
joint_jerk_deg_s3 = 900.0
slide_acceleration = 1.5
slide_jerk = 15.0
linear_speed = 0.1
linear_acceleration = 0.6
linear_jerk = 4.0
angular_speed_deg_s = 20.0
measure_s = 2.0
sample_s = 0.01

[supervisor]
instance = "Supervisor"
final = ["Finished", "Failed"]
order = "documented"
reply_timeout_s = 60.0

[[input]]
place = "Poses"
file = "poses.txt"

[[channel]]
place = "order"
file = "order.robcad"
kind = "data"

[primitives]
joint = { command = "move_joint", frame = "bench", speed = 0.5, acceleration = 0.4, depart = 0.1 }
axes = { command = "move_axes", speed = 0.5, acceleration = 0.4 }
past = { command = "move_linear", frame = "bench", blend = 0.02, via = 2 }
line = { command = "move_linear", frame = "bench", speed = 0.2, acceleration = 0.3, approach = 0.2 }
arc = { command = "move_circular", frame = "tool", speed = 0.2, acceleration = 0.3 }
grasp = { command = "move_joint", tcp = "gripper", arm_angle = 20.0 }
both = { command = "move_external", track = "rail", turntable = "plate", speed = 0.5, acceleration = 0.4 }
led = { command = "move_linear", frame = "seam", track = "rail", turntable = "plate" }
shut = { command = "move_external", axis = "door", to = 0.0, speed = 0.5 }
home = { command = "move_home", speed = 0.5, acceleration = 0.2, depart = 0.05 }
look = { command = "measure" }
rest = { command = "wait", duration_s = 3.0 }
grip = { command = "tool", action = "grip", duration_s = 0.5, takes = "box" }
drop = { command = "tool", action = "drop", duration_s = 0.5, releases = "box" }
feed = { command = "tool", action = "feed", duration_s = 0.5, creates = "box", at = "here" }
clear = { command = "tool", action = "clear", duration_s = 0.5, removes = "box", at = "here" }
fetch = { command = "tool", action = "lock", duration_s = 0.5, couples = "hand" }
leave = { command = "tool", action = "unlock", duration_s = 0.5, uncouples = "hand" }

[robots.arm]
instance = "Robot"
model = "kr120_r2500"
tool = "counterpoint"
base = { x = 1.0, y = 2.0, z = 0.5, roll = 1.0, pitch = 2.0, yaw = 3.0 }
home = [0.0, -100.0, 110.0, 0.0, 80.0, 0.0]
branch = "front/up/plus"

[robots.arm.tcps.gripper]
x = 0.1
y = 0.2
z = 0.3
roll = 4.0
pitch = 5.0
yaw = 6.0

[robots.arm.axes.rail]
kind = "track"
direction = [0.0, 1.0, 0.0]
from = -1.0
to = 2.0
home = 0.5
speed = 0.4
acceleration = 0.8
jerk = 5.0

[robots.seven]
instance = "Seven"
model = "iiwa14_r820"
base = { y = -9.0 }
home = [0.0, 30.0, 0.0, 90.0, 0.0, -60.0, 0.0]
arm_angle = 15.0
carries = ["rod"]

[robots.turner]
instance = "Turner"
model = "kr120_r2500"
base = { x = -5.0 }

[robots.other]
instance = "Other"
model = "kr120_r2500"
base = { x = -5.0, y = 5.0 }
tools = ["hand", "foot"]
begins_with = "foot"

[robots.turner.axes.plate]
kind = "turntable"
pose = { x = 1.0, z = 0.5 }
from = -90.0
to = 90.0
home = 10.0
speed = 30.0
acceleration = 60.0
jerk = 300.0
radius = 0.4
height = 0.06
objects = [{ name = "work", size = [0.1, 0.1, 0.1] }]

[devices.belt]
instance = "Belt"

[devices.belt.base]
y = -0.1
[devices.belt.axes.door]
kind = "slide"
pose = { x = 3.0, z = 1.0, yaw = 90.0 }
direction = [0.0, 1.0, 0.0]
from = -0.1
to = 0.8
home = 0.2
speed = 0.3
acceleration = 0.9
jerk = 8.0
objects = [{ name = "leaf", size = [0.8, 0.02, 0.6] }]

[devices.belt.axes.flap]
kind = "swing"
pose = { x = 4.0 }
from = -10.0
to = 100.0
home = 5.0
speed = 50.0
acceleration = 110.0
jerk = 550.0
objects = [{ name = "plate", kind = "cylinder", radius = 0.1, length = 0.02 }]

[devices.belt.axes.vice]
kind = "clamp"
pose = { x = 5.0, z = 0.5 }
from = 0.01
to = 0.1
home = 0.1
speed = 0.05
acceleration = 0.5
jerk = 5.0
jaw = [0.04, 0.1, 0.05]
colour = [0.2, 0.2, 0.2]
holds = "jaws"
may_be_empty = true

[devices.belt.axes.conveyor]
kind = "belt"
pose = { x = 6.0, z = 0.5, yaw = 30.0 }
length = 1.5
width = 0.4
height = 0.2
speed = 0.25
acceleration = 0.4
jerk = 4.0
colour = [0.1, 0.1, 0.1]
stop = "end"
drives = ["further"]

[devices.belt.axes.further]
kind = "belt"
pose = { x = 7.299038105676658, y = 0.75, z = 0.5, yaw = 30.0 }
length = 0.5
width = 0.4

[sensors.gauge]
variable = "v"
file = "gauge.txt"
default = 4
seed = 5
sees = "here"
part = "box"
says = "how thick the part is"

[sensors.shut]
variable = "w"
sees = "belt.door"
at = 0.8

[zones.front]
pose = { x = 1.0, yaw = 10.0 }
size = [1.0, 2.0, 2.0]
max_speed = 0.25

[scene]
floor = false
tool_contact_depth = 0.004
warning_clearance = 0.03
objects = [
    { name = "table", kind = "box", pose = { x = 0.5 }, size = [1.0, 0.6, 0.8], colour = [0.1, 0.2, 0.3, 0.4] },
    { name = "post", kind = "cylinder", radius = 0.1, length = 2.0 },
    { name = "stone", kind = "mesh", file = "stone.obj", scale = 2.0, hulls = 2 },
]
contacts = [{ a = "arm/link_6", b = "table", depth = 0.001 }]

[scene.panel]
radius = 1.6
axis_y = 7.4
axis_z = 1.7
x_from = 5.0
x_to = 7.5
arc_from = -60.0
arc_to = 55.0
facing = 165.0
skin = 0.004
ribs = [5.5, 6.0]
rib_height = 0.06
rib_thickness = 0.007
stringer_pitch = 9.0
stringer_height = 0.02
stands = false
joint = true

[parts.box]
kind = "box"
size = [0.2, 0.2, 0.15]
colour = [0.7, 0.5, 0.3]
at = [{ x = 1.5, z = 0.5 }]
grips = [{ z = 0.075, roll = 180.0 }]
grip_tolerance = 0.01
grip_angle_deg = 7.0
contact_way = 0.2
mass = 1.5

[parts.rod]
kind = "cylinder"
radius = 0.1
length = 0.3

[parts.lump]
kind = "mesh"
file = "stone.obj"
scale = 0.5
hulls = 3

[tools.hand]
model = "counterpoint"
rack = "shelf"
holders = ["table"]
takes = ["box"]
does = ["grip"]
tolerance = 0.003
angle_deg = 3.0

[tools.foot]
model = "vacuum_gripper"

[places.shelf]
x = -5.0
y = 6.0
z = 1.0
[places.jaws]
x = 5.01
z = 0.5
[places.end]
x = 7.0
y = 0.5
z = 0.5
[places.here]
x = 1.0
y = 2.0
z = 3.0
roll = 4.0
pitch = 5.0
yaw = 6.0

[frames.bench]
x = 1.0
y = 2.0
z = 3.0
roll = 4.0
pitch = 5.0
yaw = 6.0

[frames.seam]
parent = "turner.plate"
x = 0.05

[frames.corner]
parent = "bench"
x = 0.1

[report]
rows = ["order"]
count = { grips = "grip" }
occurrences = { orders = "Supervisor.Order" }
warn_condition = 40.0
failed = ["Failed"]

[layouts.plain]
description = "as it is"

[layouts.near]
description = "close by"
robots.arm.base.x = 0.5
motion.joint_speed = 0.4
scene.floor = true
parts.box.grip_tolerance = 0.02
places.here.x = 0.9
frames.corner.x = 0.2
devices.belt.base.y = -0.2

[[accept]]
warning = "robot-choice"
elements = ["Robot1'Put", "Robot1'Take"]
reason = "the script prefers Put"
[[property]]
name = "ends"
says = "the cell always comes to an end"
holds = "ctl AF tokens(Supervisor'Finished) = 1"
expect = false
fair = ["weak all"]
about = "net"
""")

_ARMS = ("tools", "parts", "places", "frames", "robots", "devices", "scene")
_NEEDED = {
    "primitives": _ARMS,
    "sensors": ("parts", "places", "robots", "devices"),
    "report": ("channel", "primitives", *_ARMS),
    "devices": ("places",),
    "frames": ("robots", "parts", "tools", "places", "scene"),
    "robots": ("parts", "tools", "places", "scene"),
    "scene": ("robots", "parts", "tools", "places"),
    "tools": _ARMS,
    "layouts": tuple(FULL),
}
"""The sections that are named in a section."""


def about(section: str) -> dict[str, Any]:
    """The sections without which nothing can be said about one of them, and that one."""
    wanted = ("net", "supervisor", section, *_NEEDED.get(section, ()))
    return {name: table for name, table in FULL.items() if name in wanted}


PathOf = tuple[str | int, ...]


def keys(
    data: dict[str, Any], section: Section = FILE, at: PathOf = ()
) -> Iterator[tuple[PathOf, Key]]:
    """Each key that the tables have, with where it is; entries whose names are chosen, too."""
    word = str(data.get(section.by, section[section.by].default)) if section.by else ""
    for name, value in data.items():
        key = section.key(name, word)
        yield (*at, name), key
        yield from _inner(value, key, (*at, name))


def _inner(value: Any, key: Key, at: PathOf) -> Iterator[tuple[PathOf, Key]]:
    if key.kind == "table":
        yield from keys(value, key.inner, at)
    elif key.kind == "tables":
        for i, inner in enumerate(value):
            yield from keys(inner, key.inner, (*at, i))
    elif key.kind == "named":
        for name, inner in value.items():
            yield from keys(inner, key.inner, (*at, name))
    elif key.kind == "entries":
        yield from (((*at, name), key.of) for name in value)


def declared(section: Section = FILE) -> Iterator[Key]:
    """Every key that there may be."""
    for key in section:
        yield key
        if key.of is not None:
            yield key.of
        if key.inner is not None:
            yield from declared(key.inner)


def read(folder: Path, data: dict[str, Any], section: str) -> tuple[str, Diagnostics]:
    """What is made of it by all that read it, as text, and what they say.

    Args:
        section: what is looked at: arms are read only where it is about them, and the layout `near` for layouts.
    """
    (folder / "stone.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    path = folder / "cell.toml"
    path.write_text(as_toml(data), encoding="utf-8")
    d = Diagnostics()
    config = load(path, d, layout="near" if section == "layouts" else None)
    if config is None:
        return "", d
    is_placed = section in (*PLACED, "tools", "devices", "layouts")
    cell = scene.load(config.geometry, folder, config.locator.origin, d) if is_placed else None
    shown = [
        config.layouts,
        replace(config, geometry={}),
        [(p.name, p.says, p.holds.text, p.expect, p.fair, p.of_net) for p in from_cell(config, d)],
    ]
    if cell is not None:
        shown += [cell.motion, cell.scene, cell.parts, cell.places, cell.frames, cell.zones]
        shown += [
            (r.name, r.arm.name, r.tool and r.tool.name, r.base, r.home, r.branch, r.turning)
            for r in cell.moving
        ]
        shown += [
            (name, k.T_flange_tcp.tolist()) for r in cell.robots for name, k in r.tcps.items()
        ]
        shown += [
            (r.kinematics.arm_angle, r.carries, tuple(r.tools), r.begins_with) for r in cell.robots
        ]
        shown += [
            (x.name, x.tool.name, x.rack, x.holders, x.takes, x.does, x.tolerance, x.angle)
            for x in cell.tools.values()
        ]
        shown += [a.described() for r in cell.moving for a in r.axes]
        shown += [
            (c.axis.name, c.jaws, c.place, c.may_be_empty)
            for r in cell.devices
            for c in r.axes.clamps
        ]
    return re.sub(r"Origin\([^()]*\)", "", repr(shown).replace(str(folder), "")), d


def skeleton() -> dict[str, Any]:
    """The least that a cell.toml must say."""
    return {"net": {"file": "cell.cpn"}, "supervisor": {"instance": "Supervisor"}}


def merged(data: dict[str, Any], over: dict[str, Any]) -> str:
    """A file that says both; sections of the second replace those of the first."""
    return as_toml({**data, **over})
