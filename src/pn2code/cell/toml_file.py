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
from pn2code.diagnostics import Diagnostics, Origin, SourceText
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
            Origin(file, line, column),
            hint=hint,
        )
        return None
