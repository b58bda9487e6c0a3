"""Strings of CPN ML for people.

    readable("\\xc5\\x81\\xf3d\\xc5\\xba")        # "Łódź", which has the six bytes C5 81 F3 64 C5 BA

A string of CPN ML is bytes, one character each. What Latin-1 does not have is several of them, those of UTF-8, as CPN
Tools writes it (`ml/parsing/lexer.py`): `String.size "ź"` is 2, that of "é" is 1. The engine's own texts show the bytes
in the same way.
"""

from __future__ import annotations

import re

_BEYOND = re.compile(
    "[\xc4-\xdf][\x80-\xbf]|[\xe0-\xef][\x80-\xbf]{2}|[\xf0-\xf4][\x80-\xbf]{3}", re.DOTALL
)
"""What may be a character beyond Latin-1 in UTF-8."""


def readable(text: str) -> str:
    """A text in which each character is a byte, or already readable, with the characters that are meant."""
    return text if text.isascii() else _BEYOND.sub(_character, text)


def _character(found: re.Match[str]) -> str:
    data = found[0].encode("latin-1")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return found[0]
