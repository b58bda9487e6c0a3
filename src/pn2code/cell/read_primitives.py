"""`[primitives]` of cell.toml: which functions of the net command robots and devices, and what they do to parts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

from pn2code.cell import codes
from pn2code.cell.config import COMMANDS, CommandName, Primitive
from pn2code.cell.named_elsewhere import along_of, expect_named, fixed_of, table_of
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell_file.primitive import LED, PRIMITIVE
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.commands import CHANGES, EFFECTS, Effect, Handling


def read_primitives(r: Tables, data: dict[str, Any]) -> dict[str, Primitive]:
    """The primitives by the names of their functions; what is wrong with one is reported."""
    out = {}
    for name, at, table in r.named(data, "primitives"):
        given = table.get("command")
        r.keys(table, at, PRIMITIVE.names(given if given in COMMANDS else ""))
        command = r.get(table, at, PRIMITIVE["command"], "")
        if command and command not in COMMANDS:
            r.d.error(
                codes.CELL_VALUE,
                f"unknown robot command `{command}`",
                r.at(*at, "command"),
                hint=did_you_mean(command, COMMANDS, f"known commands: {', '.join(COMMANDS)}"),
            )
        if command not in COMMANDS:
            continue
        own = PRIMITIVE.names(command)
        is_linear = command in LED
        tool = command == "tool"
        frame = _frame(r, data, table, at, command) if "frame" in own else ""
        action = r.get(table, at, PRIMITIVE["action"], "") if tool else ""
        if tool and not action and "action" in table:
            r.d.error(codes.CELL_VALUE, "`action` is empty", r.at(*at, "action"))
        along = tuple(along_of(r, data, table, at, command))
        timed = PRIMITIVE.key("duration_s", command) if "duration_s" in own else None
        out[name] = Primitive(
            name,
            cast(CommandName, command),
            frame or None,
            action,
            r.number(table, at, timed) if timed else 0.0,
            _handling(r, data, table, at) if tool else None,
            _scaled(r, table, at, command, "speed", 1000.0 if is_linear else 100.0),
            _scaled(r, table, at, command, "acceleration", 100.0),
            _scaled(r, table, at, command, "approach", 1000.0) or 0.0,
            _scaled(r, table, at, command, "depart", 1000.0) or 0.0,
            along,
            _tcp(r, data, table, at) if "tcp" in own else "",
            r.number(table, at, PRIMITIVE["arm_angle"])
            if "arm_angle" in own and "arm_angle" in table
            else None,
            fixed_of(r, data, table, at, along) if "to" in own else None,
            *_corners(r, table, at, command),
        )
        _check_approach(r, out[name], at)
    return out


def _frame(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath, command: str
) -> str:
    """The frame of a move: the world, the tool of moves that may be increments, or one that has a name."""
    key = PRIMITIVE.key("frame", command)
    frame = str(r.get(table, at, key, ""))
    own = ("world",) if command == "move_joint" else ("world", "tool")
    frames = table_of(data.get("frames"))
    if frame and frame not in own and (frame == "tool" or frame not in frames):
        r.d.error(
            codes.CELL_VALUE,
            f"`frame` is `{frame}`, but {key.expected} is expected",
            r.at(*at, "frame"),
            hint="a joint move goes to an absolute pose; use `move_linear` for increments"
            if frame == "tool"
            else did_you_mean(frame, (*own, *frames))
            or f"add a table `[frames.{frame}]` (docs/robots.md)",
        )
        return ""
    return "" if command == "move_joint" and frame == "world" else frame


def _tcp(r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath) -> str:
    """A further tool frame of some robot."""
    if "tcp" not in table:
        return ""
    name = str(r.get(table, at, PRIMITIVE["tcp"], ""))
    known = {
        tcp
        for x in table_of(data.get("robots")).values()
        for tcp in table_of(table_of(x).get("tcps"))
    } | {*table_of(data.get("tools"))}
    if name and name not in known:
        r.d.error(
            codes.CELL_VALUE,
            f"no robot has a tool frame or tool `{name}`",
            r.at(*at, "tcp"),
            hint=did_you_mean(name, sorted(known), "")
            or f"add a table `[robots.NAME.tcps.{name}]` or `[tools.{name}]` (docs/robots.md)",
        )
    return name


def _scaled(
    r: Tables, table: dict[str, Any], at: KeyPath, command: str, name: str, factor: float
) -> float | None:
    """A number as in a script: mm/s, mm or percent; None: it is not there."""
    if name not in table or name not in PRIMITIVE.names(command):
        return None
    return r.number(table, at, PRIMITIVE.key(name, command), 0.1) * factor


def _corners(r: Tables, table: dict[str, Any], at: KeyPath, command: str) -> tuple[int, float]:
    """How many poses on the way a linear move has, and the zone of their corners, mm."""
    if "via" not in PRIMITIVE.names(command) or not {"via", "blend"} & table.keys():
        return 0, 0.0
    blend = _scaled(r, table, at, command, "blend", 1000.0)
    if blend is None:
        r.d.error(
            codes.CELL_VALUE,
            "a linear move by way of poses needs a zone in which its corners are rounded",
            r.at(*at, "via"),
            hint="add `blend = 0.02` (m)",
        )
        return 0, 0.0
    for name in ("approach", "track", "turntable"):
        if name in table:
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` does not go with a linear move by way of poses (`blend`)",
                r.at(*at, name),
                hint="make a move of its own of it, before or after",
            )
    return int(r.number(table, at, PRIMITIVE["via"], 1)), blend


def _check_approach(r: Tables, primitive: Primitive, at: KeyPath) -> None:
    """Increments begin where the tool is, so there is no pose to come to."""
    for name in ("approach", "depart"):
        if primitive.frame == "tool" and getattr(primitive, name):
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` goes with an absolute pose, but `frame` is `tool`",
                r.at(*at, name),
                hint=f"remove `{name}`, or make the poses absolute",
            )


def _handling(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath
) -> Handling | None:
    """What an action does to a part: at most one of the effects, of a kind that is there, at a place that is there."""
    given = [effect for effect in EFFECTS if effect in table]
    for effect in given[1:]:
        r.d.error(
            codes.CELL_VALUE,
            f"an action that `{given[0]}` {_what(given[0])} cannot be one that `{effect}` {_what(effect)}, too",
            r.at(*at, effect),
            hint="make two functions of it, which the net calls one after the other",
        )
    is_placed = bool(given) and given[0] in ("creates", "removes")
    place = r.get(table, at, PRIMITIVE["at"], "", required=is_placed)
    if "at" in table and not is_placed:
        r.d.error(
            codes.CELL_KEY,
            "`at` says where a part comes into the cell or leaves it, but the action does neither",
            r.at(*at, "at"),
            hint="a tool takes and releases parts where it is; remove `at`, or add `creates` or `removes`",
        )
    if not given:
        return None
    part = r.get(table, at, PRIMITIVE[given[0]], "")
    whose = "tools" if given[0] in CHANGES else "parts"
    for name, key, section in ((part, given[0], whose), (place, "at", "places")):
        expect_named(r, data, name, (*at, key), section)
    return Handling(given[0], part, place)


def _what(effect: Effect) -> str:
    return "a tool" if effect in CHANGES else "a part"


_NEEDS: dict[Effect, tuple[Effect, str]] = {
    "takes": ("releases", "the tool would hold it for ever, and grip no other one"),
    "releases": ("takes", "so there is none to release"),
}


def check_handling(r: Tables, data: dict[str, Any], primitives: Mapping[str, Primitive]) -> None:
    """Parts that are taken are released, and the other way round; and they come from somewhere."""
    done: dict[str, dict[Effect, str]] = {}
    for name, primitive in primitives.items():
        if primitive.handling:
            done.setdefault(primitive.handling.part, {})[primitive.handling.effect] = name
    for part, by in done.items():
        if not by.keys().isdisjoint(CHANGES):
            continue  # a tool may stay on a robot, or in its rack, for the rest of the run
        for effect, name in by.items():
            other, why = _NEEDS.get(effect, (effect, ""))
            if other not in by:
                r.d.error(
                    codes.CELL_VALUE,
                    f"`{name}` {effect} a part `{part}`, but no primitive {other} one: {why}",
                    r.at("primitives", name, effect),
                    hint=f'add `{other} = "{part}"` to the primitive that does it',
                )
        kind = table_of(table_of(data.get("parts")).get(part))
        if kind and "takes" in by and "creates" not in by and not kind.get("at"):
            r.d.error(
                codes.CELL_VALUE,
                f"`{by['takes']}` takes a part `{part}`, but there is never one in the cell",
                r.at("parts", part),
                hint="add `at = [{ x = .., y = .., z = .. }]` for parts that are there at the start, or a primitive "
                "that creates them",
            )
