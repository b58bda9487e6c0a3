"""Commands and reasons in words."""

from __future__ import annotations

import math
from collections.abc import Iterable

from pn2code.geometry.graph import MOST_HELD
from pn2code.robot.commands import (
    Along,
    Command,
    Handling,
    Measure,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
    Pose,
    ToolAction,
    Wait,
    tcp_of,
)
from pn2code.robot.part import Part
from pn2code.verify.answers.reasons import clause

_OPEN = {
    "states": "the cell has more states than were looked at, as many as there is memory for and at most "
    f"{MOST_HELD:,}, or as `--max-states` says: fewer parts or rounds make it smaller (a `val` of the net with "
    "`--set`), and so do colour sets with fewer values",
    "seconds": "the time was over before all states of the cell were seen",
    "memory": "the memory was full before all states of the cell were seen",
    "interrupted": "it was interrupted before all states of the cell were seen",
    "error": "an inscription raises an exception in a state of the cell",
    "situations": "arms and parts can be in more ways together than were looked at",
    "overtaken": "a transition of a robot that is under way may be overtaken by another one, and what the robot does "
    "then is not followed",
    "order": "what becomes of a part or tool depends on how far two programs are that handle it at the same time",
    "turning": "what becomes of a part depends on how far a turntable, a belt or another axis is that another program "
    "moves",
    "sees": "the cell has more states than were looked at, and a sensor sees its scene, so that each state counts: "
    "more are looked at with `--max-states`",
    "file": "the graph of the cell could not be written into a temporary file; is the disk full?",
    "outside": "what a robot is told depends on more than tokens: random numbers, files, the time, or the number of "
    "steps",
}


def reason(why: str, raised: str = "") -> str:
    """Why not all is known, as a clause; "": all is.

    Args:
        why: one of `Exploration.why`, or of those that are named here.
        raised: of "error": what raises the exception.
    """
    if why == "error" and raised:
        return f"{_OPEN[why]}: {raised} (`pn2code verify` shows a run to it)"
    return _OPEN.get(why) or clause(why)


def listed(names: Iterable[str], word: str = "and") -> str:
    """`a, b and c`."""
    *most, last = names
    return f"{', '.join(most)} {word} {last}" if most else last


def words(command: Command | None) -> str:
    """A command in the units of scripts."""
    match command:
        case None:
            return "stands"
        case MoveJoint(target=pose, frame=frame):
            how = f"{_by(command.tcp)}{_with(command.along)}{_elbow(command.arm_angle)}"
            return f"joint {numbers(pose)}{_within(frame)}{how}"
        case MoveAxes(axes=axes):
            return f"axes {' '.join(_short(math.degrees(v)) for v in axes)}{_with(command.along)}"
        case MoveExternal(along=along):
            return f"external{_with(along)}"
        case MoveLinear(target=pose, frame=frame, via=through):
            how = f"{_by(command.tcp)}{_with(command.along)}{_elbow(command.arm_angle)}"
            if through:
                how += f", blend {_short(1000.0 * command.blend)} mm"
            places = "".join(f" via {numbers(p)}" for p in through)
            return f"linear {numbers(pose)}{places}{_within(frame)}{how}"
        case MoveCircular(target=pose, via=via, frame=frame):
            places = " ".join(_short(1000.0 * v) for v in (via.x, via.y, via.z))
            how = f"{_by(command.tcp)}{_with(command.along)}{_elbow(command.arm_angle)}"
            return f"circular {numbers(pose)} via {places}{_within(frame)}{how}"
        case MoveHome():
            return "home"
        case Measure():
            return "measure"
        case ToolAction(action=action, handling=Handling(is_of_tool=True) as change):
            return f"tool {action} {change}"
        case ToolAction(action=action):
            return f"tool {action}"
        case Wait(duration=seconds):
            return f"wait {seconds:g} s"


def carrying(command: Command | None, held: Iterable[Part]) -> str:
    """What an arm has: a part, what stands on that, and its tool in use, unless the command names it."""
    held = [*held]
    by = "" if command is None else tcp_of(command)
    tools = "".join(f", {p.kind.name} in use" for p in held if p.is_tool and p.kind.name != by)
    parts = "".join(f" with {p.kind.name}" for p in held if p.up is None and not p.is_tool)
    on_it = sum(p.up is not None for p in held)
    return f"{parts}{f' and {on_it} on it' if on_it else ''}{tools}"


def _within(frame: str) -> str:
    return "" if frame == "world" else f" in {frame}"


def _elbow(arm_angle: float | None) -> str:
    return "" if arm_angle is None else f", arm angle {_short(math.degrees(arm_angle))}"


def _by(tcp: str) -> str:
    return f" by {tcp}" if tcp else ""


def _with(along: tuple[Along, ...]) -> str:
    """External axes, in mm and degrees."""
    shown = (f"{a.axis} {position(a.position, a.is_track)}" for a in along)
    text = ", ".join(shown)
    return f" with {text}" if text else ""


def position(value: float, slides: bool) -> str:
    """Of an external axis, mm or degrees."""
    return _short(value * (1000.0 if slides else math.degrees(1.0)))


def numbers(pose: Pose) -> str:
    """mm and degrees."""
    mm = " ".join(_short(1000.0 * v) for v in (pose.x, pose.y, pose.z))
    deg = " ".join(_short(math.degrees(v)) for v in (pose.rx, pose.ry, pose.rz))
    return f"{mm}, {deg}"


def _short(value: float) -> str:
    text = f"{value:.1f}".removesuffix(".0")
    return "0" if text == "-0" else text
