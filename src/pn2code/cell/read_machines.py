"""`[robots]`, `[devices]` and `[sensors]` of cell.toml: what does the work of a cell, and what looks at it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from pn2code.cell import codes
from pn2code.cell.config import RobotConfig, SensorConfig
from pn2code.cell.named_elsewhere import seen_by, table_of
from pn2code.cell.tables import KeyPath, Tables
from pn2code.cell_file.arms import ROBOT
from pn2code.cell_file.logic import DEVICE, SENSOR


def read_robots(r: Tables, data: dict[str, Any]) -> Iterable[RobotConfig]:
    """The robots, each with the substitution transition of its program."""
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


def read_devices(r: Tables, data: dict[str, Any]) -> Iterable[RobotConfig]:
    """The devices, each with the substitution transition of its program."""
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


def read_sensors(r: Tables, data: dict[str, Any]) -> Iterable[SensorConfig]:
    """The sensors, each with the variable of the net that it decides."""
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
