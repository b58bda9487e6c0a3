"""docs/conformance.md is made by `./dev conformance`: nothing in it was written there by hand."""

from __future__ import annotations

import re
from pathlib import Path

from pn2code.engine_comparison.document import HEAD
from pn2code.engine_comparison.engine import ENGINE
from pn2code.engine_comparison.intended import TEXT

_MADE = re.compile(
    r"(?:\|.*\||\* .*|  \* .*|## .*|Compiled walks, .*|Each net asks one question; .*|\d+ expressions of CPN ML; .*|)"
)
"""The lines of tables and lists, and the sentences of `document.py`."""


def test_the_page_is_made_whole(root: Path) -> None:
    text = (root / "docs/conformance.md").read_text(encoding="utf-8")
    assert text.startswith(HEAD)
    for part in (HEAD, ENGINE, TEXT):
        assert text.count(part) == 1
        text = text.replace(part, "")
    assert not [line for line in text.splitlines() if not _MADE.fullmatch(line)]
