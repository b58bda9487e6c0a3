"""Tokens to syntax tree, with an LALR parser for the grammar in `grammar.lark`.

`parse_program("val x = 1")` gives a tuple of declarations whose infix operators are still flat (see `fixity`).
Syntax errors are reported with what was found and, in words, what could stand there.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from functools import cache, lru_cache
from itertools import pairwise
from typing import Any, cast

from pn2code.diagnostics import NOWHERE, Diagnostics, SourceText, Span
from pn2code.ml import codes
from pn2code.ml.parsing import advice, syntax
from pn2code.ml.parsing.lalr import Loop, SyntaxProblem
from pn2code.ml.parsing.lexer import Lexeme, insert_delay_parentheses, tokenize
from pn2code.ml.parsing.plain_text import guessed_names, old_declaration
from pn2code.ml.parsing.tables import tables
from pn2code.ml.parsing.tree import TreeBuilder
from pn2code.ml.parsing.tree_parts import Group, NotANameError

_OLD_DECLARATIONS = frozenset({"colset", "color", "var", "globref", "pageref", "instref"})


_BUILDER = TreeBuilder()


@cache
def _loop() -> Loop:
    return Loop.of(tables(), _BUILDER)


def parse_program(source: SourceText, d: Diagnostics) -> tuple[syntax.Dec, ...] | None:
    """Declarations; None when an error was reported."""
    tried = Diagnostics()
    tokens = tokenize(source, tried)
    if tokens is None:
        old = old_declaration(source.text)
        if old is None:
            d.items.extend(tried.items)
        else:  # `1..3` is no word of CPN ML, but that is not the point
            _refuse_old(old.word, source.span(old.start, old.end), d)
        return None
    if _old_declaration(source, tokens, d):
        return None
    tree = _parse(source, tokens, "program", d)
    return cast(tuple[syntax.Dec, ...], tree.items) if isinstance(tree, Group) else None


def parse_expression(
    source: SourceText, d: Diagnostics, *, output: bool = False, skip: int = 0
) -> syntax.Exp | None:
    """One expression.

    Args:
        source: the text.
        d: where errors go.
        output: put everything before the first `@+` in parentheses (rule for output arcs).
        skip: leave out so many tokens at the beginning.
    """
    tokens = tokenize(source, d)
    if tokens is None:
        return None
    hint = ""
    if output:
        changed = insert_delay_parentheses(tokens)
        if len(changed) != len(tokens):
            hint = "on an output arc CPN Tools puts everything before the first `@+` in parentheses"
        tokens = changed
    return cast("syntax.Exp | None", _parse(source, tokens[skip:], "expression", d, hint))


def is_layered(source: SourceText) -> bool:
    """Whether a text has the form `x as pattern` or `x : type as pattern`."""
    if "as" not in source.text:
        return False
    tokens = tokenize(source, Diagnostics()) or []
    depth = 0
    for i, token in enumerate(tokens):
        if token.kind == "AS" and not depth:
            return tokens[0].kind == "ID" and (i == 1 or tokens[1].kind == "COLON")
        depth += (token.kind in _OPENING) - (token.kind in _CLOSING)
    return False


def odd_declaration(source: SourceText) -> str:
    """The word of the first declaration in an expression that is not `val`; "" if there is none."""
    return _first(source, _DECLARING)


def opens(source: SourceText) -> bool:
    """Whether an expression opens a structure, however deep inside."""
    return "open" in source.text and bool(_first(source, frozenset({"OPEN"})))


def _first(source: SourceText, kinds: frozenset[str]) -> str:
    """The first word of these kinds that stands behind a `let`; "" if there is none."""
    if "let" not in source.text:
        return ""
    tokens = tokenize(source, Diagnostics()) or []
    return next((t.text for t in tokens if t.kind in kinds), "")


_DECLARING = frozenset(
    [
        "ABSTYPE",
        "DATATYPE",
        "EXCEPTION",
        "FUN",
        "INFIX",
        "INFIXR",
        "LOCAL",
        "NONFIX",
        "OPEN",
        "STRUCTURE",
        "TYPE",
    ]
)
"""Keywords that stand in an expression only where `let` declares something."""
_OPENING = frozenset({"LPAREN", "LBRACK", "LBRACE", "LET", "CASE", "FN"})
_CLOSING = frozenset({"RPAREN", "RBRACK", "RBRACE", "END"})


def parse_layered(source: SourceText, d: Diagnostics) -> tuple[syntax.Exp, syntax.Pat] | None:
    """`x as pattern`, as the two sides of `as`."""
    tokens = tokenize(source, d)
    if tokens is None:
        return None
    return cast("tuple[syntax.Exp, syntax.Pat] | None", _parse(source, tokens, "layered", d))


def parse_expressions(source: SourceText, d: Diagnostics) -> tuple[syntax.Exp, ...] | None:
    """One expression or several with commas between."""
    tokens = tokenize(source, d)
    if tokens is None:
        return None
    tree = _parse(source, tokens, "expressions", d)
    return cast(tuple[syntax.Exp, ...], tree.items) if isinstance(tree, Group) else None


def parse_code(source: SourceText, d: Diagnostics) -> syntax.CodeSegment | None:
    """A code segment."""
    tokens = tokenize(source, d, code_segment=True)
    if tokens is None:
        return None
    return cast("syntax.CodeSegment | None", _parse(source, tokens, "code", d))


def is_action_of_comments(source: SourceText) -> bool:
    """Whether a code segment ends with `action` and a comment: an action that does nothing."""
    tokens = tokenize(source, Diagnostics(), code_segment=True) or []
    return (
        bool(tokens) and tokens[-1].kind == "ACTION" and bool(source.text[tokens[-1].end :].strip())
    )


def misplaced_comment(source: SourceText) -> tuple[int, int] | None:
    """Where a code segment has a comment that CPN Tools does not skip: before `action`, or after the last `;`."""
    tokens = tokenize(source, Diagnostics(), code_segment=True) or []
    action = next((t.start for t in tokens if t.kind == "ACTION"), len(source.text))
    is_ended = bool(tokens) and tokens[-1].kind == "SEMI"
    rest = tokens[-1].end if is_ended else len(source.text)
    for start, end in ((0, action), (rest, len(source.text))):
        at = source.text.find("(*", start, end)
        if at >= 0:
            return at, source.text.find("*)", at) + 2
    return None


def declared_names(source: SourceText, start: int = 0, end: int | None = None) -> tuple[str, ...]:
    """Names that a text with syntax errors seems to declare, so that their uses are not reported as well."""
    starts, ends, names = _declared(source.text)
    first = bisect_left(starts, start)
    last = len(starts) if end is None else bisect_right(ends, end)
    return names[first:last]


@lru_cache(maxsize=4)
def _declared(text: str) -> tuple[tuple[int, ...], tuple[int, ...], tuple[str, ...]]:
    """Where the names begin and end that a text seems to declare, and they themselves."""
    tokens = tokenize(SourceText(text, NOWHERE), Diagnostics())
    if tokens is None:
        guessed = guessed_names(text)
        return (0,) * len(guessed), (0,) * len(guessed), guessed
    found = [
        token
        for before, token in pairwise(tokens)
        if before.kind in ("VAL", "FUN", "AND", "EXCEPTION", "REC") and token.kind == "ID"
    ]
    return (
        tuple(t.start for t in found),
        tuple(t.end for t in found),
        tuple(t.text for t in found),
    )


def _parse(
    source: SourceText, tokens: Sequence[Lexeme], start: str, d: Diagnostics, hint: str = ""
) -> Any:
    _BUILDER.source = source
    try:
        return _loop().parse(tokens, start)
    except NotANameError as problem:
        d.error(codes.SYNTAX_ERROR, problem.message, problem.span, hint="a name has no points")
        return None
    except SyntaxProblem as problem:
        _report(source, tokens, problem, d, hint, start)
        return None


def _old_declaration(source: SourceText, tokens: Sequence[Lexeme], d: Diagnostics) -> bool:
    for i, token in enumerate(tokens[:-1]):
        first = i == 0 or tokens[i - 1].kind == "SEMI"
        if first and token.kind == "ID" and token.text in _OLD_DECLARATIONS:
            following = tokens[i + 1].kind
            if following == "ID":
                _refuse_old(token.text, source.span(token.start, token.end), d)
                return True
    return False


def _refuse_old(word: str, at: Span, d: Diagnostics) -> None:
    d.error(
        codes.UNSUPPORTED_ML,
        f"a `{word}` declaration as plain text is not supported",
        at,
        hint="declare it in CPN Tools as a declaration of its own, not inside an ML declaration",
    )


# --- syntax errors in words --------------------------------------------------------------------

_WORDS = {
    "ID": "a name", "INT": "a number", "WORD": "a word", "TYVAR": "a type variable", "$END": "the end of the text",
    "LPAREN": "`(`", "RPAREN": "`)`", "LBRACK": "`[`", "RBRACK": "`]`", "LBRACE": "`{`", "RBRACE": "`}`",
    "COMMA": "`,`", "SEMI": "`;`", "WILD": "`_`", "DOTS": "`...`", "COLON": "`:`", "BAR": "`|`", "EQ": "`=`",
    "DARROW": "`=>`", "ARROW": "`->`", "HASH": "`#`", "STAR": "`*`",
}  # fmt: skip
_STARTS_OF = {
    "expression": "ID INT WORD REAL STRING CHAR LPAREN LBRACK LBRACE HASH OP EQ STAR LET RAISE IF WHILE CASE FN ANDALSO"
    " ORELSE COLON HANDLE",
    "pattern": "ID INT WORD REAL STRING CHAR LPAREN LBRACK LBRACE OP STAR WILD AS COLON HASH",
    "type": "ID TYVAR LPAREN LBRACE",
    "declaration": "VAL FUN TYPE DATATYPE ABSTYPE EXCEPTION LOCAL OPEN INFIX INFIXR NONFIX STRUCTURE SIGNATURE FUNCTOR"
    " SEMI",
    "operand end": "ID INT WORD REAL STRING CHAR RPAREN RBRACK RBRACE END WILD TYVAR",
}
_EXP_START, _PAT_START, _TYPE_START, _DEC_START, _OPERAND_END = (
    frozenset(terminals.split()) for terminals in _STARTS_OF.values()
)


def _report(
    source: SourceText,
    tokens: Sequence[Lexeme],
    problem: SyntaxProblem,
    d: Diagnostics,
    hint: str,
    start: str,
) -> None:
    token = problem.token
    at_end = token is None
    kind, word = ("$END", "") if token is None else (token.kind, token.text)
    if token is None:
        end = tokens[-1].end if tokens else 0
        span = Span(source, end, end)
        found = "text ends too early" if tokens else "text is empty"
        previous = tokens[-1] if tokens else None
    else:
        span = Span(source, token.start, token.end)
        if kind == "AS" and start != "program":
            d.error(
                codes.SYNTAX_ERROR,
                "`as` cannot be used here",
                span,
                hint="`x as pattern` is the whole inscription of an input arc of an untimed colour set",
            )
            return
        found = f"unexpected `{word}`" if word else "unexpected `)`"
        before = [t for t in tokens if t.end <= span.start and t.text]
        previous = before[-1] if before else None
    expected = _expected(problem, previous)
    message = f"{found}, {expected} expected" if expected else found
    before = [t for t in tokens if t.end <= span.start or at_end]
    accepted = problem.accepts
    after = [t for t in tokens if t.start >= span.end and not at_end]
    hint = hint or advice.syntax(kind, word, before, after, accepted, start)
    hint = hint or advice.BY_CODE[codes.SYNTAX_ERROR]
    d.error(codes.SYNTAX_ERROR, message, span, hint=hint)


def _expected(problem: SyntaxProblem, previous: Lexeme | None) -> str:
    accepts = set(problem.accepts)
    after_operand = (
        previous is not None
        and previous.kind in _OPERAND_END
        and (previous.kind != "ID" or previous.text[0].isalpha())
    )
    words: list[str] = []
    groups = (
        ("FN", "an expression", _EXP_START),
        ("WILD", "a pattern", _PAT_START),
        ("VAL", "a declaration", _DEC_START),
        ("TYVAR", "a type", _TYPE_START),
    )
    for key, word, members in groups:
        if key in accepts:
            accepts -= members
            if not (after_operand and key in ("FN", "WILD")):
                words.append(word)
    words += sorted(_WORDS.get(a, f"`{a.lower()}`") for a in accepts)
    if len(words) > 5:
        words = [*words[:4], "..."]
    return " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
