"""Built-in functions on strings and characters. Both are Python strings, characters of length 1, codes 0 to 255."""

from __future__ import annotations

import re
import string
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library.builtins_lists import collate
from pn2code.semantics.library.builtins_scan import from_string, scanner
from pn2code.semantics.values.data import (
    MAX_STRING,
    NONE,
    Data,
    MlException,
    Value,
    exception,
    joined,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]


def _substring(text: str, start: int, length: int) -> str:
    if start < 0 or length < 0 or start + length > len(text):
        raise MlException(exception("Subscript"))
    return text[start : start + length]


def _extract(e: Evaluator, p: tuple[str, int, Data]) -> str:
    text, start, length = p
    if length.name == "NONE":
        return _substring(text, start, max(0, len(text) - start))
    assert isinstance(length.argument, int)
    return _substring(text, start, length.argument)


def _char(code: int) -> str:
    if not 0 <= code <= 255:
        raise MlException(exception("Chr"))
    return chr(code)


def _map(e: Evaluator, function: Value, text: str) -> Task:
    found: list[str] = []
    for c in text:
        found.append((yield e.call(function, c)))
    return joined("", found)


def _fields(e: Evaluator, is_separator: Value, text: str) -> Task:
    found = [""]
    for c in text:
        if (yield e.call(is_separator, c)):
            found.append("")
        else:
            found[-1] += c
    return tuple(found)


def _tokens(e: Evaluator, is_separator: Value, text: str) -> Task:
    fields = yield _fields(e, is_separator, text)
    return tuple(field for field in fields if field)


_ESCAPES = {"\a": "a", "\b": "b", "\t": "t", "\n": "n", "\v": "v", "\f": "f", "\r": "r"}


def escaped(c: str) -> str:
    """A character as in a literal of SML."""
    if c in ('"', "\\"):
        return "\\" + c
    if c in _ESCAPES:
        return "\\" + _ESCAPES[c]
    if ord(c) < 32:
        return "\\^" + chr(ord(c) + 64)
    return c if ord(c) < 127 else f"\\{ord(c):03d}"


def c_escaped(c: str) -> str:
    """A character as in a literal of C."""
    if c in "\\\"?'":
        return "\\" + c
    if c in _ESCAPES:
        return "\\" + _ESCAPES[c]
    return c if 32 <= ord(c) < 127 else f"\\{ord(c):03o}"


_UNESCAPES = {letter: c for c, letter in _ESCAPES.items()} | {'"': '"', "\\": "\\"}
_ESCAPE = re.compile(r'\\(?:([abtnvfr"\\])|\^([@-_])|([0-9]{3})|u([0-9a-fA-F]{4}))')
_GAP = re.compile(r"\\[ \t\n\v\f\r]+\\")
_C_ESCAPE = re.compile(r"\\(?:([abtnvfr\"\\?'])|\^([@-_])|([0-7]{1,3})|x([0-9a-fA-F]+))")


def _skip_gaps(text: str, at: int) -> int:
    while gap := _GAP.match(text, at):
        at = gap.end()
    return at


def _read_char(text: str, at: int, *, c_style: bool = False) -> tuple[str, int] | None:
    """A printable character or an escape in a text from a position on: it and the position behind it."""
    if not c_style:
        at = _skip_gaps(text, at)
    if at >= len(text) or not " " <= text[at] <= "~":
        return None
    if text[at] != "\\":
        return text[at], at + 1
    found = (_C_ESCAPE if c_style else _ESCAPE).match(text, at)
    if found is None:
        return None
    letter, control, number, hexadecimal = found.groups()
    if letter is not None:
        return _UNESCAPES.get(letter, letter), found.end()
    if control is not None:
        return chr(ord(control) - 64), found.end()
    code = int(number, 8 if c_style else 10) if number is not None else int(hexadecimal, 16)
    return (chr(code), found.end()) if code <= 255 else None


def _unescape(text: str, *, c_style: bool = False) -> Data:
    """`String.fromString`: up to what cannot be read; NONE when that is at the start."""
    found: list[str] = []
    at = 0
    while item := _read_char(text, at, c_style=c_style):
        found.append(item[0])
        at = item[1]
    if not found and _skip_gaps(text, 0) < len(text):
        return NONE
    return some("".join(found))


def _first_char(e: Evaluator, text: str) -> tuple[Value, int] | None:
    return _read_char(text, 0)


def _first_c_char(e: Evaluator, text: str) -> tuple[Value, int] | None:
    return _read_char(text, 0, c_style=True)


def _collate(e: Evaluator, compare: Value, p: tuple[str, str]) -> Task:
    return collate(e, compare, (tuple(p[0]), tuple(p[1])))


def _is_between(low: str, high: str) -> tuple[int, Function]:
    return 1, lambda e, c: low <= c <= high


CONSTANTS: dict[str, Value] = {
    "String.maxSize": MAX_STRING,
    "Char.minChar": "\0",
    "Char.maxChar": "\xff",
    "Char.maxOrd": 255,
}


def _is_in(characters: str) -> tuple[int, Function]:
    return 1, lambda e, c: c in characters


def _to_upper(c: str) -> str:
    return c.upper() if c in string.ascii_lowercase else c


def _to_lower(c: str) -> str:
    return c.lower() if c in string.ascii_uppercase else c


FUNCTIONS: dict[str, tuple[int, Function]] = {
    "String.^": (1, lambda e, p: p[0] + p[1]),
    "String.size": (1, lambda e, s: len(s)),
    "String.sub": (1, lambda e, p: _substring(p[0], p[1], 1)),
    "String.substring": (1, lambda e, p: _substring(p[0], p[1], p[2])),
    "String.extract": (1, _extract),
    "String.concat": (1, lambda e, parts: joined("", parts)),
    "String.concatWith": (2, lambda e, separator, parts: joined(separator, parts)),
    "String.str": (1, lambda e, c: c),
    "String.explode": (1, lambda e, s: tuple(s)),
    "String.implode": (1, lambda e, chars: "".join(chars)),
    "String.map": (2, _map),
    "String.translate": (2, _map),
    "String.tokens": (2, _tokens),
    "String.fields": (2, _fields),
    "String.isPrefix": (2, lambda e, part, s: s.startswith(part)),
    "String.isSuffix": (2, lambda e, part, s: s.endswith(part)),
    "String.isSubstring": (2, lambda e, part, s: part in s != ""),
    "String.collate": (2, _collate),
    "String.toString": (1, lambda e, s: "".join(map(escaped, s))),
    "String.fromString": (1, lambda e, s: _unescape(s)),
    "String.toCString": (1, lambda e, s: "".join(map(c_escaped, s))),
    "String.fromCString": (1, lambda e, s: _unescape(s, c_style=True)),
    "Char.contains": (2, lambda e, s, c: c in s),
    "Char.notContains": (2, lambda e, s, c: c not in s),
    "Char.isAscii": _is_between("\0", "\x7f"),
    "Char.isCntrl": (1, lambda e, c: c < " " or c == "\x7f"),
    "Char.isGraph": _is_between("!", "~"),
    "Char.isPrint": _is_between(" ", "~"),
    "Char.fromString": (1, from_string(_first_char)),
    "Char.scan": (2, scanner(_first_char, lambda c: " " <= c <= "~")),
    "Char.toCString": (1, lambda e, c: c_escaped(c)),
    "Char.fromCString": (1, from_string(_first_c_char)),
    "Char.ord": (1, lambda e, c: ord(c)),
    "Char.chr": (1, lambda e, code: _char(code)),
    "Char.toString": (1, lambda e, c: escaped(c)),
    "Char.succ": (1, lambda e, c: _char(ord(c) + 1)),
    "Char.pred": (1, lambda e, c: _char(ord(c) - 1)),
    "Char.isDigit": _is_in(string.digits),
    "Char.isAlpha": _is_in(string.ascii_letters),
    "Char.isAlphaNum": _is_in(string.ascii_letters + string.digits),
    "Char.isSpace": _is_in(" \t\n\v\f\r"),
    "Char.isUpper": _is_in(string.ascii_uppercase),
    "Char.isLower": _is_in(string.ascii_lowercase),
    "Char.isPunct": _is_in(string.punctuation),
    "Char.isHexDigit": _is_in(string.hexdigits),
    "Char.toUpper": (1, lambda e, c: _to_upper(c)),
    "Char.toLower": (1, lambda e, c: _to_lower(c)),
}
