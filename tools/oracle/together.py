"""Many random nets in one file, for the engine: it takes seconds to start, and more to enter its state-space tool.

    side_by_side([text, text])      # they share nothing but the clock and the priorities: for runs
    one_of([text, text])            # a first step chooses one of them, and the others stand still: for state spaces

The texts are those of `numbered`, whose names do not meet.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

_HEAD = 3
"""Lines before the declarations of a net."""
_OWN = re.compile(
    r"\b(?:[vwx]?C\d+|[vwx](?:INT|BOOL|STRING|UNIT|REAL)|eC\d+[a-d]|iC\d+|UC\d+|f\d+|k\d+|count|Shared|Top|Mid|Leaf|Sub)\b"
)
"""What the net declares, its fusion set and its pages."""
_NUMBER = re.compile(r"_n(\d+)\b")
CHOICE = "Choice"
"""The page and the place where a net is chosen."""


def numbered(text: str, number: int) -> str:
    """The net with a number at all of its names but those of nodes."""
    return _OWN.sub(lambda found: f"{found.group()}_n{number}", text)


def numbers_in(text: str) -> set[int]:
    """The numbers of the nets whose names a message mentions."""
    return {int(found) for found in _NUMBER.findall(text)}


def side_by_side(texts: Sequence[str]) -> str:
    """One file with all of them."""
    declarations: list[str] = []
    pages: list[str] = []
    for text in texts:
        lines = text.splitlines()[_HEAD:]
        at = next(i for i, line in enumerate(lines) if line.startswith("  page "))
        declarations += lines[:at]
        pages += lines[at:]
    head = texts[0].splitlines()[:_HEAD]
    return "\n".join([*head, *declarations, *pages]) + "\n"


def one_of(texts: Sequence[str]) -> str:
    """One file: its state space is the union of theirs, behind a step for each of them."""
    chosen = [_with_choice(text, i) for i, text in enumerate(texts, 1)]
    page = [f"  page {CHOICE}", f"    place {CHOICE} fusion {CHOICE} : INT = 1`0"]
    for i in range(1, len(texts) + 1):
        page += [f"    trans Choose{i}", f"      in {CHOICE} : 0", f"      out {CHOICE} : {i}"]
    return side_by_side(chosen) + "\n".join(page) + "\n"


def _with_choice(text: str, number: int) -> str:
    """The net, in which nothing can occur but after it was chosen."""
    return "\n".join(_lines(text.splitlines(), number)) + "\n"


def _lines(lines: Iterable[str], number: int) -> Iterable[str]:
    for line in lines:
        yield line
        if line.startswith("  page "):
            yield f"    place {CHOICE} fusion {CHOICE} : INT = 1`0"
        elif line.startswith("    trans "):
            yield f"      both {CHOICE} : {number}"
