"""Typed access to the tables of `cell.toml`, which reports what is wrong with them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from pn2code.cell import codes
from pn2code.cell.toml_file import Locator
from pn2code.cell_file.keys import Key
from pn2code.cell_file.whole import FILE
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.suggestions import did_you_mean, nearest

KeyPath = tuple[str | int, ...]
"""Of a table or key; tables of arrays are numbered from 0."""


def _number_hint(value: object, kind: type | tuple[type, ...]) -> str:
    """Of a number that is written as a text, perhaps with its unit: `"1 s"`."""
    kinds = kind if isinstance(kind, tuple) else (kind,)
    if float not in kinds and int not in kinds or not isinstance(value, str):
        return ""
    number = re.match(r"\s*[-+]?\d+(\.\d+)?", value)
    return "write the number without quotes and unit" + (
        f": `{number[0].strip()}`" if number else ""
    )


_NO_HINTS: Mapping[str, str] = {}


class Tables:
    """What the tables say; `at` gives the origin of a key, and `d` gets what is wrong."""

    def __init__(self, locator: Locator, d: Diagnostics) -> None:
        self.at = locator.origin
        self.strings = locator.strings
        self._words = locator.words
        self.d = d
        self._meant: set[tuple[KeyPath, str]] = set()

    def keys(
        self,
        table: Mapping[str, Any],
        path: KeyPath,
        known: set[str],
        hints: Mapping[str, str] = _NO_HINTS,
    ) -> None:
        """Reports the keys of a table that are not known; `hints`: what to do where one of these stands there."""
        for key in table:
            if key not in known:
                near = nearest(key, known - table.keys())
                self._meant |= {(path, near)} if near else set()
                self.d.error(
                    codes.CELL_KEY,
                    f"unknown key `{key}`" + (f" in {self._words(*path)}" if path else ""),
                    self.at(*path, key),
                    hint=hints.get(key)
                    or did_you_mean(key, known)
                    or f"known keys: {', '.join(sorted(known))}",
                )

    def get(
        self,
        table: Mapping[str, Any],
        path: KeyPath,
        key: Key,
        default: Any = None,
        *,
        required: bool = False,
    ) -> Any:
        """The value of a key of the table at a path; a default if it is missing, or is not what is expected.

        Args:
            default: where the key has none of its own.
            required: whether it must be there, though not always.
        """
        name, fallback = key.name, default if key.default is None else key.default
        if name not in table:
            if (required or key.required is True) and (path, name) not in self._meant:
                self.d.error(
                    codes.CELL_KEY,
                    f"{self._words(*path, name)} is missing",
                    self.at(*path),
                    hint=f"add `{name} = ...`: {key.expected or _any_of(key)}",
                )
            return fallback
        value, kind = table[name], _TYPES[key.kind]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            self.d.error(
                codes.CELL_VALUE,
                f"`{name}` is `{value}`, but {key.expected or _any_of(key)} is expected",
                self.at(*path, name),
                hint=_number_hint(value, kind),
            )
            return fallback
        if value == "" and key.kind == "text" and key.default != "":
            self.d.error(
                codes.CELL_VALUE,
                f"`{name}` is empty, but {key.expected or _any_of(key)} is expected",
                self.at(*path, name),
                hint="" if required or key.required else "remove it if nothing is meant",
            )
            return fallback
        return value

    def choice(self, table: Mapping[str, Any], path: KeyPath, key: Key, default: str = "") -> str:
        """One of the words of a key; the default if it is missing or another one."""
        fallback = default if key.default is None else str(key.default)
        value = self.get(table, path, key, fallback)
        if value in key.words or key.name not in table:
            return str(value)
        if value != fallback:  # else it has been said that it is no text
            self.d.error(
                codes.CELL_VALUE,
                f"`{key.name}` is `{value}`, but {_any_of(key)} is expected",
                self.at(*path, key.name),
                hint=did_you_mean(value, key.words),
            )
        return fallback

    def table(self, data: Mapping[str, Any], key: str) -> dict[str, Any]:
        """A section of the file; empty if it is missing."""
        return cast(dict[str, Any], self.get(data, (), _section(key), {}))

    def tables(self, data: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
        """An array of tables of the file."""
        found = self.get(data, (), _section(key), [])
        good = [t for t in found if isinstance(t, dict)]
        if len(good) != len(found):
            self.d.error(
                codes.CELL_VALUE, f"`{key}` must be an array of tables `[[{key}]]`", self.at(key)
            )
        return good

    def named(
        self, data: Mapping[str, Any], key: str
    ) -> Iterator[tuple[str, KeyPath, dict[str, Any]]]:
        """The tables of a section, each with its name and its path."""
        for name, table in self.table(data, key).items():
            if isinstance(table, dict):
                yield name, (key, name), table
            else:
                self.d.error(
                    codes.CELL_VALUE, f"`{key}.{name}` must be a table", self.at(key, name)
                )

    def file_name(self, table: Mapping[str, Any], path: KeyPath, key: Key) -> str:
        """The key `file` of a table: a name in the shared directory."""
        name = self.get(table, path, key, "")
        if name and (Path(name).name != name or name.startswith(".") or name.endswith(".tmp")):
            self.d.error(
                codes.CELL_VALUE,
                f"`{name}` is not a plain file name",
                self.at(*path, "file"),
                hint="files lie directly in the shared directory: give a name without `/` and "
                "without a leading dot",
            )
        return str(name)

    def texts(self, table: Mapping[str, Any], path: KeyPath, key: Key) -> list[tuple[str, Origin]]:
        """The texts of a list, each with where it stands; none twice."""
        name, found = key.name, self.get(table, path, key, [])
        at = self.strings(*path, name)
        out: dict[str, Origin] = {}
        for i, value in enumerate(found):
            origin = self.at(*path, name)
            if len(at) == len(found):
                origin = replace(at[i].origin, part=origin.part)
            if not isinstance(value, str) or not value:
                self.d.error(
                    codes.CELL_VALUE,
                    f"`{name}` holds `{value}`, but {key.expected} is expected",
                    origin,
                )
            elif value in out:
                self.d.error(
                    codes.CELL_VALUE,
                    f"`{name}` names `{value}` twice",
                    origin,
                    hint="remove one of them",
                )
            else:
                out[value] = origin
        return list(out.items())

    def number(
        self, table: Mapping[str, Any], path: KeyPath, key: Key, default: float = 0.0
    ) -> float:
        """A finite number within the bounds of its key; the default where there is none, or another one."""
        value = self.get(table, path, key, default)
        if key.within(value):
            return float(value)
        self.d.error(
            codes.CELL_VALUE,
            f"`{key.name}` is {value}, but must be {_bounds(key)}finite",
            self.at(*path, key.name),
            hint=key.meaning,
        )
        return default if key.default is None else float(cast(float, key.default))


def _bounds(key: Key) -> str:
    """The bounds of a number, in words."""
    words: list[str] = []
    if math.isfinite(key.least) and key.least:
        words.append(f"{'above' if key.above else 'at least'} {key.least:.10g}")
    elif math.isfinite(key.least):
        words.append("above zero" if key.above else "zero or more")
    if math.isfinite(key.most):
        words.append(f"at most {key.most:.10g}")
    return ", ".join([*words, "and "]) if words else ""


_TYPES: dict[str, type | tuple[type, ...]] = {
    "text": str,
    "whole": int,
    "number": (int, float),
    "flag": bool,
    "texts": list,
    "table": dict,
    "tables": list,
    "named": dict,
    "entries": dict,
}


def _any_of(key: Key) -> str:
    """The words that are expected, as messages have them."""
    return " or ".join(f"`{word}`" for word in key.words)


def _section(name: str) -> Key:
    """A section as a key of the file, with what is expected of it."""
    found = FILE[name]
    words = f"an array of tables `[[{name}]]`" if found.kind == "tables" else "a table"
    return replace(found, expected=words)
