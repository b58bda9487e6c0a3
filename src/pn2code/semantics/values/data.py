"""Values of CPN ML in Python: immutable, hashable, without a trace of their types.

| CPN ML | Python |
|---|---|
| `int`, `IntInf.int` | `int` (the operations on `int` check the 31 bits) |
| `real` | `float` |
| `string`, `char` | `str` |
| `bool` | `bool` |
| record, tuple, `unit` | `tuple` of the fields, in SML's order of the labels |
| list, multi-set, vector | `tuple` of the elements |
| `word`, `Time.time` (nanoseconds) | `int` |
| other data types, exceptions | `Data` |
| `v@s` | `Timed` |
| `ref`, `array` | `Ref`, `Array`, equal only to themselves |
| `substring` | `Slice` |
| `instream`, `outstream` | `Stream`, see `files` |
| function | `Closure` or `Native` |

A value alone does not tell a list from a tuple: its type does, and every user of a value knows the type.
"""

from __future__ import annotations

import math
import struct
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Any

from pn2code.base.frozen import frozen, record
from pn2code.ml.library.exceptions import EXCEPTIONS

if TYPE_CHECKING:
    from pn2code.diagnostics import Span
    from pn2code.ml.core.terms import Rule

MAX_INT = 2**30 - 1
"""Largest `int`: CPN Tools runs on a 31-bit SML (`Program.int_bits` may say 64)."""
MIN_INT = -(2**30)


def is_negative_zero(value: float) -> bool:
    """Whether it is the zero that equals 0.0, but of which `Real.signBit` is true."""
    return value == 0.0 and math.copysign(1.0, value) < 0.0


def zero_signs(value: Value) -> Iterator[bool]:
    """For each zero in a value, in order, whether it is negative."""
    match value:
        case float() if value == 0.0:
            yield is_negative_zero(value)
        case tuple():
            for part in value:
                yield from zero_signs(part)
        case Data(argument=argument) if argument is not None:
            yield from zero_signs(argument)
        case Timed(value=inner, stamp=stamp):
            yield from zero_signs(inner)
            yield from zero_signs(stamp)


@frozen
class Data:
    """A value made by a constructor: enumerations, unions, `SOME x`, user data types, exceptions.

    Args:
        name: the constructor.
        tag: its position among the constructors of its type.
        argument: its argument; None when it takes none (`()` when it takes the unit value).
    """

    name: str
    tag: int
    argument: Value | None = None


@frozen
class Timed:
    """A token with its absolute time stamp."""

    value: Value
    stamp: int | float


@record(eq=False)
class Ref:
    """A reference; the only value that changes."""

    contents: Value


@record(eq=False)
class Array:
    """An array; like a reference it changes, and is equal only to itself."""

    items: list[Value]


class Stream:
    """A stream of TextIO, or of the names in a folder; see `files`."""

    __slots__ = ()


@frozen
class Slice:
    """A substring: a part of a text."""

    text: str
    start: int
    length: int

    def __str__(self) -> str:
        """Return its characters."""
        return self.text[self.start : self.start + self.length]


@frozen(eq=False)
class Closure:
    """A function of the net: rules, and the values of the local variables around them."""

    rules: tuple[Rule, ...]
    environment: Mapping[int, Value] = field(repr=False)


@frozen(eq=False)
class Native:
    """A built-in function, perhaps with some of its curried arguments already there.

    Args:
        name: for messages.
        arity: number of curried arguments it wants in all.
        function: called with the evaluator and all the arguments. Gives the value, or a task
            (a generator, see `evaluate`) when it has to call functions of the net.
        arguments: those that are there.
    """

    name: str
    arity: int
    function: Callable[..., Any] = field(repr=False)
    arguments: tuple[Value, ...] = ()


Value = (
    int | float | str | tuple[Any, ...] | Data | Timed | Ref | Array | Slice | Stream | Closure | Native
)  # fmt: skip
"""Any value. Tuples hold values; the `Any` only avoids a recursive alias."""

UNIT: tuple[Value, ...] = ()
NONE = Data("NONE", 0)
ORDER = (Data("LESS", 0), Data("EQUAL", 1), Data("GREATER", 2))


def some(value: Value) -> Data:
    """`SOME value`."""
    return Data("SOME", 1, value)


def order(a: Any, b: Any) -> Data:
    """`LESS`, `EQUAL` or `GREATER` of two Python values that can be compared."""
    return ORDER[0] if a < b else ORDER[2] if b < a else ORDER[1]


class MlException(Exception):
    """An exception that CPN ML raised.

    Args:
        name: its constructor.
        value: the whole exception value.
        span: where it was raised, if that is known.
    """

    def __init__(self, value: Data, span: Span | None = None) -> None:
        super().__init__(value)
        self.name = value.name
        self.value = value
        self.span = span

    def __str__(self) -> str:
        """The name, with the argument when it is a text or a number."""
        argument = self.value.argument
        if isinstance(argument, str | int | float):
            return f"{self.name} ({argument})"
        return self.name


class MlUnavailable(Exception):
    """A function was applied that exists in CPN Tools but cannot run here; CPN ML cannot handle it."""


class MlLimit(Exception):
    """Evaluation went on for too long or too deep; CPN ML cannot handle it."""


MAX_STRING = 16_777_215
"""`String.maxSize`."""
MAX_ITEMS = 5_000_000
"""Elements of a list or a multi-set: evaluation gives up beyond, long before memory ends."""

MAX_BITS = 1_000_000
"""Of an unbounded integer."""
# All of them have a text; Python's own limit is 4,300 digits.
sys.set_int_max_str_digits(MAX_BITS // 3)


def fitting(count: int) -> int:
    """A number of elements.

    Raises:
        MlLimit: it is more than `MAX_ITEMS`.
    """
    if count > MAX_ITEMS:
        raise MlLimit(f"a list or a multi-set of {count:,} elements, more than {MAX_ITEMS:,}")
    return count


def joined(separator: str, parts: Sequence[str]) -> str:
    """Texts as one.

    Raises:
        MlException: Size, where it would be longer than a string can be; it is not even made then.
    """
    length = sum(map(len, parts)) + len(separator) * max(len(parts) - 1, 0)
    if length > MAX_STRING:
        raise MlException(exception("Size"))
    return separator.join(parts)


def exception(name: str, argument: Value | None = None) -> Data:
    """The value of a built-in exception; of one that CPN ML has no name for when it is not in the table."""
    known = EXCEPTIONS.get(name)
    return Data(name, known[0].tag if known else -1, argument)


def same(a: Value, b: Value) -> bool:
    """Whether they are one token: as `equal`, but what is no number (always the one `math.nan`) is itself."""
    return bool(a is b or a == b)


def equal(a: Value, b: Value) -> bool:
    """CPN ML's `=`: structural; reals by value (NaN differs from itself), references by identity.

    Works without recursion, so that deep values do no harm.
    """
    if isinstance(a, int | float | str):
        return a == b
    todo: list[tuple[Any, Any]] = [(a, b)]
    while todo:
        x, y = todo.pop()
        if isinstance(x, int | float | str):
            if x != y:
                return False
        elif isinstance(x, tuple):
            if len(x) != len(y):
                return False
            todo.extend(zip(x, y, strict=True))
        elif isinstance(x, Data):
            if x.tag != y.tag:
                return False
            if x.argument is not None:
                todo.append((x.argument, y.argument))
        elif isinstance(x, Timed):
            todo.extend(((x.value, y.value), (x.stamp, y.stamp)))
        elif isinstance(x, Closure | Native):
            raise TypeError("functions have no equality")
        elif isinstance(x, Ref | Array):
            if x is not y:
                return False
        elif x != y:
            return False
    return True


def float32(x: float) -> float:
    """The nearest value that a C `float` can hold; infinite when it is too large for one."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", x))[0])
    except OverflowError:
        return math.copysign(math.inf, x)


def int_text(i: int) -> str:
    """SML's `Int.toString`: `~` for minus."""
    return f"~{-i}" if i < 0 else str(i)


MOST_DIGITS = 15
"""SML/NJ finds no more of a real number, whatever is asked for."""


def real_digits(x: float, count: int, *, behind: bool = False) -> tuple[str, int]:
    """The decimal digits of a positive finite number as SML/NJ finds them, and the exponent of the first.

    It multiplies by ten with rounded arithmetic, so these are not always the digits of the nearest decimal number:
    770.285 has 770.29 with two places. A last digit that is just in the middle becomes even.

    Args:
        x: the number.
        count: how many digits; one more if they are rounded up to a power of ten.
        behind: `count` is the number of digits behind the point.
    """
    exponent = 0
    while x < 1.0:
        x, exponent = 10.0 * x, exponent - 1
    while x >= 10.0:
        x, exponent = 0.1 * x, exponent + 1
    if behind:
        count += exponent + 1
    digits: list[int] = []
    for _ in range(max(0, min(count, MOST_DIGITS))):
        digits.append(int(x))
        x = 10.0 * (x - digits[-1])
    is_odd = bool(digits) and digits[-1] % 2 == 1
    if x > 5.0 or (x == 5.0 and is_odd):
        at = len(digits) - 1
        while at >= 0 and digits[at] == 9:
            digits[at] = 0
            at -= 1
        if at >= 0:
            digits[at] += 1
        else:
            digits.insert(0, 1)
            exponent += 1
    return "".join(map(str, digits)), exponent


def real_text(x: float, precision: int = 12) -> str:
    """SML's `Real.toString`: at most 12 significant digits, `0.333333333333`, `1E~05`, `~1.5`, `2.0`.

    `precision`: another number of digits, as `Real.fmt (StringCvt.GEN (SOME precision))` has them.
    """
    if math.isnan(x):
        return "nan"
    if math.isinf(x):
        return "inf" if x > 0 else "~inf"
    sign = "~" if x < 0 or is_negative_zero(x) else ""
    if x == 0:
        return f"{sign}0.0"
    digits, exponent = real_digits(abs(x), precision)
    digits = digits.rstrip("0")
    if exponent < -4 or exponent >= precision:
        # SML/NJ writes a two-digit exponent at least only for small numbers: 1E~05, but 1E20.
        fraction = "." + digits[1:] if len(digits) > 1 else ""
        return f"{sign}{digits[0]}{fraction}E{_exponent(exponent)}"
    if exponent < 0:
        return f"{sign}0.{'0' * (-exponent - 1)}{digits}"
    whole, fraction = digits[: exponent + 1].ljust(exponent + 1, "0"), digits[exponent + 1 :]
    return f"{sign}{whole}.{fraction or '0'}"


def _exponent(exponent: int) -> str:
    return f"~{-exponent:02d}" if exponent < 0 else f"{exponent:02d}"
