"""A placing as a layout of cell.toml, with all that the layout has from which the search started.

text = layout_text(found)       # of a `Placed` whose `chosen` is there
"""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pn2code.geometry.placing.free import KEYS, LENGTHS

if TYPE_CHECKING:
    from pn2code.geometry.placing.look import Placed


def layout_text(found: Placed) -> str:
    """The layout; keys of a base that were not free are written, too, so that it stands alone."""
    assert found.chosen is not None, "something was chosen"
    with found.config.path.open("rb") as file:
        layouts: dict[str, Any] = tomllib.load(file).get("layouts", {})
    start = dict(layouts.get(found.layout, {}))
    start.pop("description", None)
    robots = {name: dict(robot) for name, robot in start.pop("robots", {}).items()}
    for name in dict.fromkeys(f.robot for f in found.free):
        base = found.chosen.cell.robot(name).base
        numbers = {}
        for key, field in KEYS.items():
            value = float(getattr(base, field))
            numbers[key] = round(value if key in LENGTHS else math.degrees(value), 6) + 0.0
        robots.setdefault(name, {})["base"] = numbers
    from_ = f", from the layout `{found.layout}`" if found.layout else ""
    lines = [
        f"# Found by `pn2code place`{from_}. Copy it into cell.toml; the name is free.",
        f"[layouts.{_name(layouts)}]",
        *(
            f"robots.{_key(robot)}.{_key(key)} = {_value(value)}"
            for robot, table in robots.items()
            for key, value in table.items()
        ),
        *(
            f"{_key(section)}.{_key(key)} = {_value(value)}"
            for section, table in start.items()
            for key, value in table.items()
        ),
    ]
    return "\n".join(lines) + "\n"


def _name(layouts: Mapping[str, Any]) -> str:
    """One that no layout has."""
    name, number = "placed", 1
    while name in layouts:
        number += 1
        name = f"placed{number}"
    return name


def _key(text: str) -> str:
    is_bare = text.isascii() and text.replace("_", "").replace("-", "").isalnum()
    return text if is_bare else json.dumps(text, ensure_ascii=False)


def _value(value: Any) -> str:
    """As TOML has it, on one line."""
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return json.dumps(value, ensure_ascii=False)
        case float():
            return f"{value:.10g}" if math.isfinite(value) else repr(value)
        case list():
            return f"[{', '.join(map(_value, value))}]"
        case dict():
            inner = ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items())
            return f"{{ {inner} }}" if inner else "{}"
        case _:
            return str(value)
