"""Colours in files: `CS.output`, `CS.input` and the same for multi-sets.

`output` writes what `mkstr` gives and a blank; `output_ms` writes ``2`red ++ 1`blue ``, `+++` between timed tokens,
`empty` for nothing. Reading takes blanks and line ends anywhere between two signs. A string ends at the next `"`: as
`mkstr`, `output` does not escape.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from pn2code.ml.core.colsets import Colset, Kind
from pn2code.semantics.evaluation.files import InStream
from pn2code.semantics.library.builtins_integers import read_integer
from pn2code.semantics.library.builtins_real_texts import read_real
from pn2code.semantics.values.colour_components import assemble, component
from pn2code.semantics.values.colours import Colours
from pn2code.semantics.values.data import UNIT, Data, MlException, Timed, Value, exception


def output_text(colours: Colours, c: Colset, value: Value) -> str:
    """What `output` writes."""
    return colours.text(c, value) + " "


def output_ms_text(colours: Colours, c: Colset, items: Iterable[Value]) -> str:
    """What `output_ms` writes."""
    text = colours.multiset_text(c, items)
    return re.sub(r"(\++)\n(?=\d+`)", r" \1 ", text) + " "


def read_value(c: Colset, stream: InStream) -> Value:
    """What `input` reads.

    Raises:
        MlException: IOError, there is something else.
    """
    reader = _Reader(stream)
    value = reader.value(c)
    reader.done()
    return value


def read_token(c: Colset, stream: InStream, *, real_time: bool) -> Timed:
    """What `input` of a timed colour set reads.

    Raises:
        MlException: IOError, there is something else.
    """
    reader = _Reader(stream)
    token = reader.token(c, real_time=real_time)
    reader.done()
    return token


def read_multiset(
    c: Colset, stream: InStream, *, timed: bool, real_time: bool = False
) -> tuple[Value, ...]:
    """What `input_ms` reads, up to the end of the stream.

    Raises:
        MlException: IOError, there is something else.
    """
    reader = _Reader(stream)
    found: list[Value] = []
    if not reader.accept("empty"):
        while True:
            count = reader.number()
            reader.expect("`")
            value = reader.token(c, real_time=real_time) if timed else reader.value(c)
            found += [value] * count
            if reader.at_end():
                break
            reader.expect("+++" if timed else "++")
    reader.done()
    return tuple(found)


class _Reader:
    """Reads what is left of a stream; `done` takes what was read."""

    def __init__(self, stream: InStream) -> None:
        self._stream = stream
        self._text = stream.rest
        self._at = 0

    def done(self) -> None:
        """Takes what was read, and the blank behind it."""
        if self._text[self._at : self._at + 1] == " ":
            self._at += 1
        self._stream.take(self._at)

    def _skip(self) -> None:
        while self._at < len(self._text) and self._text[self._at] in " \t\n\v\f\r":
            self._at += 1

    def accept(self, word: str) -> bool:
        """Reads a word if it is there."""
        self._skip()
        if not self._text.startswith(word, self._at):
            return False
        end = self._at + len(word)
        if word[-1].isalnum() and re.match(r"[A-Za-z0-9_']", self._text[end : end + 1]):
            return False
        self._at = end
        return True

    def expect(self, word: str) -> None:
        """Reads a word that must be there."""
        if not self.accept(word):
            raise self._problem(f"'{word}'")

    def _problem(self, wanted: str) -> MlException:
        found = self._text[self._at : self._at + 20] or "the end"
        return MlException(exception("IOError", f"IOError: Expecting {wanted}, found: {found}"))

    def at_end(self) -> bool:
        """Whether only blanks are left."""
        self._skip()
        return self._at >= len(self._text)

    def token(self, c: Colset, *, real_time: bool) -> Timed:
        """Reads a colour with its stamp."""
        value = self.value(c)
        self.expect("@")
        return Timed(value, self._real() if real_time else self.number())

    def number(self) -> int:
        """Reads an integer, perhaps in parentheses."""
        bracket = self.accept("(")
        self._skip()
        found = read_integer(self._text[self._at :])
        if found is None:
            raise self._problem("integer")
        self._at += found[1]
        if bracket:
            self.expect(")")
        return found[0]

    def _real(self) -> float:
        bracket = self.accept("(")
        self._skip()
        found = read_real(self._text[self._at :])
        if found is None:
            raise self._problem("real")
        self._at += found[1]
        if bracket:
            self.expect(")")
        return found[0]

    def _string(self) -> str:
        self.expect('"')
        end = self._text.find('"', self._at)
        if end < 0:
            raise self._problem("a string")
        text = self._text[self._at : end]
        self._at = end + 1
        return text

    def _one_of(self, names: tuple[str, ...]) -> int:
        for i, name in enumerate(names):
            if self.accept(name):
                return i
        raise self._problem(f"one of {', '.join(names)}")

    def value(self, c: Colset) -> Value:
        """Reads a colour as `mkstr` prints it."""
        match c.kind:
            case Kind.UNIT:
                self.expect(c.names[0] if c.names else "()")
                return UNIT
            case Kind.BOOL:
                return self._one_of(c.names or ("false", "true")) == 1
            case Kind.REAL:
                return self._real()
            case Kind.STRING:
                return self._string()
            case Kind.ENUM:
                tag = self._one_of(c.names)
                return Data(c.names[tag], tag)
            case Kind.INDEX:
                self.expect(c.names[0])
                return Data(c.names[0], 0, self.number())
            case Kind.PRODUCT:
                return self._product(c)
            case Kind.RECORD:
                return self._record(c)
            case Kind.LIST:
                return self._list(c)
            case Kind.UNION:
                tag = self._one_of(c.names)
                part = c.components[tag]
                return Data(c.names[tag], tag, None if part is None else self._argument(part))
            case Kind.ALIAS | Kind.SUBSET:
                return self.value(component(c))
            case _:
                return self.number()

    def _argument(self, part: Colset) -> Value:
        self.expect("(")
        value = self.value(part)
        self.expect(")")
        return value

    def _product(self, c: Colset) -> Value:
        self.expect("(")
        values: list[Any] = []
        for i, part in enumerate(c.components):
            if i:
                self.expect(",")
            assert part is not None
            values.append(self.value(part))
        self.expect(")")
        return assemble(c, values)

    def _record(self, c: Colset) -> Value:
        """The fields may come in any order."""
        self.expect("{")
        found: dict[str, Value] = {}
        for i in range(len(c.labels)):
            if i:
                self.expect(",")
            at = self._one_of(c.labels)
            self.expect("=")
            part = c.components[at]
            assert part is not None
            found[c.labels[at]] = self.value(part)
        self.expect("}")
        if len(found) < len(c.labels):
            raise self._problem("every field once")
        return assemble(c, [found[label] for label in c.labels])

    def _list(self, c: Colset) -> Value:
        self.expect("[")
        values: list[Value] = []
        while not self.accept("]"):
            if values:
                self.expect(",")
            values.append(self.value(component(c)))
        return tuple(values)
