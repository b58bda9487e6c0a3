"""Keys and sections of cell.toml, as data.

SUPERVISOR["reply_timeout_s"].default       # 120.0
PRIMITIVE.names("tool")                     # of a primitive with `command = "tool"`
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Literal

from pn2code.base.frozen import frozen

Kind = Literal[
    "text",
    "whole",
    "number",
    "flag",
    "scalar",
    "numbers",
    "texts",
    "table",
    "tables",
    "named",
    "entries",
]
"""What a value is. scalar: a text, number or truth value; named: tables, each with a name that is chosen; entries:
a value for each of some names."""

FARTHEST = 1000.0
"""m: the greatest length and the farthest coordinate. Greater numbers would leave no digits for what is near."""

Value = str | int | float | bool | tuple[float, ...] | tuple[str, ...]


@frozen
class Key:
    """A key.

    Args:
        name: as it is written; of what has no name of its own: what is chosen, in capitals.
        kind: what its value is.
        meaning: what it does, a sentence or two.
        expected: what is expected, in the words of messages.
        default: what is meant where the key is missing; None: nothing.
        required: whether it must be there; "together": as soon as anything of its section is, but the page.
        unit: of numbers.
        low, high: of numbers: the least and the greatest; above: more than the least.
        words: of a text: the only ones.
        counts: of numbers: how many there may be; (): any number.
        inner: of tables: what is in one.
        of: of entries: what each value is.
        only: the words of the deciding key with which it may be there; (): all.
        entry: of named tables and entries: what the name is.
        is_word: whether the names are words of letters, digits and `_`.
    """

    name: str
    kind: Kind
    meaning: str
    expected: str = ""
    default: Value | None = None
    required: bool | Literal["together"] = False
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    above: bool = False
    words: tuple[str, ...] = ()
    counts: tuple[int, ...] = ()
    inner: Section | None = None
    of: Key | None = None
    only: tuple[str, ...] = ()
    entry: str = ""
    is_word: bool = False

    def within(self, number: float) -> bool:
        """Whether a number may be its value."""
        low = self.least < number if self.above else self.least <= number
        return math.isfinite(number) and low and number <= self.most

    @property
    def least(self) -> float:
        """The least number that may be its value, or the one above which it must be."""
        return max(self.low, -FARTHEST) if self.unit == "m" else self.low

    @property
    def most(self) -> float:
        """The greatest number that may be its value."""
        return min(self.high, FARTHEST) if self.unit == "m" else self.high


@frozen
class Section:
    """The keys of a table.

    Args:
        by: the key on whose word it depends which others there may be; "": none.
        is_partial: whether it changes another table, so that nothing need be there.
    """

    keys: tuple[Key, ...]
    by: str = ""
    is_partial: bool = False

    def __getitem__(self, name: str) -> Key:
        """The key of that name; KeyError if there is none."""
        for key in self.keys:
            if key.name == name:
                return key
        raise KeyError(name)

    def key(self, name: str, word: str) -> Key:
        """The key of that name that there may be with a word of the deciding key; KeyError if there is none."""
        for key in self.keys:
            if key.name == name and (not key.only or word in key.only):
                return key
        raise KeyError(name)

    def __iter__(self) -> Iterator[Key]:
        return iter(self.keys)

    def names(self, word: str = "") -> set[str]:
        """Of the keys that there may be with a word of the deciding key; "": of all."""
        return {k.name for k in self.keys if not word or not k.only or word in k.only}

    def without(self, *names: str) -> Section:
        """The same without some keys."""
        return Section(tuple(k for k in self.keys if k.name not in names), self.by, self.is_partial)
