"""An entry of `[robots]` of cell.toml: the arm with its tool, where it stands, HOME, its tool frames and axes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.carried import WithAxes, with_axes
from pn2code.robot.external import read_axes
from pn2code.robot.kinematics import Kinematics
from pn2code.robot.model import Arm, Tool, find_arm, find_tool
from pn2code.robot.robot_cell import CellRobot
from pn2code.robot.table import Table
from pn2code.robot.table_poses import read_own_pose, read_pose
from pn2code.robot.tools_table import ToolKind
from pn2code.robot.transforms import Array, matrix_of

RADIANS = "angles in cell.toml are in degrees; if these are radians, multiply them by 57.2958"
FEW_RADIANS = 3.2
"""No axis at HOME is further from 0: written in radians this is half a turn, in degrees next to nothing."""


def in_radians(angles: Sequence[float]) -> bool:
    """Whether the angles of HOME look as if they were written in radians."""
    return max(map(abs, angles)) < FEW_RADIANS and sum(abs(q) > 0.5 for q in angles) > 1


def read_robot(
    t: Table, name: str, folder: Path, tools: Mapping[str, ToolKind]
) -> CellRobot | None:
    """An entry of `[robots]`; None if it is wrong, or its model cannot be read."""
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
