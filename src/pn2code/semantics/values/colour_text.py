"""Reading values from the texts that CPN Tools prints (the reverse of `Colours.text`).

    read_value(PACKET, '(1,"Modellin")')        # (1, "Modellin")

Strings are printed without escapes, so a text may have several readings (`["a","b"]` is a list of two strings, or
of one with a comma in it): the first that fits the colour set is given, strings as short as possible.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.values.colour_components import assemble, component
from pn2code.semantics.values.data import UNIT, Data, Value

Reading = Iterator[tuple[Value, int]]
"""Values that begin at a position, each with the position behind it."""

_BLANKS = re.compile(r"\s*")
_INT = re.compile(r"\((?P<a>[~-]?\d+)\)|(?P<b>[~-]?\d+)")
_NUMBER = r"[~-]?(?:\d+(?:\.\d+)?(?:[eE][~-]?\d+)?|inf|nan)"
_REAL = re.compile(rf"\((?P<a>{_NUMBER})\)|(?P<b>{_NUMBER})")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_']*")


def read_value(c: Colset, text: str, *, real_time: bool = False) -> Value | None:
    """The value of a text; None when it is no value of the colour set. Bounds are not checked.

    Args:
        c: the colour set.
        text: as printed.
        real_time: whether values of kind time are real.
    """
    reader = _Reader(text, real_time)
    try:
        for value, end in reader.read(c, 0):
            if reader.skip(end) == len(text):
                return value
    except RecursionError:
        return None
    return None


class _Reader:
    def __init__(self, text: str, real_time: bool) -> None:
        self.text = text
        self.real_time = real_time

    def skip(self, at: int) -> int:
        """Behind blanks."""
        found = _BLANKS.match(self.text, at)
        return found.end() if found else at

    def symbol(self, at: int, symbol: str) -> int | None:
        """Behind a symbol, blanks before it skipped; None if it is not there."""
        at = self.skip(at)
        return at + len(symbol) if self.text.startswith(symbol, at) else None

    def read(self, c: Colset, at: int) -> Reading:
        """The values of a colour set that begin at a position."""
        at = self.skip(at)
        match c.kind:
            case Kind.ALIAS | Kind.SUBSET:
                yield from self.read(component(c), at)
            case Kind.UNIT:
                yield from self.words(at, {c.names[0] if c.names else "()": UNIT})
            case Kind.BOOL:
                names = dict(zip(c.names or ("false", "true"), (False, True), strict=True))
                yield from self.words(at, names)
            case Kind.ENUM:
                yield from self.words(at, {n: Data(n, tag) for tag, n in enumerate(c.names)})
            case Kind.REAL:
                yield from self.number(at, real=True)
            case Kind.TIME:
                yield from self.number(at, real=self.real_time)
            case Kind.INT | Kind.INTINF:
                yield from self.number(at, real=False)
            case Kind.STRING:
                yield from self.string(at)
            case Kind.INDEX:
                yield from self.index(c, at)
            case Kind.PRODUCT:
                yield from self.product(c, at)
            case Kind.RECORD:
                yield from self.record(c, at)
            case Kind.LIST:
                yield from self.list(c, at)
            case Kind.UNION:
                yield from self.union(c, at)

    def words(self, at: int, values: Mapping[str, Value]) -> Reading:
        """One of some words, the longest first."""
        for word in sorted(values, key=len, reverse=True):
            if self.text.startswith(word, at):
                yield values[word], at + len(word)

    def number(self, at: int, *, real: bool) -> Reading:
        found = (_REAL if real else _INT).match(self.text, at)
        if found:
            digits = (found["a"] or found["b"]).replace("~", "-")
            number = math.nan if digits.endswith("nan") else float(digits) if real else int(digits)
            yield number, found.end()

    def string(self, at: int) -> Reading:
        """Each quotation mark behind which something of the surroundings may follow can be the end."""
        if not self.text.startswith('"', at):
            return
        end = at
        while (end := self.text.find('"', end + 1)) >= 0:
            behind = self.skip(end + 1)
            if behind == len(self.text) or self.text[behind] in ",)]}":
                yield self.text[at + 1 : end], end + 1

    def index(self, c: Colset, at: int) -> Reading:
        if self.text.startswith(c.names[0], at):
            opened = self.symbol(at + len(c.names[0]), "(")
            if opened is not None:
                for value, end in self.number(self.skip(opened), real=False):
                    closed = self.symbol(end, ")")
                    if closed is not None:
                        yield Data(c.names[0], 0, value), closed

    def product(self, c: Colset, at: int) -> Reading:
        parts = [part for part in c.components if part is not None]
        for values, end in self.sequence(parts, [""] * len(parts), at, "(", ")"):
            yield assemble(c, values), end

    def record(self, c: Colset, at: int) -> Reading:
        parts = [part for part in c.components if part is not None]
        for values, end in self.sequence(parts, [f"{x}=" for x in c.labels], at, "{", "}"):
            yield assemble(c, values), end

    def sequence(
        self, parts: list[Colset], labels: list[str], at: int, opening: str, closing: str
    ) -> Iterator[tuple[list[Value], int]]:
        """Values one after the other, each behind its label, with commas between them."""

        def rest(n: int, position: int | None) -> Iterator[tuple[list[Value], int]]:
            if position is None:
                return
            if n == len(parts):
                closed = self.symbol(position, closing)
                if closed is not None:
                    yield [], closed
                return
            start: int | None = self.symbol(position, ",") if n else position
            for word in re.findall(r"[^=]+|=", labels[n]):
                start = None if start is None else self.symbol(start, word)
            if start is not None:
                for value, end in self.read(parts[n], start):
                    for others, last in rest(n + 1, end):
                        yield [value, *others], last

        yield from rest(0, self.symbol(at, opening))

    def list(self, c: Colset, at: int) -> Reading:
        part = component(c)
        opened = self.symbol(at, "[")
        if opened is None:
            return
        closed = self.symbol(opened, "]")
        if closed is not None:
            yield (), closed

        def rest(position: int) -> Iterator[tuple[tuple[Value, ...], int]]:
            for value, end in self.read(part, position):
                last = self.symbol(end, "]")
                if last is not None:
                    yield (value,), last
                comma = self.symbol(end, ",")
                if comma is not None:
                    for others, last in rest(comma):
                        yield (value, *others), last

        yield from rest(opened)

    def union(self, c: Colset, at: int) -> Reading:
        found = _NAME.match(self.text, at)
        if found is None or found[0] not in c.names:
            return
        tag = c.names.index(found[0])
        part = c.components[tag]
        if part is None:
            yield Data(found[0], tag), found.end()
            return
        opened = self.symbol(found.end(), "(")
        if opened is not None:
            for value, end in self.read(part, opened):
                closed = self.symbol(end, ")")
                if closed is not None:
                    yield Data(found[0], tag, value), closed
        for value, end in self.read(part, found.end()):
            yield Data(found[0], tag, value), end
