"""Typed access to one table of cell.toml, which reports what is wrong with it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, cast

from pn2code.cell_file.keys import Key, Section
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.diagnostics.keys import in_words
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.robot import codes

Locate = Callable[..., Origin]
"""Origin of a key, given its path: `Locator.origin` of `pn2code.cell.toml_file`."""


class Table:
    """Typed access to one table, reporting what is wrong; unknown keys by `done`.

    What is wrong is an error in `d`, and a default stands in for it, so that the rest can be read.

    Args:
        data: what is in the file there; anything but a table is an error.
        path: of the table, in the file.
        at: gives the origin of a key.
        d: where errors go.
        whole: the whole file, to say in words which table it is.
        keys: what there may be in it; None: tables with names that are chosen, or nothing that is asked for by name.
    """

    def __init__(
        self,
        data: Any,
        path: tuple[str | int, ...],
        at: Locate,
        d: Diagnostics,
        whole: object,
        keys: Section | None,
    ) -> None:
        self.path, self._at, self.d, self._whole = path, at, d, whole
        self._keys = keys
        self.data: Mapping[str, Any] = data if isinstance(data, Mapping) else {}
        if not isinstance(data, Mapping):
            d.error(codes.ROBOT_VALUE, f"{self._words()} must be a table", at(*path))

    def at(self, key: str = "") -> Origin:
        """Where a key is, or the table."""
        return self._at(*self.path, key) if key else self._at(*self.path)

    def _words(self, *key: str) -> str:
        return in_words((*self.path, *key), self._whole)

    def wrong(self, key: str, expected: str, hint: str = "") -> None:
        """Report that the value of a key is not what is expected (in words)."""
        self.d.error(
            codes.ROBOT_VALUE,
            f"{self._words(key)} is `{self.data[key]}`, but {expected} {_are(expected)} expected",
            self.at(key),
            hint=hint,
        )

    def wrong_name(self, key: str, name: str, what: str, hint: str = "") -> None:
        """Report that a name in the list of a key is none of what it should be (in words)."""
        self.d.error(
            codes.ROBOT_VALUE,
            f"{self._words(key)} names `{name}`, which is no {what}",
            self.at(key),
            hint=hint,
        )

    @property
    def _word(self) -> str:
        """That of the key which decides what others there are; "" where there is none."""
        if self._keys is None or not self._keys.by:
            return ""
        return str(self.data.get(self._keys.by, self._keys[self._keys.by].default))

    def _key(self, name: str) -> Key:
        assert self._keys is not None, "tables with chosen names have no keys"
        return self._keys.key(name, self._word)

    def has(self, name: str) -> bool:
        """Whether there is a key; without a required one there is an error."""
        key = self._key(name)
        if name not in self.data and key.required:
            self.d.error(
                codes.ROBOT_KEY,
                f"{self._words(name)} is missing",
                self.at(),
                hint=f"add `{name} = ...`: {key.expected or _expected(key)}",
            )
        return name in self.data

    def number(self, name: str) -> float:
        """A finite number within its bounds; lengths are in m and angles in degrees, as in the file."""
        key = self._key(name)
        fallback = 1.0 if key.default is None else float(cast(float, key.default))
        if not self.has(name):
            return fallback
        value = self.data[name]
        if not is_number(value) or not key.within(value):
            self.wrong(name, _expected(key))
            return fallback
        return float(value)

    def whole(self, name: str) -> int:
        """A whole number within its bounds; the default where there is none."""
        key = self._key(name)
        fallback = cast(int, key.default)
        if not self.has(name):
            return fallback
        value = self.data[name]
        if not isinstance(value, int) or isinstance(value, bool) or not key.within(value):
            self.wrong(name, _expected(key))
            return fallback
        return value

    def numbers(self, name: str) -> tuple[float, ...]:
        """A list of finite numbers, as many as its key says; the default where there is none."""
        key = self._key(name)
        default = cast(
            tuple[float, ...], key.default or tuple(1.0 for _ in range(min(key.counts or (0,))))
        )
        if not self.has(name):
            return default
        value = self.data[name]
        if (
            not isinstance(value, list)
            or not all(map(is_number, value))
            or (key.counts and len(value) not in key.counts)
            or not all(map(key.within, value))
        ):
            self.wrong(name, _expected(key))
            return default
        return tuple(map(float, value))

    def texts(self, name: str) -> tuple[str, ...]:
        """A list of texts; none if it is not there."""
        value = self.data.get(name, [])
        if not self.has(name):
            return ()
        if not isinstance(value, list) or not all(isinstance(v, str) and v for v in value):
            self.wrong(name, "a list of names")
            return ()
        return tuple(value)

    def text(self, name: str) -> str:
        """A text that is not empty, one of the words of its key; the default or "" where there is none."""
        key = self._key(name)
        default = str(key.default or "")
        if not self.has(name):
            return default
        value = self.data[name]
        if not isinstance(value, str) or not value or (key.words and value not in key.words):
            self.wrong(name, key.expected or _expected(key))
            return default
        return value

    def flag(self, name: str) -> bool:
        """A truth value."""
        default = bool(self._key(name).default)
        if not self.has(name):
            return default
        if not isinstance(self.data[name], bool):
            self.wrong(name, "`true` or `false`")
            return default
        return bool(self.data[name])

    def table(self, name: str) -> Table:
        """A table within this one; KeyError if it is not there."""
        return self._inner(self.data[name], (name,), self._key(name).inner)

    def named(self, inner: Section) -> list[tuple[str, Table]]:
        """The tables within this one, each with its name."""
        return [(name, self._inner(self.data[name], (name,), inner)) for name in self.data]

    def inside(self, *path: str) -> Table:
        """The table at a path within this one, with names that are chosen; KeyError if it is not there."""
        data: Any = self.data
        for name in path:
            data = data[name]
        return self._inner(data, path, None)

    def only(self, name: str, keys: Section) -> Table:
        """The table of a name with some of its keys, as if it had no others."""
        data = {key: value for key, value in self.data[name].items() if key in keys.names()}
        return self._inner(data, (name,), keys)

    def inner(self, name: str) -> Section:
        """What is in each of the tables with chosen names that a key has."""
        inner = self._key(name).inner
        assert inner is not None, "it is a key of tables"
        return inner

    def expected(self, name: str) -> str:
        """What the value of a key may be, in words."""
        key = self._key(name)
        return key.expected or _expected(key)

    def tables(self, name: str) -> list[Table]:
        """The tables of a list; none if it is not there."""
        inner = self._key(name).inner
        value = self.data.get(name, [])
        if not isinstance(value, list):
            self.wrong(name, "a list of tables")
            return []
        if not value and name in self.data and self._key(name).required:
            self.wrong(name, "a list of at least one table")
        return [self._inner(v, (name, i), inner) for i, v in enumerate(value)]

    def _inner(self, data: Any, path: tuple[str | int, ...], keys: Section | None) -> Table:
        return Table(data, (*self.path, *path), self._at, self.d, self._whole, keys)

    def done(self) -> None:
        """Report the keys that there may not be."""
        assert self._keys is not None, "tables with chosen names have no keys"
        known = self._keys.names(self._word)
        for key in self.data:
            if key not in known:
                self.d.error(
                    codes.ROBOT_KEY,
                    f"unknown key `{key}` in {self._words()}",
                    self.at(key),
                    hint=did_you_mean(key, known, f"known keys: {', '.join(sorted(known))}"),
                )


def _are(expected: str) -> str:
    return "are" if expected.startswith("three ") else "is"


def _expected(key: Key) -> str:
    """What the value of a key may be, in words."""
    if key.words:
        return f"one of {', '.join(key.words)}"
    if key.kind == "numbers":
        *some, last = (_COUNTS[n] for n in key.counts) if key.counts else ("",)
        count = f"{', '.join(some)} or {last}" if some else last
        bounds = _bounds(key)
        return f"a list of {count} numbers{bounds}" if count else f"a list of numbers{bounds}"
    if key.kind == "whole":
        return f"a whole number{_bounds(key)}"
    return f"a number{_bounds(key)}" if key.kind == "number" else "a name"


_COUNTS = {3: "three", 4: "four", 6: "six", 7: "seven"}


def _bounds(key: Key) -> str:
    low = f" {'above' if key.above else 'from'} {key.least:g}" if key.least > -math.inf else ""
    return low + (f" to {key.most:g}" if key.most < math.inf else "")


def is_number(value: object) -> bool:
    """Whether it is a finite number; truth values are none."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
