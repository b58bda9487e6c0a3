"""Names of nodes and pages in nets as text: a word, or a string."""

from __future__ import annotations

import re

_BARE = re.compile(r'[^\s:=(),"]+')
_NAME = re.compile(r'\s*(?:"((?:[^"\\]|\\.)*)"|([^\s:=(),"]+))')


def take(text: str, start: int = 0) -> tuple[str, int] | None:
    """The name that begins at `start`, after white space, and where it ends; None if there is none."""
    found = _NAME.match(text, start)
    if found is None:
        return None
    quoted, bare = found.groups()
    return bare if quoted is None else re.sub(r"\\(.)", r"\1", quoted), found.end()


def written(name: str) -> str:
    """The name as `take` reads it."""
    if _BARE.fullmatch(name) and not name.startswith("#"):
        return name
    return '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'
