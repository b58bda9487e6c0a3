"""What a parser expected, in words for a message: "`(`, a name or a number"."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lark import Lark

_MOST = 6


def listed(words: Iterable[str]) -> str:
    """Alternatives, each once; of many the first ones."""
    found = list(dict.fromkeys(words))
    if len(found) > _MOST:
        found = [*found[:_MOST], "..."]
    return found[0] if len(found) == 1 else f"{', '.join(found[:-1])} or {found[-1]}"


def literal(parser: Lark, terminal: str) -> str:
    """The text of a terminal that is always written in the same way."""
    pattern = next((x.pattern for x in parser.terminals if x.name == terminal), None)
    return f"`{pattern.value}`" if pattern is not None else terminal.lower()
