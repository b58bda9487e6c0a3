"""`[scene]` of cell.toml: panel, objects, floor, contacts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from pn2code.robot import codes
from pn2code.robot.contact_rules import clamping, gripping, read_rule, tips_on_panel
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import CellRobot, PanelConfig, SceneConfig
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.solid_objects import read_solids
from pn2code.robot.table import Table, is_number
from pn2code.robot.tool_contacts import also_of_tools, coupling
from pn2code.robot.tools_table import ToolKind


def read_scene(
    t: Table,
    robots: tuple[CellRobot, ...],
    devices: tuple[CellRobot, ...],
    names: tuple[str, ...],
    carried: tuple[Mapping[str, PartKind], Mapping[str, ToolKind]],
    folder: Path,
) -> SceneConfig:
    """`[scene]`, with the contacts that are permitted because of what there is."""
    kinds, tools = carried
    panel = _panel(t.table("panel")) if t.has("panel") else None
    depth = t.number("tool_contact_depth")
    contacts = tips_on_panel(robots, depth) if depth > 0.0 else []
    objects = read_solids(t.tables("objects"), folder, solid=bool(kinds))
    plates = [f"{r.name}/{a.name}" for r in devices for a in r.carrying]
    contacts += [*gripping(robots, kinds, objects, plates), *clamping(devices, kinds)]
    contacts += coupling(robots, tools)
    _named_once(
        t, objects, {**dict.fromkeys(kinds, "kind of parts"), **dict.fromkeys(tools, "tool")}
    )
    things = [
        *names,
        *(f"{r.name}_{what}" for r in robots for what in ("pedestal", "rail")),
        *(r.name for r in devices),
        "panel",
        "floor",
        *(o.name for o in objects),
        *(f"{k}.1" for k in kinds),
        *tools,
    ]
    for c in t.tables("contacts"):
        contacts += also_of_tools(read_rule(c, things), tools)
    out = SceneConfig(
        panel=panel,
        objects=objects,
        floor=t.flag("floor"),
        contacts=tuple(contacts),
        warning_clearance=t.number("warning_clearance"),
    )
    t.done()
    return out


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
