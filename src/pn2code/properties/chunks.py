"""CPN ML in braces inside the text of a property: where it ends, and the text without it.

blanked("always { x = {a = 1} }")     # ("always {\0\0\0\0\0\0\0\0\0\0\0}", ...)
"""

from __future__ import annotations

import re

from pn2code.diagnostics import SourceText
from pn2code.properties.grammar import BLANK

# What hides a brace in CPN ML: strings and characters, and the marks of comments, which nest.
_TOKEN = re.compile(r'"(?:[^"\\\n]|\\[\s\S])*"|\(\*|\*\)|[{}]')


def blanked(text: str) -> tuple[str, int | None]:
    """The text with the inside of each `{ .. }` replaced, and where a brace stands that is not closed."""
    out: list[str] = []
    at = depth = comments = opened = 0
    quoted = re.compile(r'"[^"\n]*"|[{}]')
    while True:
        found = (_TOKEN if depth else quoted).search(text, at)
        if found is None:
            break
        mark = found[0]
        if depth == 0:
            out.append(text[at : found.end()])
            if mark == "{":
                depth, opened, comments = 1, found.start(), 0
        elif mark == "(*":
            comments += 1
        elif mark == "*)":
            comments = max(0, comments - 1)
        elif comments == 0 and mark == "{":
            depth += 1
        elif comments == 0 and mark == "}":
            depth -= 1
            if depth == 0:
                out.append(BLANK * (found.start() - opened - 1) + "}")
        at = found.end()
    if depth:
        return "", opened
    return "".join((*out, text[at:])), None


def part(source: SourceText, start: int, end: int) -> SourceText:
    """A part of a text as a text of its own, at the same positions of the file."""
    marks = tuple(
        (at - start, line, column) for at, line, column in source.marks if start < at < end
    )
    origin = source.origin_at(start)
    if marks:
        marks = ((0, origin.line, origin.column), *marks)
    return SourceText(source.text[start:end], origin, marks)
