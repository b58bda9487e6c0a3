"""Typed access to one table of cell.toml, which reports what is wrong with it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

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
    """

    def __init__(
        self, data: Any, path: tuple[str | int, ...], at: Locate, d: Diagnostics, whole: object
    ) -> None:
        self.path, self._at, self.d, self._whole = path, at, d, whole
        self._used: list[str] = []
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
            f"{self._words(key)} is `{self.data[key]}`, but {expected} is expected",
            self.at(key),
            hint=hint,
        )

    def has(self, key: str, required: bool, expected: str) -> bool:
        """Whether there is a key, which is known then; without a required one there is an error."""
        self._used.append(key)
        if key not in self.data and required:
            self.d.error(
                codes.ROBOT_KEY,
                f"{self._words(key)} is missing",
                self.at(),
                hint=f"add `{key} = ...`: {expected}",
            )
        return key in self.data

    def number(
        self,
        key: str,
        default: float | None = None,
        *,
        low: float = -math.inf,
        high: float = math.inf,
        open_low: bool = False,
    ) -> float:
        """A finite number from `low` (above it, if `open_low`) to `high`; required without a default.

        Lengths are in m and angles in degrees, as in the file.
        """
        bounds = f" {'above' if open_low else 'from'} {low:g}" if low > -math.inf else ""
        bounds += f" to {high:g}" if high < math.inf else ""
        expected = f"a number{bounds}"
        fallback = 1.0 if default is None else default
        if not self.has(key, default is None, expected):
            return fallback
        value = self.data[key]
        if not is_number(value) or not (low < value if open_low else low <= value) or value > high:
            self.wrong(key, expected)
            return fallback
        return float(value)

    def positive(self, key: str, default: float | None = None, *, high: float = math.inf) -> float:
        """A number above 0."""
        return self.number(key, default, low=0.0, high=high, open_low=True)

    def numbers(self, key: str, count: int | None, default: tuple[float, ...]) -> tuple[float, ...]:
        """A list of `count` finite numbers; None: of any length."""
        expected = "a list of numbers" if count is None else f"a list of {count} numbers"
        if not self.has(key, False, expected):
            return default
        value = self.data[key]
        if (
            not isinstance(value, list)
            or not all(map(is_number, value))
            or len(value) != (len(value) if count is None else count)
        ):
            self.wrong(key, expected)
            return default
        return tuple(map(float, value))

    def text(self, key: str, default: str | None = None, expected: str = "a name") -> str:
        """A text that is not empty; required without a default, and "" after an error."""
        if not self.has(key, default is None, expected):
            return default or ""
        value = self.data[key]
        if not isinstance(value, str) or not value:
            self.wrong(key, expected)
            return default or ""
        return value

    def flag(self, key: str, default: bool) -> bool:
        """A truth value."""
        if not self.has(key, False, "true or false"):
            return default
        if not isinstance(self.data[key], bool):
            self.wrong(key, "`true` or `false`")
            return default
        return bool(self.data[key])

    def table(self, key: str) -> Table:
        """A table within this one; KeyError if it is not there."""
        self._used.append(key)
        return Table(self.data[key], (*self.path, key), self._at, self.d, self._whole)

    def tables(self, key: str) -> list[Table]:
        """The tables of a list; none if it is not there."""
        self._used.append(key)
        value = self.data.get(key, [])
        if not isinstance(value, list):
            self.wrong(key, "a list of tables")
            return []
        return [
            Table(v, (*self.path, key, i), self._at, self.d, self._whole)
            for i, v in enumerate(value)
        ]

    def done(self) -> None:
        """Report the keys that nobody has asked for."""
        for key in self.data:
            if key not in self._used:
                self.d.error(
                    codes.ROBOT_KEY,
                    f"unknown key `{key}` in {self._words()}",
                    self.at(key),
                    hint=did_you_mean(
                        key, self._used, f"known keys: {', '.join(sorted(set(self._used)))}"
                    ),
                )


def is_number(value: object) -> bool:
    """Whether it is a finite number; truth values are none."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
