"""The keys of cell.toml as a JSON Schema, with which editors complete them and mark mistakes.

text()      # the file `cell.schema.json`

A cell.toml names it in its first line: `#:schema ./cell.schema.json`. Only what Taplo ("Even Better TOML") knows of
JSON Schema is used.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from typing import Any

from pn2code.cell_file.keys import Key, Section
from pn2code.cell_file.plain import plain
from pn2code.cell_file.whole import FILE

FILE_NAME = "cell.schema.json"
HEAD = f"#:schema ./{FILE_NAME}\n"
"""The line of cell.toml that names it."""
WORD = "^[A-Za-z][A-Za-z0-9_]*$"


def schema() -> dict[str, Any]:
    """The schema, as a JSON object."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "cell.toml",
        "description": "A robot cell beside its net, for pn2code.",
        **_section(FILE),
    }


def text() -> str:
    """The schema, as a file."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def _section(section: Section, *, partial: bool = False) -> dict[str, Any]:
    """A table. partial: nothing need be there, as in a layout."""
    partial = partial or section.is_partial
    if section.by and not partial:
        return {
            "type": "object",
            "oneOf": [_variant(section, x) for x in section[section.by].words],
        }
    keys = {k.name: k for k in section}
    out = _closed(keys.values(), partial=partial)
    together = [k.name for k in section if k.required == "together"]
    if together and not partial:
        others = [k.name for k in section if k.required is not True]
        needed = {name: [x for x in together if x != name] for name in others}
        out["dependentRequired"] = {name: names for name, names in needed.items() if names}
    return out


def _variant(section: Section, word: str) -> dict[str, Any]:
    """A table whose deciding key says `word`; it may say nothing where that is meant then."""
    out = _closed(k for k in section if not k.only or word in k.only)
    by = section[section.by]
    out["title"] = f'{by.name} = "{word}"'
    if word != by.default:
        out["required"] = [by.name, *(x for x in out.get("required", []) if x != by.name)]
    out["properties"][by.name] = {"const": word, "description": _plain(by)}
    return out


def _closed(keys: Iterable[Key], *, partial: bool = False) -> dict[str, Any]:
    """A table of these keys, and no others."""
    keys = list(keys)
    required = [k.name for k in keys if k.required is True and not partial]
    return {
        "type": "object",
        "properties": {k.name: _value(k, partial=partial) for k in keys},
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }


def _value(key: Key, *, partial: bool = False) -> dict[str, Any]:
    out: dict[str, Any] = {"description": _plain(key)}
    if key.default is not None:
        out["default"] = list(key.default) if isinstance(key.default, tuple) else key.default
    return out | _type(key, partial=partial)


def _type(key: Key, *, partial: bool) -> dict[str, Any]:
    match key.kind:
        case "text":
            return {"enum": list(key.words)} if key.words else {"type": "string"}
        case "whole":
            return {"type": "integer", **_bounds(key)}
        case "number":
            return {"type": "number", **_bounds(key)}
        case "flag":
            return {"type": "boolean"}
        case "scalar":
            return {"type": ["string", "number", "boolean"]}
        case "numbers":
            return {"type": "array", "items": {"type": "number", **_bounds(key)}, **_counts(key)}
        case "texts":
            return {"type": "array", "items": {"type": "string"}, "uniqueItems": True}
        case "table":
            assert key.inner is not None
            return _section(key.inner, partial=partial)
        case "tables":
            assert key.inner is not None
            return {"type": "array", "items": _section(key.inner)}
        case "named":
            assert key.inner is not None
            inner = _section(key.inner, partial=partial)
            named = {"propertyNames": {"pattern": WORD}} if key.is_word else {}
            return {"type": "object", "additionalProperties": inner, **named}
        case "entries":
            assert key.of is not None
            return {"type": "object", "additionalProperties": _value(key.of)}


def _counts(key: Key) -> dict[str, int]:
    return {"minItems": min(key.counts), "maxItems": max(key.counts)} if key.counts else {}


def _bounds(key: Key) -> dict[str, float]:
    out: dict[str, float] = {}
    if key.least > -math.inf:
        out["exclusiveMinimum" if key.above else "minimum"] = key.least
    if key.most < math.inf:
        out["maximum"] = key.most
    return out


def _plain(key: Key) -> str:
    """What a key means, for editors: with its unit."""
    return f"{plain(key.meaning)} Unit: {key.unit}." if key.unit else plain(key.meaning)
