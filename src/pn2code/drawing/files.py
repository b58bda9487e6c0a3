"""Names of the files that drawings go to."""

from __future__ import annotations

import re
from collections.abc import Iterable

_LONGEST = 100
_RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9]|lpt[0-9])(\.|$)")


def file_stem(name: str) -> str:
    """A page's name as the name of a file: letters, digits, `-`, `_` and inner dots; anything else becomes `_`."""
    stem = re.sub(r"[^\w.-]", "_", name)[:_LONGEST].strip(". ")
    if not stem:
        return "page"
    return f"_{stem}" if stem.startswith("-") or _RESERVED.match(stem) else stem


def file_stems(names: Iterable[str]) -> list[str]:
    """A stem for each name, all different also where capitals do not count."""
    found: list[str] = []
    used: set[str] = set()
    for name in names:
        stem = chosen = file_stem(name)
        n = 1
        while chosen.lower() in used:
            n += 1
            chosen = f"{stem}_{n}"
        used.add(chosen.lower())
        found.append(chosen)
    return found
