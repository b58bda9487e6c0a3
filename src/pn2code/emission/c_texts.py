"""Pieces of text that several parts of net.c have."""

from __future__ import annotations

from pn2code.diagnostics import Origin
from pn2code.emission.c_literals import c_big_initialiser
from pn2code.emission.environment import c_comment
from pn2code.ir.nodes import Rep


def where(origin: Origin) -> str:
    """File, without its folder, and line."""
    name = origin.file.replace("\\", "/").rsplit("/", 1)[-1]
    return c_comment(f"{name}:{origin.line}" if origin.line else name)


def comment_lines(source: str) -> list[str]:
    """The ML text as comment lines, blank lines left out."""
    return [
        c_comment(line) if not line.startswith(" ") else _indented(line)
        for line in source.expandtabs(4).splitlines()
        if line.strip()
    ]


def _indented(line: str) -> str:
    text = line.lstrip()
    return " " * (len(line) - len(text)) + c_comment(text)


def initial(zero: str, rep: Rep) -> str:
    """The harmless value as the initialiser of a static variable."""
    if rep is Rep.STRING:
        return '{ "", 0U }'
    if rep is Rep.BIG:
        return c_big_initialiser(0)
    return "{ 0 }" if rep in (Rep.STRUCT, Rep.UNION) else zero
