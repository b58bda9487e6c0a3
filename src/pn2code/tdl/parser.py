"""The parser of the language, made from its grammar and kept for the next start."""

from __future__ import annotations

from functools import cache

from lark import Lark

from pn2code.base.parser_cache import kept_lark
from pn2code.tdl.grammar import GRAMMAR


@cache
def parser(lexer: str) -> Lark:
    """The parser of the language with one of lark's lexers."""
    return kept_lark(
        "tdl", GRAMMAR, lexer=lexer, propagate_positions=True, maybe_placeholders=False
    )
