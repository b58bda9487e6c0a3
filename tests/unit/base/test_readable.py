"""Strings of CPN ML for people: bytes that mean characters beyond Latin-1."""

from __future__ import annotations

import pytest

from pn2code.base.readable import readable


def stored(text: str) -> str:
    """As `ml.parsing.lexer` keeps the characters of a string."""
    return "".join(c if c <= "\xff" else c.encode().decode("latin-1") for c in text)


@pytest.mark.parametrize("text", ["", "plain", "é", "Łódź é", "ž–€", "Ω → 𝒳", "中文"])
def test_what_was_written_is_shown(text: str) -> None:
    assert readable(stored(text)) == text
    assert readable(text) == text, "it may be readable already"


@pytest.mark.parametrize(
    "text", ["\xc3\xa9", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xc5", "\xe2\x82"]
)
def test_other_bytes_stay_what_they_are(text: str) -> None:
    """Of Latin-1 itself, longer than need be, half a pair, beyond Unicode, cut off."""
    assert readable(text) == text
