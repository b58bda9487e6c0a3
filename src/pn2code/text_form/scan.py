"""CPN ML as characters: which of them stand outside strings, comments and parentheses."""

from __future__ import annotations

import re
from collections.abc import Iterator

from pn2code.base.frozen import frozen

_SKIPPED = re.compile(r'#?"(?:[^"\\\n]|\\\s+\\|\\.)*(")?', re.DOTALL)
"""A string or a character; one that is never closed ends with its line."""
_COMMENT = re.compile(r"\(\*|\*\)")


@frozen
class Open:
    """What is open at the end of a line: how many comments; whether a string goes on in the next line (`"abc \\`)."""

    comments: int = 0
    string: bool = False


def plain(text: str) -> Iterator[tuple[int, str, int]]:
    """The characters outside strings and comments: offset, character, depth of the parentheses around it."""
    at, depth, comments = 0, 0, 0
    while at < len(text):
        mark = _COMMENT.match(text, at)
        if mark is not None and (mark.group() == "(*" or comments):
            comments += 1 if mark.group() == "(*" else -1
            at = mark.end()
            continue
        if comments:
            at += 1
            continue
        string = _SKIPPED.match(text, at)
        if string is not None:
            at = string.end()
            continue
        c = text[at]
        depth -= c in ")]}"
        yield at, c, depth
        depth += c in "([{"
        at += 1


def after(line: str, before: Open) -> Open:
    """What is open after a line, which has no white space around it."""
    if before.string and line.startswith("\\"):
        line = '"' + line[1:]
    at, comments = 0, before.comments
    while at < len(line):
        mark = _COMMENT.match(line, at)
        if mark is not None and (mark.group() == "(*" or comments):
            comments += 1 if mark.group() == "(*" else -1
            at = mark.end()
            continue
        string = None if comments else _SKIPPED.match(line, at)
        at = string.end() if string is not None else at + 1
        if string is not None and not string.group(1) and line[at:] == "\\":
            return Open(string=True)
    return Open(comments)


def masked(text: str) -> str:
    """The text with as many blanks for comments, and `"` for what stands in strings: words are looked for in it."""
    return _SKIPPED.sub(lambda m: '"' * len(m.group()), uncommented(text))


def uncommented(text: str) -> str:
    """The text with as many blanks for comments."""
    found = list(text)
    at, comments = 0, 0
    while at < len(text):
        mark = _COMMENT.match(text, at)
        if mark is not None and (mark.group() == "(*" or comments):
            comments += 1 if mark.group() == "(*" else -1
            found[at : mark.end()] = "  "
            at = mark.end()
            continue
        string = None if comments else _SKIPPED.match(text, at)
        if comments and not text[at].isspace():
            found[at] = " "
        at = string.end() if string is not None else at + 1
    return "".join(found)


def parts(text: str, separator: str) -> list[tuple[int, int]]:
    """Beginnings and ends of the parts between separators, which count outside parentheses only."""
    found, start = [], 0
    skipped = 0
    for at, _, depth in plain(text):
        if depth == 0 and at >= skipped and text.startswith(separator, at):
            found.append((start, at))
            start = skipped = at + len(separator)
    return [*found, (start, len(text))]


def first(text: str, separator: str) -> int:
    """Where the first separator stands outside parentheses, strings and comments; -1 if there is none."""
    end = parts(text, separator)[0][1]
    return end if end < len(text) else -1


def stripped(text: str, start: int, end: int) -> tuple[int, int]:
    """The part without white space around it."""
    while start < end and text[start].isspace():
        start += 1
    while start < end and text[end - 1].isspace():
        end -= 1
    return start, end
