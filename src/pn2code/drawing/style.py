"""Colours and line styles of drawings."""

from __future__ import annotations

import re

_COLOURS = {
    "aqua": "#00ffff", "black": "#000000", "blue": "#0000ff", "fucia": "#ff00ff", "fuchsia": "#ff00ff",
    "gray": "#808080", "grey": "#808080", "green": "#008000", "lime": "#00ff00", "maroon": "#800000",
    "navy": "#000080", "olive": "#808000", "purple": "#800080", "red": "#ff0000", "silver": "#c0c0c0",
    "teal": "#008080", "white": "#ffffff", "yellow": "#ffff00",
}  # fmt: skip
"""CPN Tools' colours; it spells one of them `Fucia`."""
_HEX = re.compile(r"#[0-9a-fA-F]{6}")

TAG_LINE, TAG_FILL = "#2f4f9f", "#dfe8fb"
TOKEN_LINE, TOKEN_FILL = "#1b7a1b", "#9be89b"
ENABLED = "#00c000"
PROBLEM = "#e00000"


def colour(name: str, default: str = "#000000") -> str:
    """A colour of the file as `#rrggbb`; anything unknown is the default."""
    name = name.strip()
    return name.lower() if _HEX.fullmatch(name) else _COLOURS.get(name.lower(), default)


def dash(line: str) -> str:
    """The dashes of a line type, "" for a solid line."""
    if line.startswith("dash"):
        return "6 4"
    return "1.5 3" if line.startswith("dot") else ""
