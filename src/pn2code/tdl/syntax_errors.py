"""What is said where a script does not follow the grammar: what stands there, and what could."""

from __future__ import annotations

from typing import cast

from lark.exceptions import UnexpectedCharacters, UnexpectedToken

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.diagnostics.expected import listed, literal
from pn2code.tdl import codes
from pn2code.tdl.grammar import KEYWORDS
from pn2code.tdl.parser import parser

_WORDS = {
    "NAME": "a name", "STRING": "a text in quotes", "INT": "a number", "REAL": "a number",
    "QUANTITY": "a number", "MOTION": "`$joint` or `$linear`", "$END": "the end of the script",
    "COLON": "`:`", "COMMA": "`,`", "LPAR": "`(`", "RPAR": "`)`", "LBRACE": "`{`", "RBRACE": "`}`",
    "LSQB": "`[`", "RSQB": "`]`", "DOT": "`.`", "EQUAL": "`=`", "__COLON_EQUAL": "`:=`",
    "NOT_EQUAL": "`<>`", "LESS": "`<`", "LESS_EQUAL": "`<=`", "GREATER": "`>`",
    "GREATER_EQUAL": "`>=`", "PLUS": "`+`", "MINUS": "`-`", "AMPERSAND": "`&`", "TIMES": "`*`",
    "DIVIDE": "`/`",
}  # fmt: skip


_STATEMENTS = {
    "MOVE",
    "WAIT",
    "READ",
    "CLEAR",
    "WRITE",
    "MEASURE",
    "COMPUTE",
    "SENSE",
    "MARK",
    "STOP",
    "CALL",
    "GOTO",
}


_OPERATORS = {
    "OR", "AND", "EQUAL", "NOT_EQUAL", "LESS", "LESS_EQUAL", "GREATER", "GREATER_EQUAL", "PLUS",
    "MINUS", "AMPERSAND", "TIMES", "DIVIDE", "DIV", "MOD", "DOT", "LPAR",
}  # fmt: skip


_VALUES = {
    "SINGLE",
    "INT",
    "REAL",
    "QUANTITY",
    "STRING",
    "TRUE",
    "FALSE",
    "LPAR",
    "MINUS",
    "NOT",
    "IF",
    "NAME",
}


def _expected(terminals: set[str]) -> str:
    """What could stand here, in a few words."""
    left = set(terminals)
    words = []
    if left >= _STATEMENTS:
        # Between statements: what continues the one before is of no help.
        left -= {*_STATEMENTS, *_OPERATORS, "NAME", "SPEED", "TOOL", "RETURN", "EXIT", "IF", "WHILE", "LOOP",
                 "COMMA", "IN", "AT", "WITH", "WHEN"}  # fmt: skip
        words.append("a statement")
    elif left >= _VALUES - {"IF", "NOT", "SINGLE"}:
        left -= _VALUES
        words.append("a value")
    elif left >= {"PLUS", "TIMES"}:
        left -= _OPERATORS
        words.append("an operator")
    words += [_WORDS.get(name) or literal(parser("basic"), name) for name in sorted(left)]
    return listed(words)


def unexpected_token(problem: UnexpectedToken, source: SourceText, d: Diagnostics) -> None:
    """Says what stands where something else is expected, and what that could be."""
    token = problem.token
    expected = set(problem.accepts or problem.expected)
    if token.type == "$END":
        d.error(
            codes.SYNTAX,
            f"the script ends here, but {_expected(expected)} is expected",
            source.span(len(source.text.rstrip()), len(source.text.rstrip()) + 1),
            hint="close every block: `end if`, `end loop`, `end procedure`, `end program`",
        )
        return
    start = cast(int, token.start_pos)
    hint = ""
    if token.type == "EQUAL" and "__COLON_EQUAL" in {_plain(e) for e in expected}:
        hint = "assignment is written `:=`"
    elif str(token) in KEYWORDS and "NAME" in expected:
        hint = f"`{token}` is a word of the language and cannot be a name"
    d.error(
        codes.SYNTAX,
        f"`{token}` cannot be used here: {_expected({_plain(e) for e in expected})} is expected",
        source.span(start, start + len(token)),
        hint=hint,
    )


def _plain(terminal: str) -> str:
    """Lark numbers the terminals it has no name for; `:=` is the only one of ours."""
    return "__COLON_EQUAL" if terminal.startswith("__ANON") else terminal


def unexpected_characters(
    problem: UnexpectedCharacters, source: SourceText, d: Diagnostics
) -> None:
    """Says which characters begin no word of the language there."""
    at = cast(int, problem.pos_in_stream)
    rest = source.text[at:]
    allowed = {_plain(a) for a in (problem.allowed or set())} - {"COMMENT", "WHITE"}
    if rest.startswith('"'):
        end = rest.find("\n")
        d.error(
            codes.SYNTAX,
            "the text in quotes does not end on its line, or holds an unknown `\\` sequence",
            source.span(at, len(source.text) if end < 0 else at + end),
            hint='write `\\"`, `\\\\`, `\\n` or `\\t` inside quotes',
        )
        return
    word = rest[0]
    if rest[0].isalpha() or rest[0] == "_":
        word = _leading_word(rest)
    hint = ""
    if word in KEYWORDS and "NAME" in allowed:
        hint = f"`{word}` is a word of the language and cannot be a name"
    shown = word if word.isprintable() else f"character {ord(word[0])}"
    d.error(
        codes.SYNTAX,
        f"`{shown}` cannot be used here: {_expected(allowed)} is expected"
        if allowed
        else f"`{shown}` cannot be used here",
        source.span(at, at + len(word)),
        hint=hint,
    )


def _leading_word(text: str) -> str:
    end = 0
    while end < len(text) and (text[end].isalnum() or text[end] == "_"):
        end += 1
    return text[:end]
