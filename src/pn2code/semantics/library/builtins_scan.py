"""Reading values from the character streams of SML (`Int.scan`, `Real.scan`, ...).

A reader is a function from a stream to `SOME (character, rest)` or `NONE`; streams are values, so that reading further
than needed does no harm.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.semantics.values.data import (
    MAX_STRING,
    NONE,
    Data,
    MlException,
    Value,
    exception,
    some,
)

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]
Read = Callable[["Evaluator", str], tuple[Value, int] | None]
"""Reads a value at the start of a text: the value and the number of characters, or None."""


def option(value: Value | None) -> Data:
    """`SOME value`, or `NONE` for None."""
    return NONE if value is None else some(value)


def from_string(read: Read) -> Function:
    """The function `fromString` made of a reading function."""

    def function(e: Evaluator, text: str) -> Data:
        found = read(e, text)
        return NONE if found is None else some(found[0])

    return function


def take_while(e: Evaluator, reader: Value, stream: Value, wanted: Callable[[str], bool]) -> Task:
    """The characters at the start of a stream that are wanted, and the streams before each and after the last."""
    text: list[str] = []
    streams = [stream]
    while True:
        item = yield e.call(reader, streams[-1])
        if item.argument is None or not wanted(item.argument[0]):
            return "".join(text), streams
        text.append(item.argument[0])
        streams.append(item.argument[1])


def scanner(read: Read, plausible: Callable[[str], bool]) -> Function:
    """The function `scan` made of a reading function, and of the characters that such a value may have."""

    def scan(e: Evaluator, reader: Value, stream: Value) -> Task:
        text, streams = yield take_while(e, reader, stream, plausible)
        found = read(e, text)
        return NONE if found is None else some((found[0], streams[found[1]]))

    return scan


def skip_blanks(e: Evaluator, reader: Value, stream: Value) -> Task:
    """`StringCvt.skipWS`."""
    _, streams = yield take_while(e, reader, stream, lambda c: c in " \t\n\v\f\r")
    return streams[-1]


def _split(e: Evaluator, predicate: Value, reader: Value, stream: Value) -> Task:
    text: list[str] = []
    while True:
        item = yield e.call(reader, stream)
        if item.argument is None or not (yield e.call(predicate, item.argument[0])):
            return "".join(text), stream
        text.append(item.argument[0])
        stream = item.argument[1]


def _drop(e: Evaluator, predicate: Value, reader: Value, stream: Value) -> Task:
    return (yield _split(e, predicate, reader, stream))[1]


def _take(e: Evaluator, predicate: Value, reader: Value, stream: Value) -> Task:
    return (yield _split(e, predicate, reader, stream))[0]


def scan_text(e: Evaluator, scan: Value, text: str) -> Task:
    """The value at the start of a text and where it ends, or None; the stream is a position in the text."""
    from pn2code.semantics.values.data import Native

    def character(e: Evaluator, at: int) -> Data:
        return some((text[at], at + 1)) if at < len(text) else NONE

    scanning = yield e.call(scan, Native("getc", 1, character))
    found = yield e.call(scanning, 0)
    return found.argument


def _scan_string(e: Evaluator, scan: Value, text: str) -> Task:
    found = yield scan_text(e, scan, text)
    return NONE if found is None else some(found[0])


def missing(e: Evaluator, c: str, width: int, text: str) -> str:
    """What is to be added for that width."""
    if width - len(text) < e.min_int:
        raise MlException(exception("Overflow"))
    if width > MAX_STRING:
        raise MlException(exception("Size"))
    return c * (width - len(text))


FUNCTIONS: dict[str, tuple[int, Function]] = {
    "StringCvt.padLeft": (3, lambda e, c, n, text: missing(e, c, n, text) + text),
    "StringCvt.padRight": (3, lambda e, c, n, text: text + missing(e, c, n, text)),
    "StringCvt.skipWS": (2, skip_blanks),
    "StringCvt.splitl": (3, _split),
    "StringCvt.dropl": (3, _drop),
    "StringCvt.takel": (3, _take),
    "StringCvt.scanString": (2, _scan_string),
}
