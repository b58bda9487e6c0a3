"""What entries of cell.toml name in others: axes that primitives move, places, zones and axes at which sensors look."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pn2code.cell import codes
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell_file.logic import SENSOR
from pn2code.cell_file.primitive import PRIMITIVE
from pn2code.diagnostics.suggestions import did_you_mean

AlongAxes = tuple[tuple[str, bool], ...]
"""External axes of a move, each with whether it slides."""
TURNING = ("turntable", "swing")
"""Kinds of axes that turn; all others slide."""


def table_of(value: object) -> dict[str, Any]:
    """A table; empty where something else stands, which is reported elsewhere."""
    return value if isinstance(value, dict) else {}


def along_of(
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
        all_axes = axes_of_all(data)
        own = [
            axis
            for robot in table_of(data.get("robots"))
            for axis, x in all_axes[robot].items()
            if x == kind
        ]
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


def axes_of_all(data: Mapping[str, Any]) -> dict[str, dict[str, str]]:
    """Of each robot and device its external axes, each with its kind; what is wrong with them is reported elsewhere."""
    out: dict[str, dict[str, str]] = {}
    for section, default in (("robots", "track"), ("devices", "slide")):
        for owner, table in table_of(data.get(section)).items():
            axes = table_of(table_of(table).get("axes"))
            out[owner] = {a: str(table_of(x).get("kind", default)) for a, x in axes.items()}
    return out


def fixed_of(
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
        for table_ in table_of(data.get(section)).values():
            axes = table_of(table_of(table_).get("axes"))
            said = own = table_of(axes.get(axis))
            if own.get("kind") == "belt":
                said = {"from": 0.0, "to": _farthest(own, axes)}
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


def _farthest(belt: dict[str, Any], axes: dict[str, Any]) -> float | None:
    """How far a belt may run, with those that it drives; None: a mistake that is reported elsewhere."""
    drives = belt.get("drives", [])
    names = drives if isinstance(drives, list) else []
    lengths = [t.get("length") for t in (belt, *(table_of(axes.get(n)) for n in names))]
    known = [x for x in lengths if isinstance(x, int | float)]
    return sum(known) if len(known) == len(lengths) else None


def expect_named(r: Tables, data: dict[str, Any], name: str, at: KeyPath, section: str) -> None:
    """What a key names is there."""
    known = table_of(data.get(section))
    if name and name not in known:
        r.d.error(
            codes.CELL_VALUE,
            f"`{at[-1]}` names `{name}`, but there is no `[{section}.{name}]`",
            r.at(*at),
            hint=did_you_mean(name, known) or f"add a table `[{section}.{name}]` (docs/robots.md)",
        )


def seen_by(
    r: Tables, data: dict[str, Any], table: dict[str, Any], at: KeyPath
) -> tuple[str, str, float]:
    """The place, zone or axis at which a sensor looks; for which kind of parts; at which position of the axis."""
    sees, part = (r.get(table, at, SENSOR[key], "") for key in ("sees", "part"))
    where = r.number(table, at, SENSOR["at"], 0.0) if "at" in table else 0.0
    expect_named(r, data, part, (*at, "part"), "parts")
    device, dot, axis = sees.partition(".")
    kind = axes_of_all(data).get(device, {}).get(axis, "")
    is_axis = bool(dot) and kind not in ("", "belt")
    zones = table_of(_layered(data, "zones"))
    if dot and not is_axis:
        known = [f"{x}.{a}" for x in table_of(data.get("devices")) for a in axes_of_all(data)[x]]
        r.d.error(
            codes.CELL_VALUE,
            f"`sees` names `{sees}`, but "
            + (
                "that is a belt: how far it has run says nothing of where it is"
                if kind
                else "no device has such an axis"
            ),
            r.at(*at, "sees"),
            hint="name a place of `[places]` on it, where a part is seen"
            if kind
            else did_you_mean(sees, known) or "give DEVICE.AXIS, of `[devices.DEVICE.axes.AXIS]`",
        )
    elif not dot and sees not in zones:
        expect_named(r, data, sees, (*at, "sees"), "places")
    elif sees in zones and sees in table_of(_layered(data, "places")):
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
    if is_axis and "at" in table:
        moves = table_of(table_of(table_of(table_of(data["devices"])[device])["axes"])[axis])
        least, most = moves.get("from"), moves.get("to")
        if (
            isinstance(least, int | float)
            and isinstance(most, int | float)
            and not least - 1e-9 <= where <= most + 1e-9
        ):
            r.d.error(
                codes.CELL_VALUE,
                f"`at` is {where:g}, where axis `{sees}` never is: it goes from {least:g} to {most:g}",
                r.at(*at, "at"),
                hint="the sensor would always say `false`",
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
    out = dict(table_of(data.get(section)))
    for layout in table_of(data.get("layouts")).values():
        out |= table_of(table_of(layout).get(section))
    return out
