"""Texts in drawings: how wide they are, and how they are written into XML.

Widths are those of Arial, which CPN Tools uses; fonts of the same widths are everywhere (Liberation Sans, Arimo,
Helvetica). Knowing them, the drawing needs no font file and comes out the same on every machine.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

SIZE = 13.0
"""Font size in CPN Tools units."""
LINE = 14.0
"""Distance of lines; CPN Tools measures a label as 14 or 15 high."""
ASCENT = 11.0
"""From the top of a line to its base line."""
FAMILY = "Arial, 'Liberation Sans', Arimo, Helvetica, sans-serif"
BOLD = 1.065
"""How much wider bold text is."""

_TAB = 4
_FIRST = 32
# Advance widths of the characters from U+0020 to U+007E in thousandths of the font size.
_WIDTHS = (
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667,
    556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556,
    556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722,
    500, 500, 500, 334, 260, 334, 584,
)  # fmt: skip
_OTHER, _WIDE = 600, 1000
# What XML 1.0 does not allow, other control characters, and the characters that turn the direction of text.
_ILLEGAL = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufdd0-\ufdef\ufffe\uffff]"
)


def clean(text: str) -> str:
    """A text without characters that XML or a reader's eyes cannot take; they become U+FFFD."""
    return _ILLEGAL.sub("\ufffd", text)


def escape(text: str) -> str:
    """A text as XML or HTML character data, also inside a quoted attribute."""
    text = clean(text).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
    return text.replace('"', "&quot;").replace("'", "&#39;")


def attribute(text: str) -> str:
    """Like `escape`, with line breaks that survive as an attribute's value."""
    return escape(text).replace("\r", "").replace("\n", "&#10;").replace("\t", "&#9;")


def lines(text: str) -> tuple[str, ...]:
    """The lines of a text; tabs become spaces, white space at the ends of lines goes."""
    text = text.replace("\r\n", "\n").replace("\r", "\n").expandtabs(_TAB)
    return tuple(clean(line.rstrip()) for line in text.split("\n"))


def width(line: str, bold: bool = False) -> float:
    """Width of one line in CPN Tools units."""
    total = 0
    for c in line:
        code = ord(c) - _FIRST
        if 0 <= code < len(_WIDTHS):
            total += _WIDTHS[code]
        elif unicodedata.combining(c):
            continue
        else:
            total += _WIDE if unicodedata.east_asian_width(c) in "WF" else _OTHER
    return total * SIZE / 1000 * (BOLD if bold else 1.0)


def extent(block: Sequence[str], bold: bool = False) -> tuple[float, float]:
    """Width and height of lines of text."""
    return max((width(line, bold) for line in block), default=0.0), LINE * len(block)


def shorten(text: str, most_lines: int, most_characters: int) -> str:
    """A text with at most so many lines, each with at most so many characters; what is left out shows as `…`."""
    found = text.split("\n")
    cut = [s if len(s) <= most_characters else s[: most_characters - 1] + "…" for s in found]
    if len(cut) > most_lines:
        cut = [*cut[: most_lines - 1], f"… {len(cut) - most_lines + 1} more"]
    return "\n".join(cut)
