"""CPN ML text to tokens.

A token is a `Lexeme` with its place in the text; literals carry their value. Comments nest, so this is written by hand;
the grammar proper is in `grammar.lark`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from typing import NamedTuple

from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml import codes
from pn2code.ml.parsing import advice

_KEYWORDS = """
abstype and andalso as case datatype do else end eqtype exception fn fun functor handle if in include infix infixr let
local nonfix of op open orelse raise rec sharing sig signature struct structure then type val where while with withtype
"""
MAX_TOKENS = 300_000
"""Longest text that is read; checking takes seconds for each hundred thousand symbols."""
KEYWORDS: frozenset[str] = frozenset(_KEYWORDS.split())
CODE_WORDS: frozenset[str] = frozenset({"input", "output", "action"})
"""Keywords in code segments only."""

PUNCTUATION: dict[str, str] = {
    "(": "LPAREN", ")": "RPAREN", "[": "LBRACK", "]": "RBRACK", "{": "LBRACE", "}": "RBRACE", ",": "COMMA", ";": "SEMI",
    "_": "WILD", "...": "DOTS",
}  # fmt: skip
RESERVED_SYMBOLS: dict[str, str] = {
    ":": "COLON", "|": "BAR", "=": "EQ", "=>": "DARROW", "->": "ARROW", "#": "HASH", "*": "STAR", ":>": "SEAL",
}  # fmt: skip

_SYMBOL = r"[!%&$#+\-/:<=>?@\\~`^|*]"
_ALPHA = r"[A-Za-z][A-Za-z0-9_']*"
_SPACE = re.compile(r"[ \t\r\n\f\v]+")
_SPACES = " \t\r\n\f\v"
_NUMBER = re.compile(
    r"~?0w(?:x[0-9a-fA-F]+|[0-9]+)|~?0x[0-9a-fA-F]+|~?[0-9]+(?:\.[0-9]+)?(?:[eE]~?[0-9]+)?"
)
_NAME = re.compile(rf"(?:{_ALPHA}\.)*(?:{_ALPHA}|(?<=\.){_SYMBOL}+)")
_TYVAR = re.compile(r"'[A-Za-z0-9_']*")
_SYMBOLIC = re.compile(rf"{_SYMBOL}+")
_COMMENT_MARK = re.compile(r"\(\*|\*\)")
_SIMPLE_ESCAPES = {
    "n": "\n", "t": "\t", "a": "\a", "b": "\b", "v": "\v", "f": "\f", "r": "\r", '"': '"', "\\": "\\",
}  # fmt: skip


class Lexeme(NamedTuple):
    """A token.

    Args:
        kind: terminal name of the grammar.
        start, end: character offsets.
        text: as written, but for white space and comments inside a long name.
        value: of a literal.
    """

    kind: str
    start: int
    end: int
    text: str
    value: int | float | str | None = None


def tokenize(
    source: SourceText, d: Diagnostics, *, code_segment: bool = False
) -> list[Lexeme] | None:
    """All tokens of a text; None when an error was reported."""
    return _Lexer(source, d, code_segment).run()


class _Lexer:
    def __init__(self, source: SourceText, d: Diagnostics, code_segment: bool) -> None:
        self._source = source
        self._text = source.text
        self._d = d
        self._words = KEYWORDS | CODE_WORDS if code_segment else KEYWORDS
        self._at = 0
        self._tokens: list[Lexeme] = []

    def run(self) -> list[Lexeme] | None:
        while self._at < len(self._text):
            if self._text[self._at] in _SPACES and (m := _SPACE.match(self._text, self._at)):
                self._at = m.end()
            elif self._text.startswith("(*", self._at):
                if not self._comment():
                    return None
            elif not self._token():
                return None
            elif len(self._tokens) > MAX_TOKENS:
                self._d.error(
                    codes.TEXT_TOO_LONG,
                    f"this text has more than {MAX_TOKENS} symbols",
                    self._source.span(0, min(40, len(self._text))),
                    hint="split it into several declarations",
                )
                return None
        return self._tokens

    def _error(self, start: int, end: int, message: str, hint: str = "") -> bool:
        self._d.error(codes.LEXICAL_ERROR, message, self._source.span(start, end), hint=hint)
        return False

    def _comment(self) -> bool:
        start, depth, at = self._at, 1, self._at + 2
        while depth:
            m = _COMMENT_MARK.search(self._text, at)
            if m is None:
                return self._error(
                    start, start + 2, "comment is not closed", "comments end with `*)`"
                )
            depth += 1 if m.group() == "(*" else -1
            at = m.end()
        self._at = at
        return True

    def _add(self, kind: str, end: int, value: int | float | str | None = None) -> bool:
        self._tokens.append(Lexeme(kind, self._at, end, self._text[self._at : end], value))
        self._at = end
        return True

    def _token(self) -> bool:
        text, at = self._text, self._at
        punctuation = PUNCTUATION.get(text[at])
        if punctuation is not None:
            return self._add(punctuation, at + 1)
        if m := _NUMBER.match(text, at):
            return self._number(m)
        if m := _NAME.match(text, at):
            word = m.group()
            return self._add(word.upper() if word in self._words else "ID", m.end())
        if text[at] == "." and (rest := self._rest_of_name()):
            return rest
        if text[at] == '"':
            return self._string(at, "STRING")
        if text.startswith('#"', at):
            return self._string(at + 1, "CHAR")
        if m := _TYVAR.match(text, at):
            return self._add("TYVAR", m.end())
        if text.startswith("...", at):
            return self._add("DOTS", at + 3)
        if m := _SYMBOLIC.match(text, at):
            return self._add(RESERVED_SYMBOLS.get(m.group(), "ID"), m.end())
        return self._error(at, at + 1, *advice.unknown_character(text[at], text[:at]))

    def _rest_of_name(self) -> bool:
        """White space and comments may stand beside the points of a long name: `INT (* c *) . mkstr`."""
        if (
            not self._tokens
            or self._tokens[-1].kind != "ID"
            or not _NAME.match(self._tokens[-1].text)
        ):
            return False
        first, point = self._tokens[-1], self._at
        self._at += 1
        while m := _SPACE.match(self._text, self._at) or self._text.startswith("(*", self._at):
            if isinstance(m, re.Match):
                self._at = m.end()
            elif not self._comment():
                break
        rest = _NAME.match(self._text, self._at) or _SYMBOLIC.match(self._text, self._at)
        if rest is None or rest.group() in self._words:
            self._at = point
            return False
        self._tokens[-1] = Lexeme("ID", first.start, rest.end(), f"{first.text}.{rest.group()}")
        self._at = rest.end()
        return True

    def _number(self, m: re.Match[str]) -> bool:
        word, end = m.group(), m.end()
        digits = word.replace("~", "-")
        if "w" in word:
            if word.startswith("~"):
                return self._error(self._at, end, "a word literal has no sign")
            number = word.removeprefix("0w")
            return self._add("WORD", end, int("0" + number, 16 if "x" in number else 10))
        if "x" in word:
            return self._add("INT", end, int(digits, 16))
        if any(c in word for c in ".eE"):
            value = float(digits)
            if value in (float("inf"), float("-inf")):
                return self._error(self._at, end, f"real number `{word}` is too large")
            if abs(value) < sys.float_info.min and re.match(r"[-.0]*[1-9]", digits):
                return self._error(self._at, end, f"real number `{word}` is too small")
            return self._add("REAL", end, value)
        if len(digits) > 4000:
            return self._error(self._at, end, "integer has more than 4000 digits")
        return self._add("INT", end, int(digits))

    def _string(self, quote: int, kind: str) -> bool:
        text, at, out = self._text, quote + 1, []
        while True:
            if at >= len(text) or text[at] == "\n":
                return self._error(
                    self._at, at, "string is not closed",
                    'a string ends with `"` on the same line; a quote inside is written `\\"`',
                )  # fmt: skip
            c = text[at]
            if c == '"':
                break
            if c < " ":
                return self._error(
                    at, at + 1, "a string holds a tab or another character that is not printed",
                    "write `\\t` for a tab",
                )  # fmt: skip
            if c != "\\":
                # Characters are bytes: what Latin-1 does not have is several, those of UTF-8.
                out.append(c if c <= "\xff" else c.encode().decode("latin-1"))
                at += 1
                continue
            found = self._escape(at)
            if found is None:
                return self._error(
                    at, min(at + 2, len(text)), f"`{text[at : at + 2]}` is not an escape of CPN ML",
                    'known: \\n \\t \\" \\\\ \\ddd (three digits), \\^c',
                )  # fmt: skip
            value, at = found
            out.append(value)
        content = "".join(out)
        if kind == "CHAR" and len(content) != 1:
            return self._error(self._at, at + 1, "a character literal holds exactly one character")
        return self._add(kind, at + 1, content)

    def _escape(self, at: int) -> tuple[str, int] | None:
        """The character that the escape at a backslash stands for, and the offset after it."""
        text = self._text
        rest = text[at + 1 : at + 6]
        if not rest:
            return None
        if rest[0] in _SIMPLE_ESCAPES:
            return _SIMPLE_ESCAPES[rest[0]], at + 2
        if rest[0] == "^" and len(rest) > 1 and "@" <= rest[1] <= "_":
            return chr(ord(rest[1]) - 64), at + 3
        if re.fullmatch(r"[0-9]{3}", rest[:3]) and int(rest[:3]) < 256:
            return chr(int(rest[:3])), at + 4
        if (m := _SPACE.match(text, at + 1)) and text.startswith("\\", m.end()):
            return "", m.end() + 1  # a gap: \ white space \
        return None


def insert_delay_parentheses(tokens: Sequence[Lexeme]) -> list[Lexeme]:
    """Puts everything before the first `@+` (or `@++`) in parentheses, as CPN Tools does on output arcs."""
    for i, t in enumerate(tokens):
        if t.kind == "ID" and t.text.startswith("@+"):
            if i == 0:
                break
            first, last = tokens[0], tokens[i - 1]
            return [
                Lexeme("LPAREN", first.start, first.start, ""),
                *tokens[:i],
                Lexeme("RPAREN", last.end, last.end, ""),
                *tokens[i:],
            ]
    return list(tokens)
