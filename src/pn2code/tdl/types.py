"""Types of the script language, and its units.

A quantity is a number with a dimension. Inside the language every length is in mm, every angle in
degrees, every time in s, every speed in mm/s: literals are converted when they are read (`1 m` is
`1000 mm`), and commands are converted to SI when they leave the interpreter.
"""

from __future__ import annotations

import math
from enum import Enum

from pn2code.base.frozen import frozen


class Type(Enum):
    """The type of a value."""

    INT = "int"
    REAL = "real"
    BOOL = "bool"
    STRING = "string"
    POSE = "pose"
    LENGTH = "length"
    ANGLE = "angle"
    TIME = "time"
    SPEED = "speed"
    WORD = "word"
    """A constructor's name, in a message without quotes, in the script a string: only files can be of this type."""
    INTS = "ints"
    """A list, as the next five."""
    REALS = "reals"
    BOOLS = "bools"
    STRINGS = "strings"
    POSES = "poses"
    WORDS = "words"
    """A list of constructors' names: only files can be of this type."""
    SIGNAL = "signal"
    """The message without content: only files can be of this type."""

    def __str__(self) -> str:
        """As scripts write it."""
        return self.value


NUMBERS = frozenset({Type.INT, Type.REAL})
QUANTITIES = frozenset({Type.LENGTH, Type.ANGLE, Type.TIME, Type.SPEED})
TYPES_BY_NAME: dict[str, Type] = {t.value: t for t in Type}

ELEMENT: dict[Type, Type] = {
    Type.INTS: Type.INT,
    Type.REALS: Type.REAL,
    Type.BOOLS: Type.BOOL,
    Type.STRINGS: Type.STRING,
    Type.POSES: Type.POSE,
    Type.WORDS: Type.WORD,
}
"""What the elements of a list are."""
ROWS = "rows"
"""How files say that they hold a list of records: `rows(int, word)`. In the script each column is a list."""
LIST_OF: dict[Type, Type] = {element: of for of, element in ELEMENT.items()}
LISTS = frozenset(ELEMENT)
IN_SCRIPT: dict[Type, Type] = {Type.WORD: Type.STRING, Type.WORDS: Type.STRINGS}
"""What values of types that only files can have are in the script."""

BASE_UNIT: dict[Type, str] = {
    Type.LENGTH: "mm",
    Type.ANGLE: "deg",
    Type.TIME: "s",
    Type.SPEED: "mm/s",
}


@frozen
class Unit:
    """A unit: its dimension and how many base units it is."""

    type: Type
    factor: float


UNITS: dict[str, Unit] = {
    "mm": Unit(Type.LENGTH, 1.0),
    "cm": Unit(Type.LENGTH, 10.0),
    "m": Unit(Type.LENGTH, 1000.0),
    "deg": Unit(Type.ANGLE, 1.0),
    "rad": Unit(Type.ANGLE, 180.0 / math.pi),
    "s": Unit(Type.TIME, 1.0),
    "ms": Unit(Type.TIME, 0.001),
    "min": Unit(Type.TIME, 60.0),
    "mm/s": Unit(Type.SPEED, 1.0),
    "m/s": Unit(Type.SPEED, 1000.0),
    "%": Unit(Type.REAL, 0.01),
}
"""Unit literals of the language; `%` makes a plain number (`50 %` is `0.5`)."""

POSE_FIELDS: dict[str, Type] = {
    "x": Type.LENGTH,
    "y": Type.LENGTH,
    "z": Type.LENGTH,
    "rx": Type.ANGLE,
    "ry": Type.ANGLE,
    "rz": Type.ANGLE,
}

MAX_INT = 2**30 - 1
MIN_INT = -(2**30)
"""Integers have 31 bits, as in CPN Tools, so that a script and its net overflow at the same value."""


def fits(found: Type, wanted: Type) -> bool:
    """Whether a value of type `found` may stand where `wanted` is expected; an int is also a real."""
    return found is wanted or (found is Type.INT and wanted is Type.REAL)


def product(a: Type, b: Type) -> Type | None:
    """The type of `a * b`, None where the product has no meaning."""
    if a in NUMBERS and b in NUMBERS:
        return Type.INT if a is b is Type.INT else Type.REAL
    if a in NUMBERS and b in QUANTITIES:
        return b
    if a in QUANTITIES and b in NUMBERS:
        return a
    if {a, b} == {Type.SPEED, Type.TIME}:
        return Type.LENGTH
    return None


def quotient(a: Type, b: Type) -> Type | None:
    """The type of `a / b`, None where the quotient has no meaning."""
    if a in NUMBERS and b in NUMBERS:
        return Type.REAL
    if a in QUANTITIES and b in NUMBERS:
        return a
    if a in QUANTITIES and a is b:
        return Type.REAL
    return {
        (Type.LENGTH, Type.TIME): Type.SPEED,
        (Type.LENGTH, Type.SPEED): Type.TIME,
    }.get((a, b))
