"""Built-in functions on substrings: `Slice`s of Python strings."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.library import builtins_lists, builtins_text
from pn2code.semantics.values.data import (
    NONE,
    Data,
    MlException,
    Slice,
    Value,
    exception,
    joined,
    order,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]


def _whole(text: str) -> Slice:
    return Slice(text, 0, len(text))


def _part(s: Slice, start: int, length: int | None) -> Slice:
    """A part of a slice.

    Raises:
        MlException: Subscript, it is not within.
    """
    length = s.length - start if length is None else length
    if start < 0 or length < 0 or start + length > s.length:
        raise MlException(exception("Subscript"))
    return Slice(s.text, s.start + start, length)


def _given(length: Data) -> int | None:
    assert length.argument is None or isinstance(length.argument, int)
    return length.argument


def _not_negative(n: int) -> int:
    if n < 0:
        raise MlException(exception("Subscript"))
    return n


def _without_left(e: Evaluator, n: int, s: Slice) -> Slice:
    return _part(s, min(_not_negative(n), s.length), None)


def _without_right(e: Evaluator, n: int, s: Slice) -> Slice:
    return _part(s, 0, max(0, s.length - _not_negative(n)))


def _first(s: Slice) -> Data:
    return some((str(s)[0], _part(s, 1, None))) if s.length else NONE


def _prefix(e: Evaluator, predicate: Value, s: Slice) -> Task:
    """How many characters at the start have the property."""
    n = 0
    for c in str(s):
        if not (yield e.call(predicate, c)):
            break
        n += 1
    return n


def _suffix(e: Evaluator, predicate: Value, s: Slice) -> Task:
    """At which position the last characters with the property begin."""
    at = s.length
    for c in reversed(str(s)):
        if not (yield e.call(predicate, c)):
            break
        at -= 1
    return at


def _at(measure: Callable[..., Task], *, left: bool, right: bool) -> Function:
    """Splits where `measure` says, and gives the left part, the right part, or both."""

    def function(e: Evaluator, predicate: Value, s: Slice) -> Task:
        n = yield measure(e, predicate, s)
        parts = _part(s, 0, n), _part(s, n, None)
        return parts if left and right else parts[0 if left else 1]

    return function


def _position(e: Evaluator, text: str, s: Slice) -> tuple[Slice, Slice]:
    found = str(s).find(text)
    n = s.length if found < 0 else found
    return _part(s, 0, n), _part(s, n, None)


def _span(e: Evaluator, p: tuple[Slice, Slice]) -> Slice:
    a, b = p
    end = b.start + b.length
    if a.text != b.text or a.start > end:
        raise MlException(exception("Span"))
    return Slice(a.text, a.start, end - a.start)


def _pieces(*, drop_empty: bool) -> Function:
    """`tokens` or `fields` of strings, on slices: the pieces are slices of the same text."""

    def pieces(e: Evaluator, separator: Value, s: Slice) -> Task:
        found: list[Slice] = []
        start = 0
        text = str(s)
        for i, c in enumerate(text):
            if (yield e.call(separator, c)):
                found.append(_part(s, start, i - start))
                start = i + 1
        found.append(_part(s, start, None))
        return tuple(x for x in found if x.length) if drop_empty else tuple(found)

    return pieces


def _on_characters(function: Function) -> Function:
    """A function on lists, of the characters of a slice."""
    return lambda e, *arguments: function(e, *arguments[:-1], tuple(str(arguments[-1])))


def _collate(e: Evaluator, compare: Value, p: tuple[Slice, Slice]) -> Task:
    return builtins_lists.collate(e, compare, (tuple(str(p[0])), tuple(str(p[1]))))


_LISTS = builtins_lists.FUNCTIONS
_TEXTS = builtins_text.FUNCTIONS

FUNCTIONS: dict[str, tuple[int, Function]] = {
    "Substring.full": (1, lambda e, text: _whole(text)),
    "Substring.all": (1, lambda e, text: _whole(text)),
    "Substring.substring": (1, lambda e, p: _part(_whole(p[0]), p[1], p[2])),
    "Substring.extract": (1, lambda e, p: _part(_whole(p[0]), p[1], _given(p[2]))),
    "Substring.slice": (1, lambda e, p: _part(p[0], p[1], _given(p[2]))),
    "Substring.string": (1, lambda e, s: str(s)),
    "Substring.base": (1, lambda e, s: (s.text, s.start, s.length)),
    "Substring.size": (1, lambda e, s: s.length),
    "Substring.isEmpty": (1, lambda e, s: s.length == 0),
    "Substring.sub": (1, lambda e, p: str(_part(p[0], p[1], 1))),
    "Substring.getc": (1, lambda e, s: _first(s)),
    "Substring.first": (1, lambda e, s: some(str(s)[0]) if s.length else NONE),
    "Substring.triml": (2, _without_left),
    "Substring.trimr": (2, _without_right),
    "Substring.concat": (1, lambda e, parts: joined("", list(map(str, parts)))),
    "Substring.concatWith": (
        2,
        lambda e, separator, parts: joined(separator, list(map(str, parts))),
    ),
    "Substring.explode": (1, lambda e, s: tuple(str(s))),
    "Substring.isPrefix": (2, lambda e, part, s: str(s).startswith(part)),
    "Substring.isSuffix": (2, lambda e, part, s: str(s).endswith(part)),
    "Substring.isSubstring": (2, lambda e, part, s: part in str(s) != ""),
    "Substring.compare": (1, lambda e, p: order(str(p[0]), str(p[1]))),
    "Substring.collate": (2, _collate),
    "Substring.splitl": (2, _at(_prefix, left=True, right=True)),
    "Substring.takel": (2, _at(_prefix, left=True, right=False)),
    "Substring.dropl": (2, _at(_prefix, left=False, right=True)),
    "Substring.splitr": (2, _at(_suffix, left=True, right=True)),
    "Substring.dropr": (2, _at(_suffix, left=True, right=False)),
    "Substring.taker": (2, _at(_suffix, left=False, right=True)),
    "Substring.splitAt": (1, lambda e, p: (_part(p[0], 0, p[1]), _part(p[0], p[1], None))),
    "Substring.position": (2, _position),
    "Substring.span": (1, _span),
    "Substring.translate": (2, lambda e, f, s: _TEXTS["String.translate"][1](e, f, str(s))),
    "Substring.tokens": (2, _pieces(drop_empty=True)),
    "Substring.fields": (2, _pieces(drop_empty=False)),
    "Substring.app": (2, _on_characters(_LISTS["List.app"][1])),
    "Substring.foldl": (3, _on_characters(_LISTS["List.foldl"][1])),
    "Substring.foldr": (3, _on_characters(_LISTS["List.foldr"][1])),
}
