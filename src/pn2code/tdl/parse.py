"""Text of a script -> syntax tree, or diagnostics with line and caret.

parse(SourceText("program p begin wait 2.5 s end program", Origin("p.tdl", 1, 1)), d)
-> Program("p", (), (), (WaitTime(Quantity(2.5, "s")),))
"""

from __future__ import annotations

from typing import Any

from lark import Token, Tree
from lark.exceptions import UnexpectedCharacters, UnexpectedToken

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.tdl import codes
from pn2code.tdl import tree as t
from pn2code.tdl.build_tree import build
from pn2code.tdl.parser import parser
from pn2code.tdl.syntax_errors import unexpected_characters, unexpected_token

MAX_EXPRESSION_DEPTH = 100
MAX_BLOCK_DEPTH = 40


def parse(source: SourceText, d: Diagnostics) -> t.Program | None:
    """Parse a script; None when something was reported."""
    before = len(d.errors)
    try:
        tree = _parse(source.text)
    except UnexpectedCharacters as problem:
        unexpected_characters(problem, source, d)
        return None
    except UnexpectedToken as problem:
        unexpected_token(problem, source, d)
        return None
    program = build(tree, source, d) if not _too_deep(tree, source, d) else None
    return program if len(d.errors) == before else None


def _parse(text: str) -> Tree[Token]:
    try:
        return parser("basic").parse(text)
    except UnexpectedCharacters:
        # The same language; this lexer knows what could stand there, but takes much longer to make.
        return parser("contextual").parse(text)


def _too_deep(tree: Any, source: SourceText, d: Diagnostics) -> bool:
    """Whether blocks or expressions are nested beyond the limits (walks without recursion).

    The stages behind walk the tree recursively; the limit keeps them far from Python's own.
    """
    stack: list[tuple[Any, int, int]] = [(tree, 0, 0)]
    while stack:
        node, blocks, expressions = stack.pop()
        if isinstance(node, Token):
            continue
        if node.data == "block":
            blocks, expressions = blocks + 1, 0
        elif node.data in ("binary", "unary", "conditional", "parenthesised", "function", "field",
                           "record", "tuple", "each"):  # fmt: skip
            expressions += 1
        if blocks > MAX_BLOCK_DEPTH or expressions > MAX_EXPRESSION_DEPTH:
            what = "blocks are" if blocks > MAX_BLOCK_DEPTH else "the expression is"
            start = node.meta.start_pos
            d.error(
                codes.NESTING,
                f"{what} nested too deeply",
                source.span(start, start + 1),
                hint="use a procedure" if blocks > MAX_BLOCK_DEPTH else "use a variable",
            )
            return True
        stack.extend((c, blocks, expressions) for c in node.children)
    return False
