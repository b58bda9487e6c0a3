"""Which contacts are permitted: by `[scene] contacts`, of tools with the panel, of what grips parts, of clamps."""

from __future__ import annotations

import fnmatch
import glob
import re
from collections.abc import Iterator, Mapping

from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.devices import touched
from pn2code.robot.parts_table import PartKind
from pn2code.robot.robot_cell import PART_CONTACT, CellRobot, ContactRule
from pn2code.robot.scene_objects import SceneObject
from pn2code.robot.table import Table


def read_rule(t: Table, things: list[str]) -> ContactRule:
    """A rule for parts of things that are there."""
    rule = ContactRule(t.text("a"), t.text("b"), t.number("depth"))
    t.done()
    for key, name in (("a", rule.a), ("b", rule.b)):
        thing = name.split("/")[0]
        meant = (thing, re.sub(r"\.\d+$", ".1", thing))  # parts are numbered as they come
        if name and not any(fnmatch.fnmatchcase(x, m) for x in things for m in meant):
            near = did_you_mean(thing, things, f"known are {', '.join(f'`{x}`' for x in things)}")
            t.wrong(key, "a part of a robot or of the scene", near)
    return rule


def tips_on_panel(robots: tuple[CellRobot, ...], depth: float) -> list[ContactRule]:
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


def gripping(
    robots: tuple[CellRobot, ...],
    kinds: Mapping[str, PartKind],
    objects: tuple[SceneObject, ...],
    belts: list[str],
) -> list[ContactRule]:
    """The tools' contact links may touch parts, and parts that are carried what they are taken from and put on."""
    tips = [(f"{r.name}/tool_{x}", r) for r in robots if r.tool for x in r.tool.contact_links]
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
            *(
                ContactRule(tip, f"{kind}.*", PART_CONTACT, "tool" if kind in robot.carries else "")
                for tip, robot in tips
            ),
            *(ContactRule(f"*/{kind}.*", thing, PART_CONTACT, "part") for thing in things),
        )
    ]


def clamping(
    devices: tuple[CellRobot, ...], kinds: Mapping[str, PartKind]
) -> Iterator[ContactRule]:
    """The jaws of clamps may touch parts, and each other."""
    for jaws in touched(devices):
        yield ContactRule(*jaws, PART_CONTACT)
        for jaw in jaws:
            for kind in kinds:
                yield ContactRule(jaw, f"{kind}.*", PART_CONTACT)
                yield ContactRule(f"*/{kind}.*", jaw, PART_CONTACT, "part")
