"""Which contacts of tools that are changed are permitted: with what couples them, their rack, and what they grip.

A tool is one thing in contact rules: `arm/gripper` in the hand of a robot, `gripper` where it lies. Where many are
compared, it has further names behind that one (`gripper.tool_held_by_arm`).
"""

from __future__ import annotations

import glob
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from pn2code.robot.placed_links import placed_links, tool_links
from pn2code.robot.robot_cell import PART_CONTACT, CellRobot, ContactRule
from pn2code.robot.tools_table import ToolKind


def coupling(robots: Sequence[CellRobot], tools: Mapping[str, ToolKind]) -> Iterator[ContactRule]:
    """What couplings touch lying tools with, tools what holds them there, and contact links what they grip."""
    for robot in robots:
        ends = [f"{robot.name}/{link}" for link in end_links(robot)] if robot.tools else ()
        for name, kind in robot.tools.items():
            for end in ends:
                yield from also_of_tools(ContactRule(end, name, PART_CONTACT, "tool"), tools)
            held = f"{robot.name}/{name}"
            gripped = [f"{k}.*" for k in kind.takes] if kind.tool.contact_links else []
            for other in map(glob.escape, kind.holders):
                yield from also_of_tools(ContactRule(held, other, PART_CONTACT, "tool"), tools)
            for part in gripped:
                yield from also_of_tools(ContactRule(held, part, PART_CONTACT, "tool"), tools)


def end_links(robot: CellRobot) -> Iterator[str]:
    """The links behind the last axis of the arm."""
    last, of_tool = robot.kinematics.joints.stop, tool_links(robot)
    for link, joint, _ in placed_links(robot):
        if joint == last or link in of_tool:
            yield link


def also_of_tools(rule: ContactRule, tools: Mapping[str, ToolKind]) -> Iterator[ContactRule]:
    """A rule, and the same for the further names that tools in it have."""
    yield rule
    if rule.a.split("/")[-1] in tools:
        yield replace(rule, a=f"{rule.a}.*")
    if rule.b.split("/")[-1] in tools:
        yield replace(rule, b=f"{rule.b}.*")
