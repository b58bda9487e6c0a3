"""The meaning of a key without what only the manual can show.

plain("See *Sensors* ([protocol.md](protocol.md)).")     # "See Sensors."
"""

from __future__ import annotations

import re


def plain(words: str) -> str:
    """Without references to the manual, and without emphasis."""
    words = re.sub(r" ?\(\[[^]]*\]\([^)]*\)[^)]*\)", "", words)
    words = re.sub(r"\[([^]`]*)\]\([^)]*\)", r"\1", words)
    return re.sub(r"\*(\w[^*]*)\*", r"\1", words)
