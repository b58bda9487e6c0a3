"""`[layouts]` of cell.toml: where robots, devices, frames and the scene are in one variant of a cell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from pn2code.cell import codes
from pn2code.cell.named_elsewhere import table_of
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell_file.devices import DEVICE_PLACE
from pn2code.cell_file.keys import Key
from pn2code.cell_file.whole import FILE, LAYOUT, PLACED
from pn2code.diagnostics.suggestions import did_you_mean

_SAME_IN_LAYOUTS = {
    "tools": "tools are the same in all layouts; where one lies is the place `rack`, which a layout may say: "
    "`[layouts.NAME.places.RACK]`",
    **{
        key.name: f"what `{key.name}` says is the same in all layouts"
        for key in FILE
        if key.name not in (*LAYOUT.names(), "tools")
    },
}


def apply_layout(
    data: dict[str, Any], layouts: dict[str, Any], layout: str | None, r: Tables
) -> tuple[str, dict[str, Any]]:
    """The layout that is meant (default: the first one), and the cell with what it says; all layouts are checked."""
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
