"""The statements of a piece of Python, also those within others; expressions are not looked at, which takes long.

for node in statements(ast.parse(text).body): ...
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

_BODIES = ("body", "orelse", "finalbody", "handlers", "cases")
"""Where statements have statements, or what has some."""


def statements(nodes: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """All of them."""
    for node in nodes:
        yield node
        yield from statements(blocks(node))


def blocks(node: ast.AST) -> Iterator[ast.AST]:
    """What stands in the blocks of a statement."""
    for name in _BODIES:
        found = getattr(node, name, None)
        if isinstance(found, list):
            yield from found
