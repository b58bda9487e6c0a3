"""Where the keys and strings of a TOML file stand: the standard parser keeps no positions, and diagnostics need them.

    found = positions(text, "x.toml")
    found.lines["property", "0", "holds"]     # 4
    found.strings["property", "0", "holds"]   # [SourceText("always {..}", Origin("x.toml", 4, 10))]

Values and mistakes are the parser's business (`tomllib`); here only well-formed files are scanned.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache

from pn2code.base.frozen import frozen
from pn2code.diagnostics import Origin, SourceText

Path = tuple[str, ...]
"""Of a key; tables of arrays are numbered from 0."""

_BARE = r"[A-Za-z0-9_-]+"
_PART = rf"""(?:{_BARE}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*')"""
_KEY = re.compile(rf"{_PART}(?:[ \t]*\.[ \t]*{_PART})*")
_HEADER = re.compile(rf"(\[\[?)[ \t]*({_PART}(?:[ \t]*\.[ \t]*{_PART})*)[ \t]*\]\]?")
_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)+")
_ESCAPE = re.compile(r"\\(?:u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|.)", re.DOTALL)
_SIMPLE = {"b": "\b", "t": "\t", "n": "\n", "f": "\f", "r": "\r", "e": "\x1b"}
_PLAIN = re.compile(r"[^\s,\]}#]+")
_SHORT = re.compile(r"""(["'])([^"'\\\r\n]*)\1(?!\1)""")
"""A string in which each character stands for itself, as most are."""
_RUN = {'"': re.compile(r'[^"\\\r]+'), "'": re.compile(r"[^'\r]+")}
"""Characters in a string of that quote that stand for themselves."""


@frozen
class Positions:
    """What stands where, by the path of its key.

    Args:
        lines: of the keys and the tables, where they come first.
        strings: of a key; those of an array in order.
    """

    lines: Mapping[Path, int]
    strings: Mapping[Path, Sequence[SourceText]]


@lru_cache(maxsize=8)
def positions(text: str, file: str) -> Positions:
    """Of all keys and strings of a file; the same file is often read again, for each of its layouts."""
    return _Scanner(text, file).run()


class _Scanner:
    def __init__(self, text: str, file: str) -> None:
        self._text = text
        self._file = file
        self._at = 0
        self._lines: dict[Path, int] = {}
        self._strings: dict[Path, list[SourceText]] = {}
        self._line = 1
        self._counted = 0

    def run(self) -> Positions:
        table: Path = ()
        counts: dict[Path, int] = {}
        while True:
            self._space()
            line, _ = self._position(self._at)
            header = _HEADER.match(self._text, self._at)
            if header is not None:
                self._at = header.end()
                table = tuple(_parts(header[2]))
                if header[1] == "[[":
                    number = counts.get(table, 0)
                    counts[table] = number + 1
                    table = (*table, str(number))
                for depth in range(1, len(table) + 1):  # `[robots.robot1]` also begins `robots`
                    self._lines.setdefault(table[:depth], line)
                continue
            key = _KEY.match(self._text, self._at)
            if key is None:
                return Positions(self._lines, self._strings)
            path = (*table, *_parts(key[0]))
            self._lines.setdefault(path, line)
            self._at = key.end()
            self._space()
            self._at += 1  # `=`
            self._value(path)

    def _space(self) -> None:
        found = _SPACE.match(self._text, self._at)
        if found is not None:
            self._at = found.end()

    def _value(self, path: Path) -> None:
        """A value: strings in it are kept, those of arrays too."""
        depth = 0
        while self._at < len(self._text):
            self._space()
            sign = self._text[self._at : self._at + 1]
            if sign in ("[", "{"):
                depth += 1
                self._at += 1
            elif sign in ("]", "}"):
                depth -= 1
                self._at += 1
            elif sign in ('"', "'"):
                self._strings.setdefault(path, []).append(self._string())
            elif sign in (",", "="):
                self._at += 1
            else:
                plain = _PLAIN.match(self._text, self._at)
                self._at = plain.end() if plain is not None else len(self._text)
            if depth <= 0:
                return

    def _position(self, at: int) -> tuple[int, int]:
        """Line and column of an offset; offsets do not go back."""
        self._line += self._text.count("\n", self._counted, at)
        self._counted = at
        return self._line, at - self._text.rfind("\n", 0, at)

    def _string(self) -> SourceText:
        short = _SHORT.match(self._text, self._at)
        if short is not None:
            line, column = self._position(self._at + 1)
            self._at = short.end()
            return SourceText(short[2], Origin(self._file, line, column), ((0, line, column),))
        quote = self._text[self._at]
        long = self._text.startswith(quote * 3, self._at)
        end_mark = quote * 3 if long else quote
        at = self._at + len(end_mark)
        if long:
            at += 2 if self._text.startswith("\r\n", at) else self._text.startswith("\n", at)
        out: list[str] = []
        length = 0
        marks: list[tuple[int, int, int]] = [(0, *self._position(at))]
        while at < len(self._text):
            if self._text.startswith(end_mark, at):
                # Up to two quotes may stand before the three that end a long string.
                while long and self._text.startswith(quote, at + 3):
                    out.append(quote)
                    at += 1
                break
            if quote == '"' and self._text[at] == "\\":
                escape = _ESCAPE.match(self._text, at)
                assert escape is not None, "tomllib has read the file"
                made, at = self._unescaped(escape, at)
                marks.append((length + len(made), *self._position(at)))
            elif (run := _RUN[quote].match(self._text, at)) is not None:
                made, at = run[0], run.end()
            elif self._text.startswith("\r\n", at):
                made, at = "\n", at + 2
            else:
                made, at = self._text[at], at + 1
            out.append(made)
            length += len(made)
        self._at = at + len(end_mark)
        _, line, column = marks[0]
        return SourceText("".join(out), Origin(self._file, line, column), tuple(marks))

    def _unescaped(self, escape: re.Match[str], at: int) -> tuple[str, int]:
        """What an escape stands for, and where it ends; one at the end of a line takes the space after it away."""
        sign = escape[0][1]
        if sign in "uU":
            return chr(int(escape[0][2:], 16)), escape.end()
        if sign.isspace():
            rest = re.compile(r"\\[ \t]*\r?\n\s*").match(self._text, at)
            return "", rest.end() if rest is not None else escape.end()
        return _SIMPLE.get(sign, sign), escape.end()


def _parts(key: str) -> list[str]:
    return [part.strip("\"'") for part in re.findall(_PART, key)]
