"""TOML files: what they say, and where.

data, locator = read(Path("cell.toml"), d, codes.CELL_FILE, hint="...")
locator.origin("input", 0, "place")             # Origin("cell.toml", 12, part="key `input.0.place`")
locator.strings("property", 0, "holds")         # [SourceText(..)]: with the place of each character
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Sequence
from copy import copy
from pathlib import Path
from typing import Any

from pn2code.cell.toml_text import positions
from pn2code.diagnostics import Diagnostics, Origin, SourceText
from pn2code.os_reason import os_reason


class Locator:
    """Where keys and strings stand in the text of a TOML file."""

    def __init__(self, file: str, text: str) -> None:
        self.file = file
        self._layout = ""
        self._positions = positions(text, file)

    def in_layout(self, layout: str) -> Locator:
        """The same file, where a layout replaces some keys."""
        other = copy(self)
        other._layout = layout
        return other

    def origin(self, *path: str | int) -> Origin:
        """Origin of a key, or of the nearest table around it; of a layout's key where that replaces it."""
        key = tuple(map(str, path))
        over = self._nearest(("layouts", self._layout, *key)) if self._layout else ()
        found = self._nearest(key)
        if len(over) > 2 and len(over) - 2 >= len(found):
            found, key = over, ("layouts", self._layout, *key)
        return Origin(
            self.file,
            self._positions.lines.get(found, 0),
            part=f"key `{'.'.join(key)}`" if key else "",
        )

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
        return tomllib.loads(text), Locator(file, text)
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
