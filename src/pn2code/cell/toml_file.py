"""TOML files: what they say, and where.

data, locator = read(Path("cell.toml"), d, codes.CELL_FILE, hint="...")
locator.origin("input", 0, "place")             # Origin("cell.toml", 12, part="key `place` of `shelf` in `input`")
locator.strings("property", 0, "holds")         # [SourceText(..)]: with the place of each character
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from copy import copy
from pathlib import Path
from typing import Any

from pn2code.base.os_reason import os_reason
from pn2code.cell.toml_text import positions
from pn2code.diagnostics import Diagnostics, Origin, SourceText, Span
from pn2code.diagnostics.keys import in_words


class Locator:
    """Where keys and strings stand in the text of a TOML file.

    Args:
        file: its name.
        text: what stands in it.
        data: what the parser makes of it.
    """

    def __init__(self, file: str, text: str, data: Mapping[str, Any]) -> None:
        self.file = file
        self._data = data
        self._layout = ""
        self._positions = positions(text, file)

    def in_layout(self, layout: str) -> Locator:
        """The same file, where a layout replaces some keys."""
        other = copy(self)
        other._layout = layout
        return other

    def origin(self, *path: str | int) -> Origin:
        """Origin of a key, or of the nearest table around it; of a layout's key where that replaces it."""
        shown, key = path, tuple(map(str, path))
        over = self._nearest(("layouts", self._layout, *key)) if self._layout else ()
        found = self._nearest(key)
        if len(over) > 2 and len(over) - 2 >= len(found):
            found, shown = over, ("layouts", self._layout, *path)
        return Origin(
            self.file,
            self._positions.lines.get(found, 0),
            part=f"key {in_words(shown, self._data)}" if path else "",
        )

    def words(self, *path: str | int) -> str:
        """A key as messages call it."""
        return in_words(path, self._data)

    def strings(self, *path: str | int) -> Sequence[SourceText]:
        """The strings of a key, each at its place; none where the key stands in a table in one line."""
        return self._positions.strings.get(tuple(map(str, path)), ())

    def _nearest(self, key: tuple[str, ...]) -> tuple[str, ...]:
        while key and key not in self._positions.lines:
            key = key[:-1]
        return key


def read(
    path: Path, d: Diagnostics, code: str, *, hint: str
) -> tuple[dict[str, Any], Locator] | None:
    """Reads a file; None after a diagnostic.

    Args:
        path: the file.
        d: gets the errors.
        code: of the errors.
        hint: for a file that is not TOML: how one is written.
    """
    file = str(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as problem:
        d.error(
            code,
            f"cannot read `{file}`: {os_reason(problem)}",
            Origin(file),
            hint="save it as a text file in UTF-8 that may be read",
        )
        return None
    try:
        data = tomllib.loads(text)
        return data, Locator(file, text, data)
    except tomllib.TOMLDecodeError as problem:
        found = re.search(r"\(at line (\d+), column (\d+)\)", str(problem))
        line, column = (int(found[1]), int(found[2])) if found else (text.count("\n") + 1, 0)
        message = re.sub(r" \(at .*\)$", "", str(problem))
        d.error(
            code,
            f"not a TOML file: {message[:1].lower()}{message[1:]}",
            _at(text, file, line, column),
            hint=_advice(message, text, line, column) or hint,
        )
        return None


def _at(text: str, file: str, line: int, column: int) -> Span:
    """The character at a place; of the end of the file, its last one."""
    lines = text.split("\n")
    start = min(sum(len(x) + 1 for x in lines[: line - 1]) + max(column - 1, 0), len(text))
    source = SourceText(text, Origin(file, 1, 1))
    return Span(source, start, min(start + 1, len(text)))


_ADVICE = {
    "Unclosed array": "write a comma between the values, and `]` after the last",
    "Unclosed inline table": "write a comma between the entries, and `}` after the last, all in one line",
    "Unterminated string": "close the string with a quote in the same line",
    "Illegal character '\\n'": "close the string with a quote in the same line",
    "Expected '=' after a key": "write `key = value`; a name with blanks or dots in it stands in quotes",
    "Expected ']'": "the name of a section stands in brackets, `[name]`, and in `[[name]]` where there may be several",
    "Cannot overwrite a value": "the key is there twice: leave one of them out",
    "Cannot declare": "the section is there twice: put its keys together; tables of several are written `[[name]]`",
    "Duplicate inline table key": "the key is there twice: leave one of them out",
}
"""What to do about a message of the parser, by its beginning."""


def _advice(message: str, text: str, line: int, column: int) -> str:
    """What to do about a mistake, where its kind is known."""
    lines = text.split("\n")
    rest = lines[line - 1][max(column - 1, 0) :] if line <= len(lines) else ""
    if message == "Invalid value" and (word := re.match(r"[A-Za-z_][\w.-]*", rest)):
        return f'text stands in quotes: `"{word[0]}"`; truth values are `true` and `false`'
    if message.startswith("Expected newline or end of document"):
        if re.match(r",\d", rest):
            return "numbers are written with a point: `0.5`"
        if rest.startswith(","):
            return "leave out the comma: each key of a section stands on its own line"
        return "write each key on its own line, text in quotes and numbers with a point"
    return next((hint for start, hint in _ADVICE.items() if message.startswith(start)), "")
