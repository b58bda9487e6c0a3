"""Names of nodes and pages in nets as text: a word, or a string."""

from __future__ import annotations

import re

_WORD = r'(?:(?!->)[^\s:=(),;"\[\]{}])+'
_BARE = re.compile(_WORD)
_NAME = re.compile(rf'\s*(?:"((?:[^"\\]|\\.)*)"|({_WORD}))')


def take(text: str, start: int = 0) -> tuple[str, int] | None:
    """The name that begins at `start`, after white space, and where it ends; None if there is none.

    Blanks in a name count as in a `.cpn` file: as one, and not at its ends.
    """
    found = _NAME.match(text, start)
    if found is None:
        return None
    quoted, bare = found.groups()
    if quoted is None:
        return bare, found.end()
    return " ".join(re.sub(r"\\([\"\\])", r"\1", quoted).split()), found.end()


def written(name: str) -> str:
    """The name as `take` reads it."""
    if _BARE.fullmatch(name) and not name.startswith("#"):
        return name
    return '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'
