"""Built-in functions on strings and characters. Both are Python strings, characters of length 1, codes 0 to 255."""

from __future__ import annotations

import string
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.values import Data, MlException, Value, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluate import Evaluator, Task

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
    return "".join(found)


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


def _escaped(c: str) -> str:
    """A character as in a literal of SML."""
    if c in ('"', "\\"):
        return "\\" + c
    if c in _ESCAPES:
        return "\\" + _ESCAPES[c]
    if ord(c) < 32:
        return "\\^" + chr(ord(c) + 64)
    return c if ord(c) < 127 else f"\\{ord(c):03d}"


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
    "String.concat": (1, lambda e, parts: "".join(parts)),
    "String.concatWith": (2, lambda e, separator, parts: separator.join(parts)),
    "String.str": (1, lambda e, c: c),
    "String.explode": (1, lambda e, s: tuple(s)),
    "String.implode": (1, lambda e, chars: "".join(chars)),
    "String.map": (2, _map),
    "String.translate": (2, _map),
    "String.tokens": (2, _tokens),
    "String.fields": (2, _fields),
    "String.isPrefix": (2, lambda e, part, s: s.startswith(part)),
    "String.isSuffix": (2, lambda e, part, s: s.endswith(part)),
    "String.isSubstring": (2, lambda e, part, s: part in s),
    "Char.ord": (1, lambda e, c: ord(c)),
    "Char.chr": (1, lambda e, code: _char(code)),
    "Char.toString": (1, lambda e, c: _escaped(c)),
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
