"""Taking a tool from its rack, and leaving it there: where it has to be, and what may be in the way.

    why_not_coupled(parts.present, "robot1", kind, T_world_coupling, 0.0)       # "": it can be coupled

A tool that has been coupled is exactly at the coupling, and one that has been left is exactly where its rack is: both
centre it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from pn2code.robot.part import Part
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, describe, difference, pose_of


def tool_in_use(parts: Iterable[Part], robot: str) -> Part | None:
    """The tool that a robot has coupled."""
    return next((p for p in parts if p.holder == robot and isinstance(p.kind, ToolKind)), None)


def lying_at(parts: Iterable[Part], frame: Array, tolerance: float) -> Part | None:
    """A tool that lies so near to a place."""
    lying = (p for p in parts if isinstance(p.kind, ToolKind) and not p.holder)
    return next((p for p in lying if difference(p.frame, frame)[0] <= tolerance), None)


def why_not_coupled(
    parts: dict[str, Part], robot: str, kind: ToolKind, coupling: Array, slack: float
) -> str:
    """Why a robot cannot couple a tool, in words; "": it can."""
    does = f"`{robot}` couples tool `{kind.name}`"
    at = f"at pose {describe(pose_of(coupling))}"
    used = tool_in_use(parts.values(), robot)
    if used is not None:
        return f"{does}, but it has tool `{used.name}` in use, {at}"
    tool = parts[kind.name]
    if tool.holder:
        return f"{does}, but `{tool.holder}` has it in use, {at}"
    if off := _off(kind, tool.frame, coupling, slack):
        other = lying_at(parts.values(), coupling, kind.tolerance)
        here = f"; `{other.name}` lies here" if other is not None else ""
        return f"{does}, which lies {off}{here}, {at}"
    return ""


def why_not_uncoupled(
    parts: dict[str, Part], robot: str, kind: ToolKind, coupling: Array, rack: Array, slack: float
) -> str:
    """Why a robot cannot leave a tool in its rack, in words; "": it can."""
    does = f"`{robot}` uncouples tool `{kind.name}`"
    at = f"at pose {describe(pose_of(coupling))}"
    used = tool_in_use(parts.values(), robot)
    if used is None or used.kind is not kind:
        other = f"tool `{used.name}`" if used is not None else "no tool"
        return f"{does}, but it has {other} in use, {at}"
    held = next(
        (p for p in parts.values() if p.holder == robot and not isinstance(p.kind, ToolKind)), None
    )
    if held is not None:
        return f"{does}, which still holds `{held.name}`, {at}"
    if off := _off(kind, rack, coupling, slack):
        return f"{does}, but its place `{kind.rack}` is {off}, {at}"
    other_tool = lying_at(parts.values(), rack, kind.tolerance)
    if other_tool is not None:
        return f"{does}, but tool `{other_tool.name}` lies at its place `{kind.rack}`, {at}"
    return ""


def _off(kind: ToolKind, wanted: Array, coupling: Array, slack: float) -> str:
    """How far the coupling is from where it has to be, if that is too much, in words."""
    way, turn = difference(wanted, coupling)
    if way <= kind.tolerance + slack and turn <= kind.angle + slack:
        return ""
    off = f"{1000.0 * way:.1f} mm"
    off += f" and {math.degrees(turn):.1f} deg" if turn > kind.angle else ""
    most = f"{1000.0 * kind.tolerance:g} mm, {math.degrees(kind.angle):g} deg"
    return f"{off} away (at most {most})"
