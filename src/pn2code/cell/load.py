"""`cell.toml` -> `CellConfig`, or diagnostics.

The geometry (`robots.*.base`, `[motion]`, `[scene]`) is kept raw and validated by `pn2code.robot.scene`, which is the
one who understands it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

from pn2code.cell import codes
from pn2code.cell.config import (
    CellConfig,
    ChannelConfig,
    InputConfig,
    ReportConfig,
    SupervisorConfig,
)
from pn2code.cell.files import check_files, one_name
from pn2code.cell.layouts import apply_layout
from pn2code.cell.named_elsewhere import table_of
from pn2code.cell.partition import ChannelKind
from pn2code.cell.read_machines import read_devices, read_robots, read_sensors
from pn2code.cell.read_primitives import check_handling, read_primitives
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell.toml_file import Locator, read
from pn2code.cell_file.logic import (
    ACCEPT,
    BOUND,
    CHANNEL,
    INPUT,
    NET,
    REGISTER,
    REPORT,
    STORED,
    SUPERVISOR,
    VALUE,
)
from pn2code.cell_file.whole import FILE, PLACED
from pn2code.diagnostics import Diagnostics, Origin, PlacedText
from pn2code.diagnostics.accepted import Rule
from pn2code.diagnostics.suggestions import did_you_mean


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
    chosen, merged = apply_layout(data, layouts, layout, r)
    config = CellConfig(
        path=path,
        net_file=net_file,
        supervisor=_supervisor(r, data),
        storage=_storage(r, data),
        values=_values(r, data),
        capacity=_capacity(r, data),
        inputs=tuple(_inputs(r, data)),
        channels=tuple(_channels(r, data)),
        primitives=read_primitives(r, data),
        robots=tuple(read_robots(r, data)),
        devices=tuple(read_devices(r, data)),
        sensors=tuple(read_sensors(r, data)),
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
    check_handling(r, data, config.primitives)
    return replace(config, report=_report(r, data, config))


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
