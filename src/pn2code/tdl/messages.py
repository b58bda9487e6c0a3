"""Values of a script in the units and types of what it talks to: commands in SI, messages as scalars."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import astuple
from itertools import groupby
from typing import Any, cast

import pn2code.robot.commands as commands
from pn2code.tdl import tree as t
from pn2code.tdl.evaluate import Element, ScriptError, ScriptPose, ScriptValue, single
from pn2code.tdl.pretty import held
from pn2code.tdl.requests import Scalar
from pn2code.tdl.types import ELEMENT, POSE_FIELDS, Type


def to_si(pose: ScriptPose) -> commands.Pose:
    """Millimetres and degrees to metres and radians."""
    return commands.Pose(
        pose.x / 1000.0,
        pose.y / 1000.0,
        pose.z / 1000.0,
        math.radians(pose.rx),
        math.radians(pose.ry),
        math.radians(pose.rz),
    )


def axes_to_si(angles: Iterable[float]) -> tuple[float, ...]:
    """A joint position of a script: degrees to radians."""
    return tuple(map(math.radians, angles))


def along_to_si(a: t.Along, position: float) -> commands.Along:
    """Where an external axis goes: of a track millimetres to metres, of a turntable degrees to radians."""
    metres_or_radians = position / 1000.0 if a.is_track else math.radians(position)
    return commands.Along(a.axis, metres_or_radians, a.is_track)


def from_si(pose: commands.Pose, asked: commands.Pose, nominal: ScriptPose) -> ScriptPose:
    """Metres and radians to millimetres and degrees.

    A component that came back as it went out keeps its value in mm or degrees, to the last bit: a
    conversion there and back would not.
    """
    return ScriptPose(
        *(
            was if si == sent else (si * 1000.0 if i < 3 else math.degrees(si))
            for i, (si, sent, was) in enumerate(
                zip(astuple(pose), astuple(asked), astuple(nominal), strict=True)
            )
        )
    )


def stored_value(value: ScriptValue, kind: t.TypeName) -> ScriptValue:
    """The value as a variable or file of this type holds it."""
    if kind.type is not Type.INT and isinstance(value, int) and not isinstance(value, bool):
        value = float(value)
    return single(value) if kind.single else value


def scalars_of(value: ScriptValue) -> tuple[Scalar, ...]:
    """The scalars of a message: of a pose its six components, in mm and degrees; of a list how many, and its items."""
    if isinstance(value, tuple):
        return (len(value), *(x for item in value for x in scalars_of(item)))
    return astuple(value) if isinstance(value, ScriptPose) else (value,)


def message_of(values: Sequence[ScriptValue], kinds: Sequence[t.TypeName]) -> tuple[Scalar, ...]:
    """The scalars of a message: of a list of records how many, and then all of the first, all of the second ...

    Args:
        values: in the order of the kinds, as the file holds them.
        kinds: what the file holds.

    Raises:
        ScriptError: the columns of a list of records differ in length.
    """
    out: list[Scalar] = []
    for row, group in groupby(zip(kinds, values, strict=True), lambda x: x[0].row):
        found = [value for _, value in group]
        if not row:
            out += (x for value in found for x in scalars_of(value))
            continue
        columns = cast("list[tuple[Element, ...]]", found)
        out.append(len(columns[0]))
        out += (x for item in items_of_columns(columns) for part in item for x in scalars_of(part))
    return tuple(out)


def items_of_columns(columns: Sequence[tuple[Element, ...]]) -> list[tuple[Element, ...]]:
    """The items of a list of records; ScriptError where its columns differ in length."""
    if len(lengths := {len(column) for column in columns}) > 1:
        shown = " and ".join(map(str, sorted(lengths)))
        raise ScriptError(f"columns of one list of records have {shown} items")
    return list(zip(*columns, strict=True))


def typed_values(
    name: str, message: tuple[Scalar, ...], kinds: tuple[t.TypeName, ...]
) -> list[ScriptValue]:
    """The values of a message; ScriptError if it is not what the script declares."""
    values: list[ScriptValue] = []
    rest = list(message)
    try:
        for row, group in groupby(kinds, lambda x: x.row):
            if row:
                values += _columns(rest, [ELEMENT[kind.type] for kind in group])
                continue
            for kind in group:
                if kind.type is Type.SIGNAL:
                    rest.pop(0)
                elif kind.type in ELEMENT:
                    values += _columns(rest, [ELEMENT[kind.type]])
                else:
                    values.append(_taken(rest, kind.type))
        if rest:
            raise ValueError
    except (IndexError, ValueError):
        words = " ".join(map(str, message))
        raise ScriptError(
            f"file `{name}` holds `{words}`, but the script expects {held(kinds)}"
        ) from None
    return values


def _columns(rest: list[Scalar], kinds: Sequence[Type]) -> list[tuple[Element, ...]]:
    """The columns of a list from the beginning of a message: for each kind of its items one."""
    count = scalar_of(rest.pop(0), Type.INT)
    items = [[_taken(rest, kind) for kind in kinds] for _ in range(count)]
    return [tuple(item[i] for item in items) for i in range(len(kinds))]


def _taken(rest: list[Scalar], kind: Type) -> Element:
    """A value from the beginning of a message."""
    if kind is Type.POSE:
        return ScriptPose(*(scalar_of(rest.pop(0), Type.REAL) for _ in POSE_FIELDS))
    return cast(Element, scalar_of(rest.pop(0), kind))


def scalar_of(x: Scalar, kind: Type) -> Any:
    """One scalar as its type wants it; ValueError if it cannot be."""
    if kind in (Type.STRING, Type.WORD):
        if isinstance(x, str):
            return x
    elif kind is Type.BOOL:
        if isinstance(x, bool) or (isinstance(x, int) and x in (0, 1)):
            return bool(x)
    elif isinstance(x, int) and not isinstance(x, bool):
        return x if kind is Type.INT else float(x)
    elif isinstance(x, float) and kind is not Type.INT and math.isfinite(x):
        return x
    raise ValueError
