"""Commands in words: of what kind they are, and what they say in the units of the scripts.

kind_and_label(command)         # ("tool", "rivet")
words(command)                  # "linear 0.0000 0.0000 150.0000 mm, 180.0000 0.0000 0.0000 deg"
"""

from __future__ import annotations

import numpy as np

from pn2code.robot.commands import (
    Along,
    Command,
    Measure,
    MoveAxes,
    MoveCircular,
    MoveExternal,
    MoveHome,
    MoveJoint,
    MoveLinear,
    ToolAction,
    Wait,
)

KINDS = ("joint", "home", "linear", "external", "tool", "measure", "wait")


def kind_and_label(command: Command) -> tuple[str, str]:
    """What a command is (one of `KINDS`), and what a chart writes: the tool action, or the kind."""
    match command:
        case MoveJoint():
            return "joint", "joint"
        case MoveAxes():
            return "joint", "axes"
        case MoveExternal():
            return "external", "external"
        case MoveHome():
            return "home", "home"
        case MoveLinear():
            return "linear", "linear"
        case MoveCircular():
            return "linear", "circular"
        case ToolAction(action=action):
            return "tool", action
        case Measure():
            return "measure", "measure"
        case Wait():
            return "wait", "wait"


def words(command: Command, slides: tuple[bool, ...] = ()) -> str:
    """A command in the units of the scripts."""
    match command:
        case MoveJoint() | MoveLinear() | MoveCircular() | Measure():
            p = command.nominal if isinstance(command, Measure) else command.target
            mm = " ".join(f"{v * 1000:.4f}" for v in (p.x, p.y, p.z))
            deg = " ".join(f"{np.degrees(v):.4f}" for v in (p.rx, p.ry, p.rz))
            frame = "world" if isinstance(command, Measure) else command.frame
            within = "" if frame in ("world", "tool") else f" in {frame}"
            moved = () if isinstance(command, Measure) else command.along
            tcp = "" if isinstance(command, Measure) else command.tcp
            by = f" by {tcp}" if tcp else ""
            elbow = None if isinstance(command, Measure) else command.arm_angle
            arm = "" if elbow is None else f", arm angle {np.degrees(elbow):.4f} deg"
            way = _through(command) if isinstance(command, MoveLinear) else ""
            return f"{kind_and_label(command)[1]} {mm} mm, {deg} deg{way}{within}{by}{_with(moved)}{arm}"
        case MoveAxes(axes=axes):
            shown = " ".join(f"{np.degrees(v):.4f}" for v in axes)
            if any(slides):
                slid = ", ".join(str(i) for i, slid in enumerate(slides, 1) if slid)
                shown += f" (axes {slid}: mm)"
            return f"axes {shown} deg{_with(command.along)}"
        case MoveExternal(along=along):
            return f"external{_with(along)}"
        case MoveHome():
            return "home"
        case ToolAction(action=action):
            return f"tool action {action}"
        case Wait(duration=duration):
            return f"wait {duration} s"


def _through(command: MoveLinear) -> str:
    """The poses on the way, and the zone of their corners."""
    if not command.via:
        return ""
    shown = (
        " ".join(f"{v * 1000:.4f}" for v in (p.x, p.y, p.z))
        + " mm, "
        + " ".join(f"{np.degrees(v):.4f}" for v in (p.rx, p.ry, p.rz))
        + " deg"
        for p in command.via
    )
    return "".join(f" via {x}" for x in shown) + f", blend {command.blend * 1000:.4f} mm"


def _with(along: tuple[Along, ...]) -> str:
    """External axes, in the units of the scripts."""
    shown = (
        f"{a.axis} {a.position * 1000:.4f} mm"
        if a.is_track
        else f"{a.axis} {np.degrees(a.position):.4f} deg"
        for a in along
    )
    text = ", ".join(shown)
    return f" with {text}" if text else ""
