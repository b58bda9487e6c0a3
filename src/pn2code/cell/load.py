"""`cell.toml` -> `CellConfig`, or diagnostics.

The geometry (`robots.*.base`, `[motion]`, `[scene]`) is kept raw and validated by `pn2code.robot.scene`, which is the
one who understands it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any, cast

from pn2code.cell import codes
from pn2code.cell.config import (
    COMMANDS,
    CellConfig,
    ChannelConfig,
    CommandName,
    InputConfig,
    Primitive,
    ReportConfig,
    RobotConfig,
    SensorConfig,
    SupervisorConfig,
)
from pn2code.cell.files import check_files, one_name
from pn2code.cell.named_elsewhere import (
    along_of,
    expect_named,
    fixed_of,
    seen_by,
    table_of,
)
from pn2code.cell.partition import ChannelKind
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell.toml_file import Locator, read
from pn2code.cell_file.devices import DEVICE_PLACE
from pn2code.cell_file.geometry import ROBOT
from pn2code.cell_file.keys import Key
from pn2code.cell_file.logic import (
    ACCEPT,
    BOUND,
    CHANNEL,
    DEVICE,
    INPUT,
    LED,
    NET,
    PRIMITIVE,
    REGISTER,
    REPORT,
    SENSOR,
    STORED,
    SUPERVISOR,
    VALUE,
)
from pn2code.cell_file.whole import FILE, LAYOUT, PLACED
from pn2code.diagnostics import Diagnostics, Origin, PlacedText
from pn2code.diagnostics.accepted import Rule
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.commands import CHANGES, EFFECTS, Effect, Handling


def load(path: Path, d: Diagnostics, *, layout: str | None = None) -> CellConfig | None:
    """Reads `cell.toml` (or the one in a folder), applies a layout (default: the first one, if any).

    Returns None when something was reported as an error.
    """
    if path.is_dir():
        path = path / "cell.toml"
    if not path.exists():
        d.error(
            codes.CELL_MISSING,
            f"there is no file `{path}`",
            Origin(str(path)),
            hint="give a folder with a cell.toml, or a .cpn file; docs/cell.md describes cell.toml",
        )
        return None
    before = len(d.errors)
    found = read(
        path,
        d,
        codes.CELL_FILE,
        hint="docs/cell.md shows how the sections and keys of a cell are written",
    )
    if found is None:
        return None
    data, locator = found
    config = _config(path, data, locator, d, layout)
    d.rules = config.accepted
    check_files(config, d)
    return config if len(d.errors) == before else None


def _config(
    path: Path, data: dict[str, Any], locator: Locator, d: Diagnostics, layout: str | None
) -> CellConfig:
    r = Tables(locator, d)
    r.keys(data, (), FILE.names())
    net = r.table(data, "net")
    r.keys(net, ("net",), NET.names())
    net_file = r.get(net, ("net",), NET["file"], "")

    layouts = r.table(data, "layouts")
    chosen, merged = _apply_layout(data, layouts, layout, r)
    config = CellConfig(
        path=path,
        net_file=net_file,
        supervisor=_supervisor(r, data),
        storage=_storage(r, data),
        values=_values(r, data),
        capacity=_capacity(r, data),
        inputs=tuple(_inputs(r, data)),
        channels=tuple(_channels(r, data)),
        primitives=_primitives(r, data),
        robots=tuple(_robots(r, data)),
        devices=tuple(_devices(r, data)),
        sensors=tuple(_sensors(r, data)),
        report=ReportConfig(),
        accepted=tuple(_accepted(r, data)),
        geometry={
            "robots": {
                name: {k: v for k, v in table.items() if k != "instance"}
                for name, table in table_of(merged.get("robots")).items()
                if isinstance(table, dict)
            },
            **{key: merged.get(key, {}) for key in PLACED if key != "robots"},
            "devices": {
                name: {key: table[key] for key in ("base", "axes") if key in table}
                for name, table in table_of(merged.get("devices")).items()
                if isinstance(table, dict) and "axes" in table
            },
            "tools": table_of(data.get("tools")),
            "primitives": table_of(data.get("primitives")),
        },
        layouts={
            name: str(t.get("description", ""))
            for name, t in layouts.items()
            if isinstance(t, dict)
        },
        layout=chosen,
        raw=data,
        locator=locator.in_layout(chosen),
    )
    _check_handling(r, data, config.primitives)
    return replace(config, report=_report(r, data, config))


_SAME_IN_LAYOUTS = {
    "tools": "tools are the same in all layouts; where one lies is the place `rack`, which a layout may say: "
    "`[layouts.NAME.places.RACK]`",
    **{
        key.name: f"what `{key.name}` says is the same in all layouts"
        for key in FILE
        if key.name not in (*LAYOUT.names(), "tools")
    },
}


def _apply_layout(
    data: dict[str, Any], layouts: dict[str, Any], layout: str | None, r: Tables
) -> tuple[str, dict[str, Any]]:
    if layout is None:
        layout = next(iter(layouts), "")
    for name, table in layouts.items():
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"layout `{name}` must be a table", r.at("layouts", name))
            return "", data
        at: KeyPath = ("layouts", name)
        r.keys(table, at, LAYOUT.names(), _SAME_IN_LAYOUTS)
        r.get(table, at, LAYOUT["description"])
        known = table_of(data.get("robots"))
        for key in (*PLACED, "devices"):
            r.get(table, at, replace(LAYOUT[key], expected="a table"))
        _check_frames(data, layouts, name, r)
        _check_devices(data, table, at, r)
        robots = table_of(table.get("robots"))
        for robot in robots:
            one = Key(robot, "table", "", "a table", inner=LAYOUT["robots"].inner)
            changed = r.get(robots, (*at, "robots"), one, {})
            if robot not in known:
                r.d.error(
                    codes.CELL_KEY,
                    f"layout `{name}` places an unknown robot `{robot}`",
                    r.at(*at, "robots", robot),
                    hint=did_you_mean(robot, known),
                )
            elif "instance" in changed:
                r.d.error(
                    codes.CELL_KEY,
                    f"unknown key `instance` in `{'.'.join((*map(str, at), 'robots', robot))}`",
                    r.at(*at, "robots", robot, "instance"),
                    hint="a layout says where a robot stands; its page is the same in all layouts",
                )
    if not layout:
        return "", data
    if layout not in layouts:
        r.d.error(
            codes.CELL_UNKNOWN_LAYOUT,
            f"there is no layout `{layout}`",
            r.at("layouts"),
            hint=did_you_mean(layout, layouts) or f"known layouts: {', '.join(layouts) or 'none'}",
        )
        return "", data
    table = {k: v for k, v in layouts[layout].items() if k != "description"}
    return layout, _merge(data, table)


def _check_devices(data: dict[str, Any], layout: dict[str, Any], at: KeyPath, r: Tables) -> None:
    """A layout says where devices stand of which something moves; all others are nowhere."""
    moving = {n: t for n, t in table_of(data.get("devices")).items() if "axes" in table_of(t)}
    devices = table_of(layout.get("devices"))
    for device in devices:
        own: KeyPath = (*at, "devices", device)
        one = Key(device, "table", "", "a table", inner=DEVICE_PLACE)
        changed = r.get(devices, (*at, "devices"), one, {})
        if device not in moving:
            r.d.error(
                codes.CELL_KEY,
                f"layout `{at[-1]}` places an unknown device `{device}`",
                r.at(*own),
                hint=did_you_mean(device, moving) or "only devices with `axes` stand anywhere",
            )
        else:
            r.keys(table_of(changed), own, DEVICE_PLACE.names())


def _check_frames(data: dict[str, Any], layouts: dict[str, Any], name: str, r: Tables) -> None:
    """A layout changes frames of the cell; where the cell has none of its own, each is in all layouts.

    Otherwise its name is a mistake, and the frame that was meant would stay where it is.
    """
    known = table_of(data.get("frames"))
    others = [known] if known else [table_of(table_of(t).get("frames")) for t in layouts.values()]
    for frame in table_of(layouts[name].get("frames")):
        if not all(frame in other for other in others):
            r.d.error(
                codes.CELL_KEY,
                f"layout `{name}` places an unknown frame `{frame}`",
                r.at("layouts", name, "frames", frame),
                hint=did_you_mean(frame, known) or f"add a table `[frames.{frame}]`",
            )


def _merge(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    out = dict(base)
    for key, value in over.items():
        old = out.get(key)
        out[key] = (
            _merge(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
        )
    return out


def _supervisor(r: Tables, data: dict[str, Any]) -> SupervisorConfig:
    at: KeyPath = ("supervisor",)
    table = r.table(data, "supervisor")
    r.keys(table, at, SUPERVISOR.names())
    final = r.texts(table, at, SUPERVISOR["final"])
    timeout = r.number(table, at, SUPERVISOR["reply_timeout_s"])
    order = r.choice(table, at, SUPERVISOR["order"])
    return SupervisorConfig(
        instance=r.get(table, at, SUPERVISOR["instance"], ""),
        final=tuple(name for name, _ in final),
        reply_timeout_s=timeout,
        origin=r.at("supervisor", "instance"),
        final_origins=tuple(origin for _, origin in final),
        order_decides=order == "documented",
    )


def _storage(r: Tables, data: dict[str, Any]) -> dict[str, str]:
    out = {}
    for name, kind in r.table(data, "storage").items():
        if kind not in STORED.words:
            r.d.error(
                codes.CELL_VALUE,
                f"storage of `{name}` is `{kind}`, but {' or '.join(f'`{x}`' for x in STORED.words)} is expected",
                r.at("storage", name),
            )
        elif kind != STORED.default:
            out[name] = kind
    return out


def _values(r: Tables, data: dict[str, Any]) -> dict[str, str]:
    out: dict[str, str] = {}
    for name, value in r.table(data, "values").items():
        text = ml_literal(value)
        if text is None:
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` is `{value}`, but {VALUE.expected} is expected",
                r.at("values", name),
            )
        else:
            out[name] = PlacedText(text, r.at("values", name))
    return out


def ml_literal(value: object) -> str | None:
    """A TOML scalar as CPN ML text; None for what has no such form."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value).replace("-", "~").replace("e+", "e")
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    return None


def _capacity(r: Tables, data: dict[str, Any]) -> dict[str, int]:
    out = {}
    for name, bound in r.table(data, "capacity").items():
        if not isinstance(bound, int) or isinstance(bound, bool) or not BOUND.within(bound):
            r.d.error(
                codes.CELL_VALUE,
                f"capacity of `{name}` is `{bound}`, but {BOUND.expected} is expected",
                r.at("capacity", name),
            )
        else:
            out[name] = bound
    return out


def _inputs(r: Tables, data: dict[str, Any]) -> Iterable[InputConfig]:
    files: dict[str, tuple[str, str]] = {}
    for i, table in enumerate(r.tables(data, "input")):
        at: KeyPath = ("input", i)
        r.keys(table, at, INPUT.names())
        place = r.get(table, at, INPUT["place"], "")
        file = r.file_name(table, at, INPUT["file"])
        _once(r, files, file, place, at, "inputs")
        yield InputConfig(place, file, r.at(*at, "place"))


def _accepted(r: Tables, data: dict[str, Any]) -> Iterable[Rule]:
    for i, table in enumerate(r.tables(data, "accept")):
        at: KeyPath = ("accept", i)
        r.keys(table, at, ACCEPT.names())
        code, reason = (r.get(table, at, ACCEPT[key], "") for key in ("warning", "reason"))
        names = tuple(name for name, _ in r.texts(table, at, ACCEPT["elements"]))
        if "reason" in table and not reason.strip():
            r.d.error(
                codes.CELL_VALUE,
                "an accepted warning needs a reason: what you have found when you looked at it",
                r.at(*at, "reason"),
            )
        yield Rule(code, names, reason, r.at(*at, "warning"))


def _once(
    r: Tables, files: dict[str, tuple[str, str]], file: str, place: str, at: KeyPath, what: str
) -> None:
    """Each file is used once; names differ before the ending, and not in upper and lower case alone.

    `files`: file and place of those before, by the part of the name that must differ.
    """
    stem = PurePath(file).stem
    key = one_name(stem)
    hint = "give each a file of its own, whose name differs before the dot in more than case"
    if stem and key in files:
        other, its_place = files[key]
        if place == its_place and other != file:
            text = f"place `{place}` is listed twice among the {what}, with the files `{other}` and `{file}`"
            hint = "keep one of the two tables: a place has one file"
        elif other == file:
            text = f"file `{file}` is used by two {what}, `{its_place}` and `{place}`"
        elif PurePath(other).stem == stem:
            text = (
                f"the files `{other}` and `{file}` of the {what} `{its_place}` and `{place}` "
                "differ only in the ending"
            )
        else:
            text = (
                f"the files `{other}` and `{file}` of the {what} `{its_place}` and `{place}` differ only in upper and "
                "lower case, so they are one file on many file systems"
            )
        r.d.error(
            codes.CELL_VALUE,
            text,
            r.at(*at, "file"),
            hint=hint,
        )
    files.setdefault(key, (file, place))


def _channels(r: Tables, data: dict[str, Any]) -> Iterable[ChannelConfig]:
    files: dict[str, tuple[str, str]] = {}
    for i, table in enumerate(r.tables(data, "channel")):
        at: KeyPath = ("channel", i)
        r.keys(table, at, CHANNEL.names())
        place = r.get(table, at, CHANNEL["place"], "")
        file = r.file_name(table, at, CHANNEL["file"])
        kind = r.choice(table, at, CHANNEL["kind"], "flag")
        _once(r, files, file, place, at, "channels")
        yield ChannelConfig(
            place,
            file,
            ChannelKind.DATA if kind == REGISTER else ChannelKind(kind),
            r.at(*at, "place"),
            is_kind_given="kind" in table,
            is_register=kind == REGISTER,
        )


def _primitives(r: Tables, data: dict[str, Any]) -> dict[str, Primitive]:
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


def _check_handling(r: Tables, data: dict[str, Any], primitives: Mapping[str, Primitive]) -> None:
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


def _robots(r: Tables, data: dict[str, Any]) -> Iterable[RobotConfig]:
    for name, at, table in r.named(data, "robots"):
        _name(r, name, at, "a robot name")
        if "instance" not in table:  # else `robot.scene` reports unknown keys
            r.keys(table, at, ROBOT.names())
        instance = r.get(table, at, ROBOT["instance"], "")
        yield RobotConfig(name, instance, r.at(*at, "instance"))


_TAKEN = ("supervisor", "scene", "self", "floor")
"""What is called so already: a side of channels, and with what an arm is compared."""


def _name(r: Tables, name: str, at: KeyPath, what: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or name in _TAKEN:
        r.d.error(
            codes.CELL_VALUE,
            f"`{name}` is not {what}",
            r.at(*at),
            hint="a letter, then letters, digits and `_`; not `supervisor`, `scene`, `self` or `floor`",
        )


def _devices(r: Tables, data: dict[str, Any]) -> Iterable[RobotConfig]:
    for name, at, table in r.named(data, "devices"):
        r.keys(table, at, DEVICE.names())
        _name(r, name, at, "a device name")
        if name in table_of(data.get("robots")):
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` is a robot and a device",
                r.at(*at),
                hint="give the device another name",
            )
        if "base" in table and "axes" not in table:
            r.d.error(
                codes.CELL_KEY,
                f"device `{name}` has a `base`, but nothing of it moves: it stands nowhere",
                r.at(*at, "base"),
                hint="remove it, or say what moves (`[devices.NAME.axes.AXIS]`)",
            )
        instance = r.get(table, at, DEVICE["instance"], "")
        yield RobotConfig(name, instance, r.at(*at, "instance"))


def _sensors(r: Tables, data: dict[str, Any]) -> Iterable[SensorConfig]:
    variables: dict[str, str] = {}
    for name, at, table in r.named(data, "sensors"):
        r.keys(table, at, SENSOR.names())
        _name(r, name, at, "a sensor name")
        variable = r.get(table, at, SENSOR["variable"], name)
        if variable in variables:
            r.d.error(
                codes.CELL_VALUE,
                f"variable `{variable}` is decided by two sensors, `{variables[variable]}` and `{name}`",
                r.at(*at),
                hint="remove one of them",
            )
        variables.setdefault(variable, name)
        file = r.file_name(table, at, SENSOR["file"]) if "file" in table else ""
        default = table.get("default")
        if default is not None and not isinstance(default, str | int | float):
            r.d.error(
                codes.CELL_VALUE,
                f"`default` is `{default}`, but {SENSOR['default'].expected} is expected",
                r.at(*at, "default"),
            )
            default = None
        seed = r.get(table, at, SENSOR["seed"])
        sees, part, where = seen_by(r, data, table, at)
        says = r.get(table, at, SENSOR["says"])
        yield SensorConfig(name, variable, file, default, seed, r.at(*at), sees, part, says, where)


def _report(r: Tables, data: dict[str, Any], config: CellConfig) -> ReportConfig:
    table = r.table(data, "report")
    at: KeyPath = ("report",)
    r.keys(table, at, REPORT.names())
    rows = tuple(name for name, _ in r.texts(table, at, REPORT["rows"]))
    known = [c.place for c in config.channels if not c.is_register]
    for name in rows:
        if name not in known:
            r.d.error(
                codes.CELL_VALUE,
                f"`rows` names `{name}`, which is not a channel",
                r.at("report", "rows"),
                hint=did_you_mean(name, known),
            )
    count = r.get(table, at, REPORT["count"], {})
    actions = [p.action for p in config.primitives.values() if p.command == "tool"]
    for label, action in count.items():
        if action not in actions:
            r.d.error(
                codes.CELL_VALUE,
                f"`count.{label}` names `{action}`, which is not a tool action",
                r.at("report", "count"),
                hint=did_you_mean(str(action), actions),
            )
    occurrences = r.get(table, at, REPORT["occurrences"], {})
    for label, transition in occurrences.items():
        if not isinstance(transition, str):
            r.d.error(
                codes.CELL_VALUE,
                f"`occurrences.{label}` is `{transition}`, but a transition is expected",
                r.at("report", "occurrences", label),
            )
    said = r.texts(table, at, REPORT["failed"])
    failed = [(name, origin) for name, origin in said if not name.lstrip().startswith("{")]
    return ReportConfig(
        rows,
        tuple((str(k), str(v)) for k, v in count.items()),
        tuple((str(k), str(v)) for k, v in occurrences.items()),
        r.number(table, at, REPORT["warn_condition"]),
        tuple(name for name, _ in failed),
        tuple(origin for _, origin in failed),
        tuple(x for x in said if x not in failed),
    )
