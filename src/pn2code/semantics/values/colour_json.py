"""The JSON form of values in traces (docs/trace.md), both ways, by colour set.

`from_json(c, to_json(c, v)) == v` for every legal value; reals come back as the same double.
"""

from __future__ import annotations

import math
from typing import Any

from pn2code.base.real_json import real_to_json
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.values.colour_components import assemble, component, parts_of
from pn2code.semantics.values.data import UNIT, Data, Value

Json = Any
"""What the module `json` reads and writes."""

_NOT_FINITE: dict[str, float] = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}


class JsonError(ValueError):
    """A JSON value is no value of the colour set; the message says why."""


def to_json(c: Colset, value: Any) -> Json:
    """The JSON form of a value of the colour set's type."""
    match c.kind:
        case Kind.UNIT:
            return None
        case Kind.REAL:
            return real_to_json(value)
        case Kind.TIME if isinstance(value, float):
            return real_to_json(value)
        case Kind.ENUM:
            return value.name
        case Kind.INDEX:
            return value.argument
        case Kind.PRODUCT:
            return [to_json(part, item) for _, part, item in parts_of(c, value)]
        case Kind.RECORD:
            return {label: to_json(part, item) for label, part, item in parts_of(c, value)}
        case Kind.LIST:
            return [to_json(component(c), item) for item in value]
        case Kind.UNION:
            part = c.components[value.tag]
            return [value.name] if part is None else [value.name, to_json(part, value.argument)]
        case Kind.ALIAS | Kind.SUBSET:
            return to_json(component(c), value)
        case _:
            return value


def from_json(c: Colset, data: Json) -> Value:
    """The value of a JSON form. Bounds of the colour set are not checked (see `Colours.legal`).

    Raises:
        JsonError: it has not the form that the colour set's values have.
    """
    match c.kind:
        case Kind.UNIT if data is None:
            return UNIT
        case Kind.BOOL if isinstance(data, bool):
            return data
        case Kind.INT | Kind.INTINF if _is_int(data):
            return int(data)
        case Kind.INDEX if _is_int(data):
            return Data(c.names[0], 0, int(data))
        case Kind.TIME if _is_int(data) or isinstance(data, float):
            return data  # type: ignore[no-any-return]  # looked at just before
        case Kind.REAL if _is_int(data) or isinstance(data, float):
            return float(data)
        case Kind.REAL | Kind.TIME if isinstance(data, str) and data in _NOT_FINITE:
            return _NOT_FINITE[data]
        case Kind.STRING if isinstance(data, str) and (data.isascii() or max(data) <= "\xff"):
            return data
        case Kind.ENUM if isinstance(data, str) and data in c.names:
            return Data(data, c.names.index(data))
        case Kind.PRODUCT if isinstance(data, list) and len(data) == len(c.components):
            parts = [part for part in c.components if part is not None]
            return assemble(c, [from_json(p, x) for p, x in zip(parts, data, strict=True)])
        case Kind.RECORD if isinstance(data, dict) and set(data) == set(c.labels):
            parts = [part for part in c.components if part is not None]
            return assemble(
                c, [from_json(p, data[label]) for p, label in zip(parts, c.labels, strict=True)]
            )
        case Kind.LIST if isinstance(data, list):
            return tuple(from_json(component(c), item) for item in data)
        case Kind.UNION if isinstance(data, list) and data and data[0] in c.names:
            return _union_from_json(c, data)
        case Kind.ALIAS | Kind.SUBSET:
            return from_json(component(c), data)
    raise JsonError(f"{data!r} is not a value of the colour set `{c.name}` ({c.kind.value})")


def _union_from_json(c: Colset, data: list[Json]) -> Value:
    tag = c.names.index(data[0])
    part = c.components[tag]
    if part is None and len(data) == 1:
        return Data(data[0], tag)
    if part is not None and len(data) == 2:
        return Data(data[0], tag, from_json(part, data[1]))
    raise JsonError(f"{data!r} is not a value of the colour set `{c.name}` ({c.kind.value})")


def _is_int(data: Json) -> bool:
    return isinstance(data, int) and not isinstance(data, bool)
