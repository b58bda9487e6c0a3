"""`[tools]` of cell.toml: tools that robots couple and uncouple.

[tools.gripper]
model = "vacuum_gripper"            # as `tool` of a robot; its root is what is coupled
rack = "rackLeft"                   # [places.rackLeft]: where its root lies
takes = ["box"]

[robots.arm]
tool = "none"                       # what stays on the flange: the coupling, at its TCP
tools = ["gripper", "driver"]
begins_with = "gripper"
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.cell_file.arms import TOOL
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.commands import Pose
from pn2code.robot.model import Tool, find_tool
from pn2code.robot.parts_table import PartKind
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.table import Table
from pn2code.robot.transforms import Array


@frozen(eq=False)
class ToolKind:
    """A tool; of each there is one.

    Args:
        tool: its tree, and its TCP in the frame of its root, which is what is coupled.
        rack: where it lies, a name of `[places]`; "": nowhere.
        holders: what holds it there, which it may touch.
        takes: the kinds of parts that it grips; does: the actions for which it, or another one, is needed.
        tolerance: how far the coupling may be from the tool, m; angle: how far it may be turned, rad.
    """

    name: str
    tool: Tool
    rack: str
    takes: tuple[str, ...]
    does: tuple[str, ...]
    tolerance: float
    angle: float
    holders: tuple[str, ...] = ()

    @property
    def mass(self) -> float:
        """In kg."""
        return self.tool.urdf.mass

    def with_coupling(self, tool: Tool | None) -> tuple[str, float, Array]:
        """Name, mass and centre of what hangs on a flange: what stays there, and this tool."""
        own = (0.0, np.zeros(3)) if tool is None else (tool.urdf.mass, tool.urdf.centre)
        frame = np.eye(4) if tool is None else tool.T_flange_tcp
        there = (frame @ np.append(self.tool.urdf.centre, 1.0))[:3]
        mass = own[0] + self.mass
        middle = own[0] * own[1] + self.mass * there
        return self.name, mass, np.asarray(middle / mass if mass > 0.0 else there)


def read_tools(
    t: Table, folder: Path, kinds: Mapping[str, PartKind], places: Mapping[str, Pose]
) -> dict[str, ToolKind]:
    """The tools, by name; what is wrong is reported.

    `kinds`, `places`: what they name.
    """
    out = {}
    for name, table in t.named(TOOL):
        if not name.isidentifier() or name in kinds:
            t.d.error(
                codes.ROBOT_VALUE,
                f"`{name}` is not a name for a tool",
                t.at(name),
                hint="a letter, then letters, digits and `_`, and not the name of a kind of parts",
            )
        model = table.text("model")
        tool = find_tool(model, folder, table.at("model"), t.d) if model else None
        rack = table.text("rack")
        if rack and rack not in places:
            table.wrong("rack", "the name of a place of `[places]`", did_you_mean(rack, places))
        takes, does, holders = (table.texts(key) for key in ("takes", "does", "holders"))
        for one in takes:
            if one not in kinds:
                some = ", ".join(f"`{n}`" for n in kinds) or "there is none"
                hint = did_you_mean(one, kinds, f"known kinds: {some}")
                table.wrong_name("takes", one, "kind of parts", hint)
        tolerance, angle = table.number("tolerance"), math.radians(table.number("angle_deg"))
        table.done()
        if tool is not None:
            out[name] = ToolKind(name, tool, rack, takes, does, tolerance, angle, holders)
    return out


def expect_holders(t: Table, tools: Mapping[str, ToolKind], objects: Sequence[SceneObject]) -> None:
    """What holds tools is among the objects of the scene. `t`: the table of the tools."""
    known = [o.name for o in objects]
    for name, kind in tools.items():
        for holder in kind.holders:
            if holder not in known:
                hint = did_you_mean(holder, known, "it names `[scene] objects`")
                t.inside(name).wrong_name("holders", holder, "object of the scene", hint)


def expect_somewhere(
    t: Table,
    tools: Mapping[str, ToolKind],
    begins: Mapping[str, str],
    uncoupled: Mapping[str, Sequence[str]],
) -> None:
    """Each tool is somewhere when a run begins, no two are at one place, and who lets one go has a place for it.

    Args:
        t: the table of the tools.
        begins: which tool each robot has at the start, "" if none.
        uncoupled: by tool, the primitives that uncouple it.
    """
    holders: dict[str, list[str]] = {}
    for robot, tool in begins.items():
        holders.setdefault(tool, []).append(robot)
    lying: dict[str, str] = {}
    for name, kind in tools.items():
        robots = holders.get(name, [])
        if len(robots) > 1:
            t.d.error(
                codes.ROBOT_VALUE,
                f"robots `{robots[0]}` and `{robots[1]}` both begin with tool `{name}`, of which there is one",
                t.at(name),
                hint="declare a second tool with the same `model`",
            )
        if not kind.rack and (not robots or uncoupled.get(name)):
            why = (
                f"`{uncoupled[name][0]}` uncouples tool `{name}`" if robots else f"no robot begins with tool `{name}`"
            )  # fmt: skip
            t.d.error(
                codes.ROBOT_VALUE,
                f"{why}, and it has no place",
                t.at(name),
                hint='add `rack = "..."`, a name of `[places]`',
            )
        if robots or not kind.rack:
            continue
        if kind.rack in lying:
            t.d.error(
                codes.ROBOT_VALUE,
                f"tools `{lying[kind.rack]}` and `{name}` are both at place `{kind.rack}` when a run begins",
                t.at(name),
                hint="give each a place of its own",
            )
        lying[kind.rack] = name
