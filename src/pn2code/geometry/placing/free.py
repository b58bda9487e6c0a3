"""What of a cell may be moved: numbers of the bases of its arms, each within bounds.

    free = parse(["robot2.base.x=5:6.5,y,yaw"], cell, around=1.0)
    moved(cell, free, values)            # the cell with its arms there

Numbers are those of cell.toml: metres and degrees.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from pn2code.base.frozen import frozen
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot.commands import Pose
from pn2code.robot.elsewhere import standing_at
from pn2code.robot.robot_cell import RobotCell
from pn2code.robot.transforms import Array

KEYS = {"x": "x", "y": "y", "z": "z", "roll": "rx", "pitch": "ry", "yaw": "rz"}
"""The keys of a base in cell.toml, and the fields of a `Pose`."""
LENGTHS = ("x", "y", "z")
TURNED = {"roll": 30.0, "pitch": 30.0, "yaw": 180.0}
"""degrees, to each side, where nothing else is said"""
DIGITS = {"m": 3, "degrees": 1}
"""So exactly bases are placed: engineers measure no better."""
_PART = re.compile(r"(?P<key>[a-z]+)(=(?P<low>[^:=]+):(?P<high>[^:=]+))?")


class FreeError(Exception):
    """What is wrong with what may be moved; its text says so."""


@frozen
class Free:
    """A number that may be chosen.

    Args:
        robot: whose base; key: "x" ... "yaw".
        low, high: bounds, m or degrees.
        here: what it is.
    """

    robot: str
    key: str
    low: float
    high: float
    here: float

    @property
    def unit(self) -> str:
        """Of its values."""
        return "m" if self.key in LENGTHS else "degrees"


def parse(texts: Iterable[str], cell: RobotCell, around: float) -> tuple[Free, ...]:
    """What `--free` names, in the order of cell.toml.

    Args:
        texts: each `ROBOT.base.KEY[=LOW:HIGH][,KEY...]`.
        cell: as it stands.
        around: m, to each side, where nothing else is said.

    Raises:
        FreeError: a text names nothing of the cell, or something twice.
    """
    found: dict[tuple[str, str], Free] = {}
    for text in texts:
        robot, keys = _named(text, [r.name for r in cell.robots])
        for part in keys.split(","):
            one = _one(text, robot, part, cell, around)
            if (robot, one.key) in found:
                raise FreeError(f"`{one.key}` of the base of `{robot}` is named twice")
            found[robot, one.key] = one
    order = {r.name: i for i, r in enumerate(cell.robots)}
    keys_ = list(KEYS)
    return tuple(sorted(found.values(), key=lambda f: (order[f.robot], keys_.index(f.key))))


def expect_known(texts: Iterable[str], robots: Sequence[str]) -> None:
    """Looks at what can be said before anything is known of the arms.

    Args:
        texts: as for `parse`.
        robots: those of cell.toml.

    Raises:
        FreeError: a text is malformed, or names neither robot nor key.
    """
    for text in texts:
        _, keys = _named(text, robots)
        for part in keys.split(","):
            _key(text, part)


def _named(text: str, names: Sequence[str]) -> tuple[str, str]:
    robot, dot, rest = text.partition(".base.")
    if not dot or not rest:
        raise FreeError(
            f"`{text}` is not of the form ROBOT.base.KEY[=LOW:HIGH][,KEY...], as in robot2.base.x,y=7:9,yaw"
        )
    if robot not in names:
        hint = did_you_mean(robot, names) or f"known are {', '.join(f'`{n}`' for n in names)}"
        raise FreeError(f"the cell has no robot `{robot}` with an arm; {hint}")
    return robot, rest


def _key(text: str, part: str) -> re.Match[str]:
    match = _PART.fullmatch(part.strip())
    if match is None:
        raise FreeError(f"`{part.strip()}` in `{text}` is not of the form KEY or KEY=LOW:HIGH")
    key = match["key"]
    if key not in KEYS:
        hint = did_you_mean(key, KEYS) or f"known are {', '.join(KEYS)}"
        raise FreeError(f"a base has no key `{key}`; {hint}")
    return match


def _one(text: str, robot: str, part: str, cell: RobotCell, around: float) -> Free:
    match = _key(text, part)
    key = match["key"]
    here = float(getattr(cell.robot(robot).base, KEYS[key]))
    if key not in LENGTHS:
        here = math.degrees(here)
    if match["low"] is None:
        half = around if key in LENGTHS else TURNED[key]
        low = here - half
        if key == "z" and here >= 0.0:
            low = max(0.0, low)  # not into the floor
        return Free(robot, key, low, here + half, here)
    low, high = (_number(match[side], part) for side in ("low", "high"))
    if not low < high:
        raise FreeError(f"`{part.strip()}`: the lower bound must be below the upper one")
    # Values are rounded, and must not leave the bounds by that.
    scale = 10.0 ** DIGITS["m" if key in LENGTHS else "degrees"]
    least, most = math.ceil(low * scale - 1e-6) / scale, math.floor(high * scale + 1e-6) / scale
    if not least < most:
        step = "whole millimetres" if key in LENGTHS else "tenths of a degree"
        raise FreeError(f"`{part.strip()}`: there are no two {step} between the bounds")
    return Free(robot, key, least, most, here)


def _number(text: str, part: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise FreeError(f"`{text}` in `{part.strip()}` is not a number")
    return value


def rounded(free: Sequence[Free], values: Sequence[float]) -> tuple[float, ...]:
    """Values as they are written into cell.toml: whole millimetres, tenths of a degree."""
    return tuple(round(float(v), DIGITS[f.unit]) + 0.0 for f, v in zip(free, values, strict=True))


def base_of(cell: RobotCell, robot: str, free: Sequence[Free], values: Sequence[float]) -> Pose:
    """The base of an arm with these values."""
    changes = {
        KEYS[f.key]: float(v) if f.key in LENGTHS else math.radians(v)
        for f, v in zip(free, values, strict=True)
        if f.robot == robot
    }
    return replace(cell.robot(robot).base, **changes)


def moved(cell: RobotCell, free: Sequence[Free], values: Sequence[float]) -> RobotCell:
    """The cell with its arms there."""
    robots = tuple(standing_at(r, base_of(cell, r.name, free, values)) for r in cell.robots)
    return replace(cell, robots=robots)


def bounds_of(free: Sequence[Free]) -> Array:
    """Lower and upper bounds, (n, 2)."""
    return np.array([[f.low, f.high] for f in free])
