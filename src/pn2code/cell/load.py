"""`cell.toml` -> `CellConfig`, or diagnostics.

The geometry (`robots.*.base`, `[motion]`, `[scene]`) is kept raw and validated by `pn2code.robot.scene`, which is the
one who understands it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
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
from pn2code.cell.partition import ChannelKind
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell.toml_file import Locator, read
from pn2code.cell_file.geometry import ROBOT
from pn2code.cell_file.keys import Key
from pn2code.cell_file.logic import (
    BOUND,
    CHANNEL,
    DEVICE,
    INPUT,
    LED,
    NET,
    PRIMITIVE,
    REPORT,
    SENSOR,
    STORED,
    SUPERVISOR,
    VALUE,
)
from pn2code.cell_file.whole import FILE, LAYOUT, PLACED
from pn2code.diagnostics import Diagnostics, Origin, PlacedText
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.commands import EFFECTS, Effect, Handling

AlongAxes = tuple[tuple[str, bool], ...]
"""External axes of a move, each with whether it slides."""


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
        geometry={
            "robots": {
                name: {k: v for k, v in table.items() if k != "instance"}
                for name, table in _table(merged.get("robots")).items()
                if isinstance(table, dict)
            },
            **{key: merged.get(key, {}) for key in PLACED if key != "robots"},
            "devices": {
                name: {"axes": table["axes"]}
                for name, table in _table(data.get("devices")).items()
                if isinstance(table, dict) and "axes" in table
            },
            "primitives": _table(data.get("primitives")),
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
        r.keys(table, at, LAYOUT.names())
        r.get(table, at, LAYOUT["description"])
        known = _table(data.get("robots"))
        for key in PLACED:
            r.get(table, at, replace(LAYOUT[key], expected="a table"))
        _check_frames(data, layouts, name, r)
        robots = _table(table.get("robots"))
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


def _check_frames(data: dict[str, Any], layouts: dict[str, Any], name: str, r: Tables) -> None:
    """A layout changes frames of the cell; where the cell has none of its own, each is in all layouts.

    Otherwise its name is a mistake, and the frame that was meant would stay where it is.
    """
    known = _table(data.get("frames"))
    others = [known] if known else [_table(_table(t).get("frames")) for t in layouts.values()]
    for frame in _table(layouts[name].get("frames")):
        if not all(frame in other for other in others):
            r.d.error(
                codes.CELL_KEY,
                f"layout `{name}` places an unknown frame `{frame}`",
                r.at("layouts", name, "frames", frame),
                hint=did_you_mean(frame, known) or f"add a table `[frames.{frame}]`",
            )


def _table(value: object) -> dict[str, Any]:
    """A table; empty where something else stands, which is reported elsewhere."""
    return value if isinstance(value, dict) else {}


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
            place, file, ChannelKind(kind), r.at(*at, "place"), is_kind_given="kind" in table
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
        along = tuple(_along(r, data, table, at, command))
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
            _fixed(r, data, table, at, along) if "to" in own else None,
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
    frames = _table(data.get("frames"))
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
        tcp for x in _table(data.get("robots")).values() for tcp in _table(_table(x).get("tcps"))
    }
    if name and name not in known:
        r.d.error(
            codes.CELL_VALUE,
            f"no robot has a tool frame `{name}`",
            r.at(*at, "tcp"),
            hint=did_you_mean(name, sorted(known), "")
            or f"add a table `[robots.NAME.tcps.{name}]` (docs/robots.md)",
        )
    return name


def _along(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath, command: str
) -> Iterator[tuple[str, bool]]:
    """External axes that move as well, each of the kind that its key says, of some robot."""
    if command == "move_external" and not ({"track", "turntable", "axis"} & table.keys()):
        r.d.error(
            codes.CELL_KEY,
            f"`primitives.{at[1]}` names no external axis",
            r.at(*at),
            hint='add `track = "..."` or `turntable = "..."`, the name of an axis of `[robots.NAME.axes]`, or `axis = '
            '"..."`, also of `[devices.NAME.axes]`',
        )
    for kind in ("track", "turntable"):
        if kind not in table or kind not in PRIMITIVE.names(command):
            continue
        name = r.get(table, at, PRIMITIVE.key(kind, command), "")
        robots = [_table(x) for x in _table(data.get("robots")).values()]
        known = {
            axis: _table(x).get("kind", "track")
            for robot in robots
            for axis, x in _table(robot.get("axes")).items()
        }
        own = [axis for axis, x in known.items() if x == kind]
        if name and name not in own:
            r.d.error(
                codes.CELL_VALUE,
                f"no robot has a {kind} `{name}`",
                r.at(*at, kind),
                hint=did_you_mean(name, own, "")
                or f"add a table `[robots.NAME.axes.{name}]` (docs/robots.md)",
            )
        yield name, kind == "track"
    if command == "move_external" and "axis" in table:
        name = r.get(table, at, PRIMITIVE["axis"], "")
        kinds = [(axis, x) for owner in axes_of_all(data).values() for axis, x in owner.items()]
        sliding = {x not in TURNING for axis, x in kinds if axis == name}
        if name and not sliding:
            r.d.error(
                codes.CELL_VALUE,
                f"no robot or device has an axis `{name}`",
                r.at(*at, "axis"),
                hint=did_you_mean(name, [axis for axis, _ in kinds], "")
                or f"add a table `[devices.NAME.axes.{name}]` (docs/robots.md)",
            )
        elif len(sliding) > 1:
            r.d.error(
                codes.CELL_VALUE,
                f"one axis `{name}` slides and another one turns, so that its position is mm and degrees",
                r.at(*at, "axis"),
                hint="give one of them another name",
            )
        yield name, sliding != {False}


TURNING = ("turntable", "swing")
"""Kinds of axes that turn; all others slide."""


def axes_of_all(data: dict[str, Any]) -> dict[str, dict[str, str]]:
    """Of each robot and device its external axes, each with its kind; what is wrong with them is reported elsewhere."""
    out: dict[str, dict[str, str]] = {}
    for section, default in (("robots", "track"), ("devices", "slide")):
        for owner, table in _table(data.get(section)).items():
            axes = _table(_table(table).get("axes"))
            out[owner] = {a: str(_table(x).get("kind", default)) for a, x in axes.items()}
    return out


def _fixed(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath, along: AlongAxes
) -> float | None:
    """Where the only axis of a move goes that the function does not say, in mm or degrees."""
    if "to" not in table:
        return None
    to = r.number(table, at, PRIMITIVE["to"], 0.0)
    if len(along) != 1:
        r.d.error(
            codes.CELL_VALUE,
            f"`to` is where one axis goes, and there are {len(along)}",
            r.at(*at, "to"),
            hint="make an entry for each of them, or let the function take the positions",
        )
        return None
    axis, slides = along[0]
    for section in ("robots", "devices"):
        for table_ in _table(data.get(section)).values():
            own = _table(_table(_table(table_).get("axes")).get(axis))
            said = {"from": 0.0, "to": own.get("length")} if own.get("kind") == "belt" else own
            ends = [x for key in ("from", "to") if isinstance(x := said.get(key), int | float)]
            if len(ends) < 2:
                continue  # that is reported elsewhere
            low, high = ends
            if not low <= to <= high:
                r.d.error(
                    codes.CELL_VALUE,
                    f"`to` is {to:g}, but axis `{axis}` goes from {low:g} to {high:g}",
                    r.at(*at, "to"),
                    hint="a position in m, or in degrees of what turns",
                )
                return None
    return to * 1000.0 if slides else to


def _scaled(
    r: Tables, table: dict[str, Any], at: KeyPath, command: str, name: str, factor: float
) -> float | None:
    """A number as in a script: mm/s, mm or percent; None: it is not there."""
    if name not in table or name not in PRIMITIVE.names(command):
        return None
    return r.number(table, at, PRIMITIVE.key(name, command), 0.1) * factor


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
            f"an action that `{given[0]}` a part cannot be one that `{effect}` a part, too",
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
    for name, key, section in ((part, given[0], "parts"), (place, "at", "places")):
        _expect_named(r, data, name, (*at, key), section)
    return Handling(given[0], part, place)


def _expect_named(r: Tables, data: dict[str, Any], name: str, at: KeyPath, section: str) -> None:
    """What a key names is there."""
    known = _table(data.get(section))
    if name and name not in known:
        r.d.error(
            codes.CELL_VALUE,
            f"`{at[-1]}` names `{name}`, but there is no `[{section}.{name}]`",
            r.at(*at),
            hint=did_you_mean(name, known) or f"add a table `[{section}.{name}]` (docs/robots.md)",
        )


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
        for effect, name in by.items():
            other, why = _NEEDS.get(effect, (effect, ""))
            if other not in by:
                r.d.error(
                    codes.CELL_VALUE,
                    f"`{name}` {effect} a part `{part}`, but no primitive {other} one: {why}",
                    r.at("primitives", name, effect),
                    hint=f'add `{other} = "{part}"` to the primitive that does it',
                )
        kind = _table(_table(data.get("parts")).get(part))
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


def _name(r: Tables, name: str, at: KeyPath, what: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or name == "supervisor":
        r.d.error(
            codes.CELL_VALUE,
            f"`{name}` is not {what}",
            r.at(*at),
            hint="a letter, then letters, digits and `_`; not `supervisor`",
        )


def _devices(r: Tables, data: dict[str, Any]) -> Iterable[RobotConfig]:
    for name, at, table in r.named(data, "devices"):
        r.keys(table, at, DEVICE.names())
        _name(r, name, at, "a device name")
        if name in _table(data.get("robots")):
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` is a robot and a device",
                r.at(*at),
                hint="give the device another name",
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
        sees, part, where = _seen(r, data, table, at)
        says = r.get(table, at, SENSOR["says"])
        yield SensorConfig(name, variable, file, default, seed, r.at(*at), sees, part, says, where)


def _seen(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath
) -> tuple[str, str, float]:
    """The place, zone or axis at which a sensor looks; for which kind of parts; at which position of the axis."""
    sees, part = (r.get(table, at, SENSOR[key], "") for key in ("sees", "part"))
    where = r.number(table, at, SENSOR["at"], 0.0) if "at" in table else 0.0
    _expect_named(r, data, part, (*at, "part"), "parts")
    device, dot, axis = sees.partition(".")
    # How far a belt has run says nothing of where it is.
    is_axis = bool(dot) and axes_of_all(data).get(device, {}).get(axis, "belt") != "belt"
    zones = _table(_layered(data, "zones"))
    if dot and not is_axis:
        known = [f"{x}.{a}" for x in _table(data.get("devices")) for a in axes_of_all(data)[x]]
        r.d.error(
            codes.CELL_VALUE,
            f"`sees` names `{sees}`, but no device has such an axis",
            r.at(*at, "sees"),
            hint=did_you_mean(sees, known) or "give DEVICE.AXIS, of `[devices.DEVICE.axes.AXIS]`",
        )
    elif not dot and sees not in zones:
        _expect_named(r, data, sees, (*at, "sees"), "places")
    elif sees in zones and sees in _table(_layered(data, "places")):
        r.d.error(
            codes.CELL_VALUE,
            f"`sees` names `{sees}`, which is a place and a zone",
            r.at(*at, "sees"),
            hint="give one of them another name",
        )
    if is_axis is not ("at" in table) and not (dot and not is_axis):
        r.d.error(
            codes.CELL_KEY,
            f"`sees` names axis `{sees}`, but not at which position it is seen"
            if is_axis
            else "`at` says where an axis is seen, but `sees` names none",
            r.at(*at),
            hint="add `at`, in m, or in degrees of what turns"
            if is_axis
            else "remove `at`, or let `sees` name an axis, DEVICE.AXIS",
        )
    if part and (is_axis or sees in zones):
        r.d.error(
            codes.CELL_KEY,
            f"`part` says which kind of parts the sensor sees, but `{sees}` is no place",
            r.at(*at, "part"),
            hint="remove it",
        )
    if part and not sees:
        r.d.error(
            codes.CELL_KEY,
            "`part` says which kind of parts the sensor sees, but not where",
            r.at(*at, "part"),
            hint="add `sees` with the name of a place",
        )
    return sees, part, where


def _layered(data: dict[str, Any], section: str) -> dict[str, Any]:
    """The tables of a section, in the cell and in its layouts."""
    out = dict(_table(data.get(section)))
    for layout in _table(data.get("layouts")).values():
        out |= _table(_table(layout).get(section))
    return out


def _report(r: Tables, data: dict[str, Any], config: CellConfig) -> ReportConfig:
    table = r.table(data, "report")
    at: KeyPath = ("report",)
    r.keys(table, at, REPORT.names())
    rows = tuple(name for name, _ in r.texts(table, at, REPORT["rows"]))
    known = [c.place for c in config.channels]
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
    return ReportConfig(
        rows,
        tuple((str(k), str(v)) for k, v in count.items()),
        tuple((str(k), str(v)) for k, v in occurrences.items()),
        r.number(table, at, REPORT["warn_condition"]),
    )
