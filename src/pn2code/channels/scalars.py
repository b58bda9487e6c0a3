"""The scalars of a token as one line of text (docs/protocol.md, "Format").

`format_scalars` and `parse_scalars` write and read what `cnative/src/channel/pn_channel.c` reads and writes, to the
last digit.

    scalars = scalars_of(pose)                      # (Scalar(REAL, "x", "COORD"), Scalar(REAL, "y", "COORD"))
    format_scalars(scalars, (5750.0, 166.66666))    # "5750.0000 166.66666"
    parse_scalars(scalars, "5750 166.66666")        # (5750.0, 166.66666)
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import Any

from pn2code.base.frozen import frozen
from pn2code.cell.scalars import MOST_ROOM, Scalar, ScalarKind

ScalarValue = bool | int | float | str
"""BOOL: bool. INT, INDEX: int. REAL: float. STRING: str. ENUM: the constructor's name. UNIT: 1. LIST: its length, and
then the values of its elements.
"""


@frozen
class Malformed:
    """Text that is no token of the colour set: what was found, what was expected, and where (1-based column)."""

    text: str
    column: int
    wrong_count: bool = False


def scalars_of_json(data: Any) -> Iterator[ScalarValue]:
    """The scalars of a token in the form of traces, in the declared order of its colour set."""
    match data:
        case list():
            for item in data:
                yield from scalars_of_json(item)
        case dict():
            for item in data.values():
                yield from scalars_of_json(item)
        case None:
            yield 1  # unit
        case _:
            yield data


class Walk:
    """Goes along the scalars of a message: those of a list's elements come as often as the list is long.

    walk = Walk(scalars)
    while (scalar := walk.next()) is not None:
        ...                         # its value
        walk.enter(scalar, 3)       # it is a LIST of this length
    """

    def __init__(self, scalars: Sequence[Scalar]) -> None:
        self._scalars = scalars
        self._next = 0
        self._elements: tuple[Scalar, ...] = ()
        self._left = 0
        """values of the list that are still to come"""

    def next(self) -> Scalar | None:
        """The scalar of the next value; None at the end."""
        if self._left:
            self._left -= 1
            return self._elements[-1 - self._left % len(self._elements)]
        if self._next == len(self._scalars):
            return None
        self._next += 1
        return self._scalars[self._next - 1]

    def enter(self, scalar: Scalar, length: int) -> None:
        """What `next` gave last is a list of this length."""
        self._elements, self._left = scalar.elements, length * len(scalar.elements)

    @property
    def rest(self) -> int:
        """How many values are still to come at least."""
        return self._left + len(self._scalars) - self._next


def scalars_of_values(
    scalars: Sequence[Scalar], values: Sequence[ScalarValue]
) -> list[Scalar] | None:
    """The scalar of each value; None where the values are too many or too few, or a list has an impossible length."""
    walk = Walk(scalars)
    out: list[Scalar] = []
    for value in values:
        scalar = walk.next()
        if scalar is None:
            return None
        out.append(scalar)
        if scalar.kind is ScalarKind.LIST:
            if type(value) is not int or not 0 <= value <= len(values):
                return None
            walk.enter(scalar, value)
    return None if walk.rest else out


def format_real(value: float) -> str:
    """Four decimals where that reads back to the same number, otherwise the fewest digits that do.

    A zero keeps its sign, which a net can see (`1.0 / x`): what arrives is what was sent.
    """
    text = f"{value:.4f}"
    if float(text) == value:
        return text

    def suffices(digits: int) -> bool:
        return float(f"{value:.{digits}g}") == value

    # the same search as pn_real_format in pn_channel.c, so that both give the same text
    most = next(digits for digits in (15, 16, 17) if digits == 17 or suffices(digits))
    least = 1 if most == 15 else most
    while least < most:
        middle = (least + most) // 2
        if suffices(middle):
            most = middle
        else:
            least = middle + 1
    return f"{value:.{most}g}"


def _format_string(value: str) -> str | None:
    """None: it has characters beyond those of CPN ML, which are bytes."""
    out = []
    if any(ord(c) > 0xFF for c in value):
        return None
    for byte in value.encode("latin-1"):
        if byte in b'"\\':
            out.append("\\" + chr(byte))
        elif 0x20 <= byte < 0x7F:
            out.append(chr(byte))
        else:
            out.append(f"\\x{byte:02x}")
    return '"' + "".join(out) + '"'


def _in_range(scalar: Scalar, value: float) -> bool:
    """Whether a number is in the range of its colour set, and an integer in 64 bits."""
    low, high = scalar.low, scalar.high
    fits = scalar.kind is ScalarKind.REAL or -(2**63) <= value < 2**63
    return fits and (low is None or value >= low) and (high is None or value <= high)


def _is_length(scalar: Scalar, length: int) -> bool:
    low, high = scalar.low or 0, scalar.high
    return low <= length and (high is None or length <= high)


def _is_constructor(scalar: Scalar, word: str) -> bool:
    """Of those that are known; else anything that CPN ML takes for a name."""
    return word in scalar.names if scalar.names else _NAME.fullmatch(word) is not None


def _format_scalar(scalar: Scalar, value: ScalarValue) -> str | None:
    match scalar.kind:
        case ScalarKind.UNIT:
            return "1"
        case ScalarKind.BOOL:
            return "1" if value else "0"
        case ScalarKind.INT | ScalarKind.INDEX:
            fits = not isinstance(value, (str, float)) and _in_range(scalar, int(value))
            return str(int(value)) if fits else None
        case ScalarKind.LIST:
            return str(value) if _is_length(scalar, int(value)) else None
        case ScalarKind.REAL:
            if isinstance(value, str) or not math.isfinite(value) or not _in_range(scalar, value):
                return None
            return format_real(float(value))
        case ScalarKind.STRING:
            return _format_string(value) if isinstance(value, str) else None
        case ScalarKind.ENUM:
            return value if isinstance(value, str) and _is_constructor(scalar, value) else None


def format_scalars(
    scalars: Sequence[Scalar], values: Sequence[ScalarValue], room: int = MOST_ROOM
) -> str | None:
    """One line without its end; None when the values do not fit (their number, their kinds, not finite)."""
    of_each = scalars_of_values(scalars, values)
    if of_each is None or len(values) > room:
        return None
    words = [_format_scalar(s, v) for s, v in zip(of_each, values, strict=True)]
    return None if any(w is None for w in words) else " ".join(w for w in words if w is not None)


_WORD = re.compile(r'(?:"(?:\\.|[^"\\])*"?|[^ \t\r"])+')
_INTEGER = re.compile(r"[-+]?[0-9]+")
_LENGTH = re.compile(r"0|[1-9][0-9]{0,3}")
"""Of a list: no message has as many values as to need five digits."""
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_']*")
_MOST_NAMES = 8
"""Constructors that a message names."""
_MAX_NUMBER = 512
"""No number's text is as long."""
_ESCAPE = re.compile(r'\\(?:(["\\])|x([0-9a-f]{2}))')
_STRING = re.compile(r'"(?:[^"\\]|\\["\\]|\\x[0-9a-f]{2})*"')


def quote(text: str) -> str:
    """Foreign text for a message: printable, between back-ticks, not longer than some 60 characters."""
    shown = "".join(
        "\\n" if c == "\n" else c if " " <= c < "\x7f" and c != "`" else f"\\x{ord(c) & 0xFF:02x}"
        for c in text[:60]
    )
    return f"`{shown}`" + ("..." if len(text) > 60 else "")


def _where(scalar: Scalar) -> str:
    """The component and its colour set; the latter alone where the token is one scalar."""
    colset = f"colour set `{scalar.colset}`"
    return colset if scalar.label == scalar.colset else f"`{scalar.label}` of {colset}"


def _no_constructor(scalar: Scalar, word: str) -> str:
    component = "" if scalar.label == scalar.colset else f" (component `{scalar.label}`)"
    values = f"; its values are {', '.join(f'`{n}`' for n in scalar.names[:_MOST_NAMES])}"
    if len(scalar.names) > _MOST_NAMES:
        values += ", ..."
    return (
        f"{quote(word)} is not a value of colour set `{scalar.colset}`{component}"
        f"{values if scalar.names else ''}"
    )


def _parse_scalar(scalar: Scalar, word: str) -> ScalarValue | str:
    """The value, or (as `_Wrong`) what is wrong with the word."""
    where = _where(scalar)
    value: ScalarValue
    match scalar.kind:
        case ScalarKind.UNIT:
            return 1 if word == "1" else _Wrong(f"{quote(word)} where {where} is `1`")
        case ScalarKind.BOOL:
            if word not in ("0", "1"):
                return _Wrong(f"{quote(word)} is neither `0` nor `1` ({where})")
            return word == "1"
        case ScalarKind.ENUM:
            is_one = _is_constructor(scalar, word)
            return word if is_one else _Wrong(_no_constructor(scalar, word))
        case ScalarKind.STRING:
            if _STRING.fullmatch(word) is None:
                return _Wrong(f"{quote(word)} is not a string in double quotes ({where})")
            return _ESCAPE.sub(lambda m: m[1] or chr(int(m[2], 16)), word[1:-1])
        case ScalarKind.LIST:
            return _parse_length(scalar, word)
        case ScalarKind.INT | ScalarKind.INDEX:
            if _INTEGER.fullmatch(word) is None:
                return _Wrong(f"{quote(word)} is not an integer ({where})")
            if len(word) >= _MAX_NUMBER:
                return _Wrong(f"{quote(word)} is too long for a number ({where})")
            value = int(word)
            if not -(2**63) <= value < 2**63:
                return _Wrong(f"{quote(word)} is too large for an integer ({where})")
        case ScalarKind.REAL:
            if _NUMBER.fullmatch(word) is None:
                return _Wrong(f"{quote(word)} is not a number ({where})")
            if len(word) >= _MAX_NUMBER:
                return _Wrong(f"{quote(word)} is too long for a number ({where})")
            value = float(word)
            if not math.isfinite(value):
                return _Wrong(f"{quote(word)} is too large for a real number ({where})")
    if not _in_range(scalar, value):
        text = f"{quote(word)} is outside {where}, which goes from {scalar.low} to {scalar.high}"
        return _Wrong(text)
    return value


def _parse_length(scalar: Scalar, word: str) -> int | _Wrong:
    """How many elements follow: decimal digits, as few as there can be."""
    is_number = _LENGTH.fullmatch(word) is not None
    if not is_number or not _is_length(scalar, int(word)):
        return _Wrong(f"{quote(word)} is no length of a list of {_where(scalar)}")
    return int(word)


class _Wrong(str):
    """What is wrong with a word: not the value of one, which may be a text, too."""

    __slots__ = ()


def parse_scalars(
    scalars: Sequence[Scalar], line: str, room: int = MOST_ROOM
) -> tuple[ScalarValue, ...] | Malformed:
    """Reads one line strictly: exactly these scalars, separated by blanks, and no more than there is room for."""
    values: list[ScalarValue] = []
    walk = Walk(scalars)
    for match in _WORD.finditer(line):
        scalar = walk.next()
        if scalar is None:
            found = quote(match[0])
            return Malformed(
                f"found {found} after the {len(values)} values", match.start() + 1, True
            )
        value = _parse_scalar(scalar, match[0])
        if isinstance(value, _Wrong):
            return Malformed(str(value), match.start() + 1)
        values.append(value)
        if scalar.kind is ScalarKind.LIST:
            walk.enter(scalar, int(value))
        if len(values) + walk.rest > room:
            text = f"{quote(match[0])} makes more than the {room:,} values that are possible"
            return Malformed(text, match.start() + 1, True)
    if walk.rest:
        expected = len(values) + walk.rest
        missing = walk.next()
        assert missing is not None
        text = (
            f"found {len(values)} values where {expected} are expected; "
            f"the next would be {_where(missing)}"
        )
        return Malformed(text, len(line) + 1, True)
    return tuple(values)
