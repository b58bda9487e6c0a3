"""Long lines of C, broken where a person would break them."""

from __future__ import annotations

import re

WIDTH = 100
"""Columns of a line of generated C."""
_LOOKED_AT = re.compile(r'"(?:[^"\\]|\\.)*"?|[][(){} ]')
"""Literals as a whole, brackets, blanks."""


def wrap(line: str, width: int = WIDTH) -> list[str]:
    """Break a long line of C, at the outermost commas and operators first; literals and comments stay whole."""
    if len(line) <= width or line.lstrip().startswith(("/*", "#")):
        return [line]
    indent = len(line) - len(line.lstrip())
    lines = [line]
    while len(lines[-1]) > width:
        at = _break_position(lines[-1], width)
        if at is None:
            break
        last = lines.pop()
        lines += [last[:at], " " * (indent + 4) + last[at + 1 :]]
    return lines


def _break_position(line: str, width: int) -> int | None:
    """The blank at which to break: the last of the least nested ones that leaves a line of `width`."""
    indent = len(line) - len(line.lstrip())
    best: tuple[int, int] | None = None  # (nesting, -position)
    depth = 0
    for found in _LOOKED_AT.finditer(line, indent):
        i = found.start()
        if i > width and best is not None:
            break
        c = line[i]
        if c in "([{":
            depth += 1
        elif c in ")]}":
            depth -= 1
        elif c == " " and i > indent + 8:
            cost = _cost(line[i - 1], line[i + 1 : i + 3])
            if cost is not None and (best is None or (depth + cost, -i) < best):
                best = (depth + cost, -i)
    return None if best is None else -best[1]


def _cost(before: str, after: str) -> int | None:
    """How much worse than a break at a comma of the same nesting; None: no break here."""
    if before == "," or after in ("&&", "||", "? ", ": "):
        return 0
    if after in ("+ ", "- "):
        return 1
    return 3 if after in ("* ", "/ ") or before == "=" else None
