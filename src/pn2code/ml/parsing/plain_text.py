"""Declarations of CPN Tools (`colset`, `var`, ..) that stand as plain text in an ML declaration, which cannot have any.

old_declaration("colset BOX = int with 1..3;")     # Old("colset", 0, 6)
plain_names("colset BOX = int with 1..3;")         # (("BOX",), ()): colour sets, and what has values
guessed_names("fun f x = 0..1")                    # ("f",): of a text that is not even made of words
"""

from __future__ import annotations

import re

from pn2code.base.frozen import frozen

_START = r"(?:^|;)\s*(?:\(\*.*?\*\)\s*)*"
_OLD = re.compile(_START + r"(colset|color|var|globref|pageref|instref)\s+[A-Za-z]", re.DOTALL)
_COLSET = re.compile(_START + r"(?:colset|color)\s+([A-Za-z][\w']*)\s*=", re.DOTALL)
_VAR = re.compile(_START + r"var\s+([A-Za-z][\w',\s]*):", re.DOTALL)
_GLOBREF = re.compile(_START + r"globref\s+([A-Za-z][\w']*)\s*=", re.DOTALL)
_VALUE = re.compile(r"\b(?:val|fun|and|exception)\s+(?:rec\s+)?([A-Za-z][\w']*)")


@frozen
class Old:
    """A declaration of CPN Tools in a text: its key word, and where that stands."""

    word: str
    start: int
    end: int


def old_declaration(text: str) -> Old | None:
    """The first one; None: there is none."""
    found = _OLD.search(text)
    return None if found is None else Old(found[1], found.start(1), found.end(1))


def plain_names(text: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The colour sets that such declarations declare, and the variables and references."""
    variables = (name.strip() for group in _VAR.findall(text) for name in group.split(","))
    return tuple(_COLSET.findall(text)), (*filter(None, variables), *_GLOBREF.findall(text))


def guessed_names(text: str) -> tuple[str, ...]:
    """What other declarations declare."""
    return tuple(_VALUE.findall(text))
