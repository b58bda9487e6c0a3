"""What sensors say in a run: the values of a file, over and over, a default, or drawn at random from a seed.

Those that see the scene are told what is there by whoever knows it (`sees`).

    sensors = load(config, partition.net, folders, seed, d)
    sensors.ask("robot1", "grip")       # -> "held"

Each program asks on its own: what one is told does not depend on how often another one asks. The values are
scalars of the colour set of the net variable that the sensor decides.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator
from dataclasses import field, replace
from pathlib import Path

from pn2code.base.frozen import record
from pn2code.base.os_reason import os_reason
from pn2code.cell.codes import CELL_FILE, CELL_MISSING, CELL_VALUE
from pn2code.cell.config import CellConfig, SensorConfig
from pn2code.cell.scalars import Scalar, ScalarKind, scalars_of
from pn2code.channels.scalars import Malformed, format_scalars, parse_scalars, quote
from pn2code.diagnostics import Diagnostics, Note, Origin
from pn2code.net.flat import FlatNet

Value = int | float | bool | str
_NAMED = 5
"""Values of an enumeration that are shown where something else is written."""
MOST_DRAWN = 1_000_000
"""Colour sets with more values are not drawn from."""


@record
class _Sensor:
    """One sensor: what it says in turn, or what it draws from."""

    seed: int
    script: tuple[Value, ...]
    choices: range | tuple[Value, ...]
    asked: dict[str, int] = field(default_factory=dict)
    random: dict[str, random.Random] = field(default_factory=dict)

    def ask(self, who: str, name: str) -> Value:
        n = self.asked.get(who, 0)
        self.asked[who] = n + 1
        if self.script:
            return self.script[n % len(self.script)]
        source = self.random.setdefault(who, random.Random(f"{self.seed} {name} {who}"))
        return self.choices[source.randrange(len(self.choices))]


@record
class Sensors:
    """All sensors of a cell.

    Args:
        seen: the place and the kind of parts ("": any), the zone, or the axis (`mill.door`) at which a sensor looks.
        at: of an axis, where it is seen, m or degrees.
    """

    _sensors: dict[str, _Sensor] = field(default_factory=dict)
    seen: dict[str, tuple[str, str]] = field(default_factory=dict)
    at: dict[str, float] = field(default_factory=dict)

    def ask(self, who: str, sensor: str) -> Value | None:
        """What a sensor says to a robot or device; None: there is no such sensor."""
        found = self._sensors.get(sensor)
        return None if found is None else found.ask(who, sensor)


def load(
    config: CellConfig, net: FlatNet, folders: Iterable[Path], seed: int | None, d: Diagnostics
) -> Sensors | None:
    """The sensors of a cell; None when an error was reported.

    Args:
        folders: where their files may be, the first one that has it counts.
        seed: replaces that of each sensor; None: its own.
    """
    before = len(d.errors)
    out: dict[str, _Sensor] = {}
    seen: dict[str, tuple[str, str]] = {}
    at: dict[str, float] = {}
    for sensor, scalar in usable(config, net):
        if sensor.sees and scalar.kind is not ScalarKind.BOOL:
            d.error(
                CELL_VALUE,
                f"sensor `{sensor.name}` sees whether something is at `{sensor.sees}`, but its variable is of colour "
                f"set `{scalar.colset}`",
                sensor.origin,
                hint="let the variable be a truth value (a colour set `bool`)",
            )
            continue
        if sensor.sees:
            seen[sensor.name] = (sensor.sees, sensor.part)
            at[sensor.name] = sensor.at
        script = _script(sensor, (scalar,), tuple(folders), d)
        is_drawn = not sensor.file and sensor.default is None
        choices = _choices(sensor, scalar, d) if is_drawn else ()
        out[sensor.name] = _Sensor(sensor.seed if seed is None else seed, script, choices)
    return Sensors(out, seen, at) if len(d.errors) == before else None


def usable(config: CellConfig, net: FlatNet) -> Iterator[tuple[SensorConfig, Scalar]]:
    """The sensors whose variable is one scalar, with it. No program asks others: said when the programs were made."""
    colsets = {v.name: v.colset for t in net.transitions for v in t.variables}
    for sensor in config.sensors:
        colset = colsets.get(sensor.variable)
        scalars = scalars_of(colset) if colset is not None else None
        if scalars is not None and len(scalars) == 1:
            yield sensor, scalars[0]


def values_of(scalar: Scalar, most: int) -> range | tuple[Value, ...] | None:
    """All values, in the order of the colour set; None: more than so many, or not bounded."""
    match scalar.kind:
        case ScalarKind.BOOL:
            return (False, True)
        case ScalarKind.ENUM if len(scalar.names) <= most:
            return scalar.names
        case ScalarKind.INT | ScalarKind.INDEX:
            low, high = scalar.low, scalar.high
            if isinstance(low, int) and isinstance(high, int) and high - low < most:
                return range(low, high + 1)
    return None


def _script(
    sensor: SensorConfig, scalars: tuple[Scalar, ...], folders: tuple[Path, ...], d: Diagnostics
) -> tuple[Value, ...]:
    """What it says in turn: the lines of its file, or its default; empty: neither, or an error was reported."""
    files = [f / sensor.file for f in folders if sensor.file and (f / sensor.file).is_file()]
    path = next(iter(files), None)
    default = () if sensor.default is None else _default(sensor, scalars, sensor.default, d)
    if path is None and sensor.default is not None:
        return default
    if path is None and not sensor.file:
        return ()
    if path is None:
        d.error(
            CELL_MISSING,
            f"sensor `{sensor.name}`: there is no file `{sensor.file}`",
            sensor.origin,
            hint="write one value a line, or say what it says without one (`default`), or leave out `file` to "
            "have them drawn at random",
        )
        return ()
    try:
        lines = path.read_text(encoding="utf-8").split("\n")
    except (OSError, UnicodeDecodeError) as problem:
        d.error(
            CELL_FILE,
            f"cannot read `{path}`: {os_reason(problem)}",
            sensor.origin,
            hint="save it as a text file in UTF-8 that may be read",
        )
        return ()
    before = len(d.errors)
    names = scalars[0].names[:_NAMED]
    some = f", such as {', '.join(f'`{name}`' for name in names)}," if names else ""
    out: list[Value] = []
    for number, line in enumerate(lines, 1):
        text = line.partition("#")[0].rstrip()
        if not text.strip():
            continue
        found = parsed(scalars, text)
        if isinstance(found, Malformed):
            d.error(
                CELL_VALUE,
                found.text,
                Origin(str(path), number, found.column),
                notes=[Note(f"sensor `{sensor.name}` reads this file", sensor.origin)],
                hint=f"write one value of colour set `{scalars[0].colset}`{some} a line",
            )
        else:
            out += found
    if not out and len(d.errors) == before:
        d.error(
            CELL_VALUE,
            f"sensor `{sensor.name}`: `{path}` holds no value",
            Origin(str(path)),
            hint="write one value a line",
        )
    return tuple(out)


def parsed(scalars: tuple[Scalar, ...], text: str) -> tuple[Value, ...] | Malformed:
    """A value as in a message; a truth value may also be written as in the net."""
    word = text.strip()
    if scalars[0].kind is ScalarKind.BOOL and word in ("true", "false"):
        return (word == "true",)
    found = parse_scalars(scalars, text)
    if (
        scalars[0].kind is ScalarKind.BOOL
        and isinstance(found, Malformed)
        and not found.wrong_count
    ):
        says = f"{quote(word)} is neither `true` (or `1`) nor `false` (or `0`)"
        return replace(found, text=says)
    return found


def _default(
    sensor: SensorConfig, scalars: tuple[Scalar, ...], value: Value, d: Diagnostics
) -> tuple[Value, ...]:
    """Written in cell.toml as in a file: a text is a constructor's name, or the text itself."""
    kind = scalars[0].kind
    is_text = isinstance(value, str) and kind is not ScalarKind.STRING
    text = str(value) if is_text else format_scalars(scalars, (value,))
    if isinstance(value, bool) and kind is not ScalarKind.BOOL:
        text = None
    found = Malformed(f"`{value}` is no value", 1) if text is None else parsed(scalars, text)
    if not isinstance(found, Malformed):
        return found
    d.error(
        CELL_VALUE,
        f"sensor `{sensor.name}`: default: {found.text}",
        sensor.origin,
        hint=f"a value of colour set `{scalars[0].colset}` is expected",
    )
    return ()


def _choices(sensor: SensorConfig, scalar: Scalar, d: Diagnostics) -> range | tuple[Value, ...]:
    values = values_of(scalar, MOST_DRAWN)
    if values is not None:
        return values
    d.error(
        CELL_VALUE,
        f"sensor `{sensor.name}`: colour set `{scalar.colset}` has too many values to draw one at random",
        sensor.origin,
        hint='add `file = "..."`, with one value a line',
    )
    return ()
