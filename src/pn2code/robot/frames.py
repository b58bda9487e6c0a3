"""`[frames]` of cell.toml: frames in which poses are given, each in the world or in another one.

[frames.pallet]
x = 1.2
yaw = 30.0

[frames.layer]
parent = "pallet"
z = 0.15
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping

from pn2code.base.frozen import frozen
from pn2code.cell_file.poses import FRAME
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes
from pn2code.robot.commands import Pose
from pn2code.robot.table import Table
from pn2code.robot.table_poses import read_own_pose
from pn2code.robot.transforms import Array, matrix_of, pose_of

WORLD = "world"
_TAKEN = (WORLD, "tool")


@frozen
class Frames:
    """By name: those that stand, each in the world; and those on a turntable, with its robot and name, on its plate."""

    standing: Mapping[str, Pose]
    turning: Mapping[str, tuple[str, str, Pose]]


def read_frames(t: Table, plates: Collection[str] = ()) -> Frames:
    """The frames; what is wrong is reported.

    Args:
        plates: the turntables, each as `ROBOT.AXIS`.
    """
    own: dict[str, tuple[Pose, str]] = {}
    for name, table in t.named(FRAME):
        if name in _TAKEN or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
            t.d.error(
                codes.ROBOT_VALUE,
                f"`{name}` is not a name for frames",
                t.at(name),
                hint="a letter, then letters, digits and `_`; not `world` or `tool`, which are frames already",
            )
        parent = table.text("parent")
        if parent != WORLD and parent not in t.data and parent not in plates:
            near = did_you_mean(parent, (WORLD, *t.data, *plates))
            near = near or f"add a table `[frames.{parent}]`"
            table.wrong("parent", "`world` or the name of another frame", near)
            parent = WORLD
        own[name] = read_own_pose(table), parent
    out: dict[str, Pose] = {}
    turning: dict[str, tuple[str, str, Pose]] = {}
    for name in own:
        line = _line(own, name)
        if line[-1] in plates:
            robot, axis = line[-1].split(".")
            turning[name] = (robot, axis, pose_of(_in_world(own, line)))
            continue
        if line[-1] != WORLD:
            t.d.error(
                codes.ROBOT_VALUE,
                f"frame `{name}` is given in itself: {' in '.join(f'`{x}`' for x in line)}",
                t.at(name),
                hint='one of them needs `parent = "world"`',
            )
            continue
        out[name] = pose_of(_in_world(own, line))
    return Frames(out, turning)


def _line(own: Mapping[str, tuple[Pose, str]], name: str) -> list[str]:
    """A frame, what it is in, and so on: to the world, or to one that was there before."""
    line = [name]
    while line[-1] in own and line.count(line[-1]) == 1:
        line.append(own[line[-1]][1])
    return line


def _in_world(own: Mapping[str, tuple[Pose, str]], line: list[str]) -> Array:
    *frames, _ = line
    out = matrix_of(own[frames[-1]][0])
    for name in reversed(frames[:-1]):
        out = out @ matrix_of(own[name][0])
    return out
