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


class Tables:
    """What the tables say; `at` gives the origin of a key, and `d` gets what is wrong."""

    def __init__(self, locator: Locator, d: Diagnostics) -> None:
        self.at = locator.origin
        self.strings = locator.strings
        self._words = locator.words
        self.d = d
        self._meant: set[tuple[KeyPath, str]] = set()

    def keys(self, table: Mapping[str, Any], path: KeyPath, known: set[str]) -> None:
        """Reports the keys of a table that are not known."""
        for key in table:
            if key not in known:
                near = nearest(key, known - table.keys())
                self._meant |= {(path, near)} if near else set()
                self.d.error(
                    codes.CELL_KEY,
                    f"unknown key `{key}`" + (f" in {self._words(*path)}" if path else ""),
                    self.at(*path, key),
                    hint=did_you_mean(key, known) or f"known keys: {', '.join(sorted(known))}",
                )

    def get(
        self,
        table: Mapping[str, Any],
        path: KeyPath,
        key: str,
        kind: type | tuple[type, ...],
        words: str,
        default: Any = None,
        *,
        required: bool = False,
    ) -> Any:
        """The value of a key of the table at a path; the default if it is missing, or is not what `words` says."""
        if key not in table:
            if required and (path, key) not in self._meant:
                self.d.error(
                    codes.CELL_KEY,
                    f"{self._words(*path, key)} is missing",
                    self.at(*path),
                    hint=f"add `{key} = ...`: {words}",
                )
            return default
        value = table[key]
        if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
            self.d.error(
                codes.CELL_VALUE,
                f"`{key}` is `{value}`, but {words} is expected",
                self.at(*path, key),
                hint=_number_hint(value, kind),
            )
            return default
        return value

    def choice(
        self,
        table: Mapping[str, Any],
        path: KeyPath,
        key: str,
        words: tuple[str, ...],
        default: str,
    ) -> str:
        """One of some words; the default if it is missing or another one."""
        shown = " or ".join(f"`{word}`" for word in words)
        value = self.get(table, path, key, str, shown, default)
        if value in words or value == default:
            return str(value)
        self.d.error(
            codes.CELL_VALUE,
            f"`{key}` is `{value}`, but {shown} is expected",
            self.at(*path, key),
            hint=did_you_mean(value, words),
        )
        return default

    def table(self, data: Mapping[str, Any], key: str, *, required: bool = False) -> dict[str, Any]:
        """A section of the file; empty if it is missing."""
        found = self.get(data, (), key, dict, "a table", {}, required=required)
        return cast(dict[str, Any], found)

    def tables(self, data: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
        """An array of tables of the file."""
        found = self.get(data, (), key, list, f"an array of tables `[[{key}]]`", [])
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

    def file_name(self, table: Mapping[str, Any], path: KeyPath) -> str:
        """The key `file` of a table: a name in the shared directory."""
        name = self.get(table, path, "file", str, "a file name", "", required=True)
        if name and (Path(name).name != name or name.startswith(".") or name.endswith(".tmp")):
            self.d.error(
                codes.CELL_VALUE,
                f"`{name}` is not a plain file name",
                self.at(*path, "file"),
                hint="files lie directly in the shared directory: give a name without `/` and "
                "without a leading dot",
            )
        return str(name)

    def texts(
        self, table: Mapping[str, Any], path: KeyPath, key: str, words: str
    ) -> list[tuple[str, Origin]]:
        """The texts of a list, each with where it stands; none twice."""
        found = self.get(table, path, key, list, words, [])
        at = self.strings(*path, key)
        out: dict[str, Origin] = {}
        for i, value in enumerate(found):
            origin = self.at(*path, key)
            if len(at) == len(found):
                origin = replace(at[i].origin, part=origin.part)
            if not isinstance(value, str) or not value:
                self.d.error(
                    codes.CELL_VALUE, f"`{key}` holds `{value}`, but {words} is expected", origin
                )
            elif value in out:
                self.d.error(
                    codes.CELL_VALUE,
                    f"`{key}` names `{value}` twice",
                    origin,
                    hint="remove one of them",
                )
            else:
                out[value] = origin
        return list(out.items())

    def number(
        self,
        table: Mapping[str, Any],
        path: KeyPath,
        key: str,
        default: float,
        *,
        above: float | None = None,
        required: bool = False,
    ) -> float:
        """A finite number, not negative; or above a bound."""
        words = "a number of seconds" if key.endswith("_s") else "a number"
        value = self.get(table, path, key, (int, float), words, default, required=required)
        bound = 0.0 if above is None else above
        if math.isfinite(value) and (value > bound if above is not None else value >= bound):
            return float(value)
        least = "above zero" if above is not None else "zero or more"
        self.d.error(
            codes.CELL_VALUE,
            f"`{key}` is {value}, but must be {least}, and finite",
            self.at(*path, key),
        )
        return default
