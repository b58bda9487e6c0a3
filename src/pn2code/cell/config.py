"""`cell.toml`: who runs which page, what is exchanged through which file, which robots stand where.

`load` gives a `CellConfig` or diagnostics; the geometry (`robots.*.base`, `[motion]`, `[scene]`) is
kept raw and validated by
`pn2code.robot.scene`, which is the one who understands it.
"""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from copy import copy
from dataclasses import field, replace
from pathlib import Path
from typing import Any, Literal, cast

from pn2code.cell import codes
from pn2code.cell.partition import ChannelKind
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.near import did_you_mean
from pn2code.frozen import frozen

CommandName = Literal["move_joint", "move_linear", "move_home", "measure", "tool", "wait"]
COMMANDS: tuple[CommandName, ...] = (
    "move_joint",
    "move_linear",
    "move_home",
    "measure",
    "tool",
    "wait",
)


@frozen
class Primitive:
    """A function of the net that is a command of the robots.

    Args:
        function: its name in the net.
        command: what the robot does.
        frame: of move_linear: "world" (absolute) or "tool" (incremental).
        action: of tool: its name.
        duration_s: of tool: seconds.
    """

    function: str
    command: CommandName
    frame: Literal["world", "tool"] = "world"
    action: str = ""
    duration_s: float = 0.0


@frozen
class ChannelConfig:
    """A `[[channel]]` entry."""

    place: str
    file: str
    kind: ChannelKind
    origin: Origin


@frozen
class InputConfig:
    """An `[[input]]` entry."""

    place: str
    file: str
    origin: Origin


@frozen
class SensorConfig:
    """A `[sensors.NAME]` table: who decides what the net leaves open.

    Args:
        variable: the net variable that it decides, wherever nothing in the net does.
        file: in a run: what it says, one value a line, over and over; "": drawn at random.
        seed: of what is drawn at random.
    """

    name: str
    variable: str
    file: str
    seed: int
    origin: Origin


@frozen
class RobotConfig:
    """A robot or device: which page instance is its program; a robot's geometry stays in `CellConfig.geometry`."""

    name: str
    instance: str
    origin: Origin


@frozen
class SupervisorConfig:
    """The supervisor: its page instance, the places that end the run, and its patience."""

    instance: str
    final: tuple[str, ...]
    reply_timeout_s: float
    origin: Origin
    order_decides: bool = False
    """`order = "documented"`: where the order of firing matters, the documented one is meant"""


@frozen
class ReportConfig:
    """What the summary of a run contains.

    Args:
        rows: channel names whose k-th messages stand side by side in row k of rows.tsv.
        count: label -> tool action that is counted.
        occurrences: label -> transition that is counted: its name, or as much of its path as wanted.
        warn_condition: condition numbers above this are reported as close to a singularity.
    """

    rows: tuple[str, ...] = ()
    count: tuple[tuple[str, str], ...] = ()
    occurrences: tuple[tuple[str, str], ...] = ()
    warn_condition: float = 50.0


@frozen
class CellConfig:
    """A whole `cell.toml`, one layout applied.

    Args:
        path: the file; folder: where its other files are.
        geometry: the raw sections `robots`, `motion`, `scene`, layout applied.
        layouts: name -> description.
        layout: the one applied, or "".
        storage: colour set -> storage ("float32").
        values: val of the net -> CPN ML text that replaces it.
        capacity: place -> most tokens (declared bounds).
    """

    path: Path
    folder: Path
    net_file: str
    supervisor: SupervisorConfig
    storage: dict[str, str]
    values: dict[str, str]
    capacity: dict[str, int]
    inputs: tuple[InputConfig, ...]
    channels: tuple[ChannelConfig, ...]
    primitives: dict[str, Primitive]
    robots: tuple[RobotConfig, ...]
    devices: tuple[RobotConfig, ...]
    sensors: tuple[SensorConfig, ...]
    report: ReportConfig
    geometry: dict[str, Any]
    layouts: dict[str, str]
    layout: str = ""
    raw: dict[str, Any] = field(default_factory=dict, repr=False)
    locator: Locator | None = field(default=None, repr=False, compare=False)

    @property
    def programs(self) -> tuple[RobotConfig, ...]:
        """Whoever runs a script: the robots, then the devices."""
        return (*self.robots, *self.devices)

    @property
    def net_path(self) -> Path:
        """Where the net is."""
        return self.folder / self.net_file

    def logic_digest(self) -> str:
        """SHA-256 of what this file contributes to the generated programs (geometry does not)."""
        robots = {
            name: {"instance": table.get("instance")} for name, table in self.raw["robots"].items()
        }
        logic = {
            key: self.raw.get(key)
            for key in (
                "supervisor",
                "storage",
                "values",
                "capacity",
                "input",
                "channel",
                "primitives",
            )
        }
        logic["robots"] = robots
        if self.devices:
            logic["devices"] = self.raw["devices"]
        if self.sensors:
            logic["sensors"] = {s.name: s.variable for s in self.sensors}
        text = json.dumps(logic, sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()


class Locator:
    """Finds the line of a key in the text of a TOML file (the standard parser keeps no positions)."""

    def __init__(self, file: str, text: str) -> None:
        self._file = file
        self._layout = ""
        self._lines: dict[tuple[str, ...], int] = {}
        table: tuple[str, ...] = ()
        counts: dict[tuple[str, ...], int] = {}
        for number, line in enumerate(text.splitlines(), 1):
            if head := re.match(r"\s*\[\[([^\]]+)\]\]", line):
                base = tuple(_key_parts(head[1]))
                index = counts.get(base, 0)
                counts[base] = index + 1
                table = (*base, str(index))
            elif head := re.match(r"\s*\[([^\]]+)\]", line):
                table = tuple(_key_parts(head[1]))
            elif head := re.match(r"\s*([A-Za-z0-9_.\"'-]+)\s*=", line):
                key = (*table, *_key_parts(head[1]))
                self._lines.setdefault(key, number)
                continue
            else:
                continue
            for depth in range(1, len(table) + 1):  # `[robots.robot1]` also begins `robots`
                self._lines.setdefault(table[:depth], number)

    def in_layout(self, layout: str) -> Locator:
        """The same file, where a layout replaces some keys."""
        other = copy(self)
        other._layout = layout
        return other

    def origin(self, *path: str | int) -> Origin:
        """Origin of a key, or of the nearest table around it; of a layout's key where that replaces it."""
        key = tuple(map(str, path))
        over = self._nearest(("layouts", self._layout, *key)) if self._layout else ()
        found = self._nearest(key)
        if len(over) > 2 and len(over) - 2 >= len(found):
            found, key = over, ("layouts", self._layout, *key)
        return Origin(
            self._file, self._lines.get(found, 0), part=f"key `{'.'.join(key)}`" if key else ""
        )

    def _nearest(self, key: tuple[str, ...]) -> tuple[str, ...]:
        while key and key not in self._lines:
            key = key[:-1]
        return key


def _key_parts(text: str) -> Iterable[str]:
    return (p.strip().strip("\"'") for p in text.strip().split("."))


class _Reader:
    """Typed access to the tables, reporting what is wrong."""

    def __init__(self, locator: Locator, d: Diagnostics) -> None:
        self.at = locator.origin
        self.d = d

    def keys(self, table: Mapping[str, Any], path: tuple[str | int, ...], known: set[str]) -> None:
        for key in table:
            if key not in known:
                self.d.error(
                    codes.CELL_KEY,
                    f"unknown key `{key}`" + (f" in `{'.'.join(map(str, path))}`" if path else ""),
                    self.at(*path, key),
                    hint=did_you_mean(key, known) or f"known keys: {', '.join(sorted(known))}",
                )

    def get(
        self,
        table: Mapping[str, Any],
        path: tuple[str | int, ...],
        key: str,
        kind: type | tuple[type, ...],
        words: str,
        default: Any = None,
        *,
        required: bool = False,
    ) -> Any:
        if key not in table:
            if required:
                self.d.error(
                    codes.CELL_KEY,
                    f"`{'.'.join(map(str, (*path, key)))}` is missing",
                    self.at(*path),
                    hint=f"add `{key} = ...`: {words}",
                )
            return default
        value = table[key]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            self.d.error(
                codes.CELL_VALUE,
                f"`{key}` is `{value}`, but {words} is expected",
                self.at(*path, key),
            )
            return default
        return value

    def table(self, data: Mapping[str, Any], key: str, *, required: bool = False) -> dict[str, Any]:
        found = self.get(data, (), key, dict, "a table", {}, required=required)
        return cast(dict[str, Any], found)

    def tables(self, data: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
        found = self.get(data, (), key, list, f"an array of tables `[[{key}]]`", [])
        good = [t for t in found if isinstance(t, dict)]
        if len(good) != len(found):
            self.d.error(
                codes.CELL_VALUE, f"`{key}` must be an array of tables `[[{key}]]`", self.at(key)
            )
        return good

    def file_name(self, table: Mapping[str, Any], path: tuple[str | int, ...]) -> str:
        name = self.get(table, path, "file", str, "a file name", "", required=True)
        if name and (Path(name).name != name or name.startswith(".") or name.endswith(".tmp")):
            self.d.error(
                codes.CELL_VALUE,
                f"`{name}` is not a plain file name",
                self.at(*path, "file"),
                hint="files lie directly in the shared directory: give a name without `/` and "
                "without a leading dot",
            )
        return str(name)


_TOP = {
    "net",
    "supervisor",
    "storage",
    "values",
    "capacity",
    "input",
    "channel",
    "primitives",
    "robots",
    "devices",
    "sensors",
    "motion",
    "scene",
    "report",
    "layouts",
    "property",
}


def load(path: Path, d: Diagnostics, *, layout: str | None = None) -> CellConfig | None:
    """Reads `cell.toml` (or the one in a folder), applies a layout (default: the first one, if any).

    Returns None when something was reported as an error.
    """
    if path.is_dir():
        path = path / "cell.toml"
    file = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        d.error(
            codes.CELL_MISSING,
            f"there is no file `{file}`",
            Origin(file),
            hint="give a folder with a cell.toml, or a .cpn file; docs/cell.md describes cell.toml",
        )
        return None
    except (OSError, UnicodeDecodeError) as problem:
        reason = getattr(problem, "strerror", None) or "not UTF-8 text"
        d.error(
            codes.CELL_FILE,
            f"cannot read `{file}`: {reason[:1].lower()}{reason[1:]}",
            Origin(file),
            hint="save it as a text file in UTF-8 that may be read",
        )
        return None
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as problem:
        found = re.search(r"\(at line (\d+), column (\d+)\)", str(problem))
        line, column = (int(found[1]), int(found[2])) if found else (text.count("\n") + 1, 0)
        message = re.sub(r" \(at .*\)$", "", str(problem))
        d.error(
            codes.CELL_FILE,
            f"not a TOML file: {message[:1].lower()}{message[1:]}",
            Origin(file, line, column),
            hint="docs/cell.md shows how the sections and keys of a cell are written",
        )
        return None
    before = len(d.errors)
    config = _read(path, data, Locator(file, text), d, layout)
    return config if len(d.errors) == before else None


def _read(
    path: Path, data: dict[str, Any], locator: Locator, d: Diagnostics, layout: str | None
) -> CellConfig:
    r = _Reader(locator, d)
    r.keys(data, (), _TOP)
    net = r.table(data, "net", required=True)
    r.keys(net, ("net",), {"file"})
    net_file = r.get(net, ("net",), "file", str, "a file name", "", required=True)

    layouts = r.table(data, "layouts")
    chosen, merged = _apply_layout(data, layouts, layout, r)
    robots = r.table(data, "robots")
    config = CellConfig(
        path=path,
        folder=path.parent,
        net_file=net_file,
        supervisor=_supervisor(r, data),
        storage=_storage(r, data),
        values=_values(r, data),
        capacity=_capacity(r, data),
        inputs=tuple(_inputs(r, data)),
        channels=tuple(_channels(r, data)),
        primitives=_primitives(r, data),
        robots=tuple(_robots(r, robots)),
        devices=tuple(_devices(r, data)),
        sensors=tuple(_sensors(r, data)),
        report=ReportConfig(),
        geometry={
            "robots": {
                name: {k: v for k, v in table.items() if k != "instance"}
                for name, table in merged.get("robots", {}).items()
                if isinstance(table, dict)
            },
            "motion": merged.get("motion", {}),
            "scene": merged.get("scene", {}),
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
    return replace(config, report=_report(r, data, config))


def _apply_layout(
    data: dict[str, Any], layouts: dict[str, Any], layout: str | None, r: _Reader
) -> tuple[str, dict[str, Any]]:
    if layout is None:
        layout = next(iter(layouts), "")
    for name, table in layouts.items():
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"layout `{name}` must be a table", r.at("layouts", name))
            return "", data
        r.keys(table, ("layouts", name), {"description", "robots", "motion", "scene"})
        for robot in table.get("robots", {}):
            if robot not in data.get("robots", {}):
                r.d.error(
                    codes.CELL_KEY,
                    f"layout `{name}` places an unknown robot `{robot}`",
                    r.at("layouts", name, "robots", robot),
                    hint=did_you_mean(robot, data.get("robots", {})),
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


def _merge(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    out = dict(base)
    for key, value in over.items():
        old = out.get(key)
        out[key] = (
            _merge(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
        )
    return out


def _supervisor(r: _Reader, data: dict[str, Any]) -> SupervisorConfig:
    at: tuple[str | int, ...] = ("supervisor",)
    table = r.table(data, "supervisor", required=True)
    r.keys(table, at, {"instance", "final", "reply_timeout_s", "order"})
    final = r.get(table, at, "final", list, "a list of places", [])
    timeout = r.get(table, at, "reply_timeout_s", (int, float), "a number of seconds", 120.0)
    if not 0 < timeout < 1e6:
        r.d.error(
            codes.CELL_VALUE,
            f"`reply_timeout_s` is {timeout}, but must be above zero",
            r.at("supervisor", "reply_timeout_s"),
        )
    order = r.get(table, at, "order", str, "`any` or `documented`", "any")
    if order not in ("any", "documented"):
        r.d.error(
            codes.CELL_VALUE,
            f"`order` is `{order}`, but `any` or `documented` is expected",
            r.at("supervisor", "order"),
        )
    return SupervisorConfig(
        instance=r.get(table, at, "instance", str, "a substitution transition", "", required=True),
        final=tuple(map(str, final)),
        reply_timeout_s=float(timeout),
        origin=r.at("supervisor", "instance"),
        order_decides=order == "documented",
    )


def _storage(r: _Reader, data: dict[str, Any]) -> dict[str, str]:
    out = {}
    for name, kind in r.table(data, "storage").items():
        if kind not in ("float32", "float64"):
            r.d.error(
                codes.CELL_VALUE,
                f"storage of `{name}` is `{kind}`, but `float32` or `float64` is expected",
                r.at("storage", name),
            )
        elif kind == "float32":
            out[name] = kind
    return out


def _values(r: _Reader, data: dict[str, Any]) -> dict[str, str]:
    out: dict[str, str] = {}
    for name, value in r.table(data, "values").items():
        text = ml_literal(value)
        if text is None:
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` is `{value}`, but a boolean, number or string is expected",
                r.at("values", name),
            )
        else:
            out[name] = text
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


def _capacity(r: _Reader, data: dict[str, Any]) -> dict[str, int]:
    out = {}
    for name, bound in r.table(data, "capacity").items():
        if not isinstance(bound, int) or isinstance(bound, bool) or not 1 <= bound <= 1_000_000:
            r.d.error(
                codes.CELL_VALUE,
                f"capacity of `{name}` is `{bound}`, but a number from 1 to 1000000 is expected",
                r.at("capacity", name),
            )
        else:
            out[name] = bound
    return out


def _inputs(r: _Reader, data: dict[str, Any]) -> Iterable[InputConfig]:
    for i, table in enumerate(r.tables(data, "input")):
        at: tuple[str | int, ...] = ("input", i)
        r.keys(table, at, {"place", "file"})
        place = r.get(table, at, "place", str, "a place", "", required=True)
        yield InputConfig(place, r.file_name(table, at), r.at(*at, "place"))


def _channels(r: _Reader, data: dict[str, Any]) -> Iterable[ChannelConfig]:
    files: dict[str, str] = {}
    for i, table in enumerate(r.tables(data, "channel")):
        at: tuple[str | int, ...] = ("channel", i)
        r.keys(table, at, {"place", "file", "kind"})
        place = r.get(table, at, "place", str, "a place", "", required=True)
        file = r.file_name(table, at)
        kind = r.get(table, at, "kind", str, "`data` or `flag`", "flag")
        if kind not in ("data", "flag"):
            r.d.error(
                codes.CELL_VALUE,
                f"`kind` is `{kind}`, but `data` or `flag` is expected",
                r.at(*at, "kind"),
            )
            kind = "flag"
        if file in files:
            r.d.error(
                codes.CELL_VALUE,
                f"file `{file}` is used by two channels, `{files[file]}` and `{place}`",
                r.at(*at, "file"),
                hint="give each channel a file of its own",
            )
        files.setdefault(file, place)
        yield ChannelConfig(place, file, ChannelKind(kind), r.at(*at, "place"))


def _primitives(r: _Reader, data: dict[str, Any]) -> dict[str, Primitive]:
    out = {}
    for name, table in r.table(data, "primitives").items():
        at: tuple[str | int, ...] = ("primitives", name)
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"`{name}` must be a table", r.at(*at))
            continue
        r.keys(table, at, {"command", "frame", "action", "duration_s"})
        command = r.get(table, at, "command", str, "a robot command", "wait", required=True)
        if command not in COMMANDS:
            r.d.error(
                codes.CELL_VALUE,
                f"unknown robot command `{command}`",
                r.at(*at, "command"),
                hint=did_you_mean(command, COMMANDS) or f"known commands: {', '.join(COMMANDS)}",
            )
            command = "wait"
        frame = r.get(table, at, "frame", str, "`world` or `tool`", "world")
        if frame not in ("world", "tool"):
            r.d.error(
                codes.CELL_VALUE,
                f"`frame` is `{frame}`, but `world` or `tool` is expected",
                r.at(*at, "frame"),
            )
            frame = "world"
        tool = command == "tool"
        duration = r.get(
            table, at, "duration_s", (int, float), "a number of seconds", 0.0, required=tool
        )
        if duration < 0:
            r.d.error(codes.CELL_VALUE, "`duration_s` is negative", r.at(*at, "duration_s"))
        action = r.get(table, at, "action", str, "a name", "", required=tool)
        out[name] = Primitive(
            name,
            cast(CommandName, command),
            cast(Literal["world", "tool"], frame),
            action,
            float(duration),
        )
    return out


def _robots(r: _Reader, robots: dict[str, Any]) -> Iterable[RobotConfig]:
    for name, table in robots.items():
        at: tuple[str | int, ...] = ("robots", name)
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"`robots.{name}` must be a table", r.at(*at))
            continue
        _name(r, name, at, "a robot name")
        instance = r.get(table, at, "instance", str, "a substitution transition", "", required=True)
        yield RobotConfig(name, instance, r.at(*at, "instance"))


def _name(r: _Reader, name: str, at: tuple[str | int, ...], what: str) -> None:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or name == "supervisor":
        r.d.error(
            codes.CELL_VALUE,
            f"`{name}` is not {what}",
            r.at(*at),
            hint="a letter, then letters, digits and `_`; not `supervisor`",
        )


def _devices(r: _Reader, data: dict[str, Any]) -> Iterable[RobotConfig]:
    for name, table in r.table(data, "devices").items():
        at: tuple[str | int, ...] = ("devices", name)
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"`devices.{name}` must be a table", r.at(*at))
            continue
        r.keys(table, at, {"instance"})
        _name(r, name, at, "a device name")
        if name in data.get("robots", {}):
            r.d.error(
                codes.CELL_VALUE,
                f"`{name}` is a robot and a device",
                r.at(*at),
                hint="give the device another name",
            )
        instance = r.get(table, at, "instance", str, "a substitution transition", "", required=True)
        yield RobotConfig(name, instance, r.at(*at, "instance"))


def _sensors(r: _Reader, data: dict[str, Any]) -> Iterable[SensorConfig]:
    variables: dict[str, str] = {}
    for name, table in r.table(data, "sensors").items():
        at: tuple[str | int, ...] = ("sensors", name)
        if not isinstance(table, dict):
            r.d.error(codes.CELL_VALUE, f"`sensors.{name}` must be a table", r.at(*at))
            continue
        r.keys(table, at, {"variable", "file", "seed"})
        _name(r, name, at, "a sensor name")
        variable = r.get(table, at, "variable", str, "a variable of the net", name)
        if variable in variables:
            r.d.error(
                codes.CELL_VALUE,
                f"variable `{variable}` is decided by two sensors, `{variables[variable]}` and `{name}`",
                r.at(*at),
                hint="remove one of them",
            )
        variables.setdefault(variable, name)
        file = r.file_name(table, at) if "file" in table else ""
        seed = r.get(table, at, "seed", int, "a whole number", 1)
        yield SensorConfig(name, variable, file, seed, r.at(*at))


def _report(r: _Reader, data: dict[str, Any], config: CellConfig) -> ReportConfig:
    table = r.table(data, "report")
    at: tuple[str | int, ...] = ("report",)
    r.keys(table, at, {"rows", "count", "occurrences", "warn_condition"})
    rows = tuple(map(str, r.get(table, at, "rows", list, "a list of channels", [])))
    known = [c.place for c in config.channels]
    for name in rows:
        if name not in known:
            r.d.error(
                codes.CELL_VALUE,
                f"`rows` names `{name}`, which is not a channel",
                r.at("report", "rows"),
                hint=did_you_mean(name, known),
            )
    count = r.get(table, at, "count", dict, "a table label = action", {})
    actions = [p.action for p in config.primitives.values() if p.command == "tool"]
    for label, action in count.items():
        if action not in actions:
            r.d.error(
                codes.CELL_VALUE,
                f"`count.{label}` names `{action}`, which is not a tool action",
                r.at("report", "count"),
                hint=did_you_mean(str(action), actions),
            )
    occurrences = r.get(table, at, "occurrences", dict, "a table label = transition", {})
    warn = r.get(table, at, "warn_condition", (int, float), "a number", 50.0)
    return ReportConfig(
        rows,
        tuple((str(k), str(v)) for k, v in count.items()),
        tuple((str(k), str(v)) for k, v in occurrences.items()),
        float(warn),
    )
