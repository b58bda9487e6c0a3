"""Text of a property -> syntax tree, or a diagnostic with line and caret.

parse(SourceText("always { size (Mark.Top'P 1) <= 3 }", Origin("command line", 1, 1)), d)
-> Marking("always", Ml(" size (Mark.Top'P 1) <= 3 "))
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, cast

from pn2code.base.parser_cache import kept_lark
from pn2code.diagnostics import Diagnostics, SourceText, Span
from pn2code.diagnostics.expected import listed, literal
from pn2code.diagnostics.suggestions import did_you_mean
from pn2code.properties import codes
from pn2code.properties import tree as t
from pn2code.properties.chunks import blanked, part
from pn2code.properties.grammar import GRAMMAR, KEYWORDS
from pn2code.properties.loop import OPTIONS, Node, Piece, parsed

if TYPE_CHECKING:
    from lark import Lark
    from lark.exceptions import UnexpectedToken

MAX_LENGTH = 100_000
"""Characters of a property."""
MAX_DEPTH = 200
"""Nesting of its formula; the stages behind recurse over it."""
MOST_DIGITS = 18
"""Of a number before the point: whoever reads it does so with 64 bits."""
_FIRST = ("deadlock", "bound", "always", "never", "reachable", "mutex", "every", "ctl", "ltl")


def parse(source: SourceText, d: Diagnostics) -> t.Property | None:
    """Parse a property; None when something was reported."""
    return cast(t.Property | None, _read(source, "start", d))


def parse_fair(source: SourceText, d: Diagnostics) -> t.Fair | None:
    """Parse an assumption, `weak Page'Transition 1`; None when something was reported."""
    return cast(t.Fair | None, _read(source, "fair", d))


def _read(source: SourceText, start: str, d: Diagnostics) -> Any:
    if len(source.text) > MAX_LENGTH:
        d.error(
            codes.SYNTAX,
            f"the property is longer than {MAX_LENGTH:,} characters",
            source.span(0, 40),
            hint="give parts of it a name: functions of the net can be used in it",
        )
        return None
    if "\x00" in source.text:
        d.error(codes.SYNTAX, "the property has a character 0", source.span(0, 1))
        return None
    text, unclosed = blanked(source.text)
    if unclosed is not None:
        d.error(
            codes.SYNTAX,
            "this brace is not closed",
            source.span(unclosed, unclosed + 1),
            hint="a condition in CPN ML ends with `}`; braces of its records and strings count for themselves",
        )
        return None
    before = len(d.errors)
    tree = parsed(text, start)
    if tree is None:
        _say_why(text, start, source, d)
        return None
    if _too_deep(tree, source, d):
        return None
    found = _Builder(source, d).value(tree)
    return found if len(d.errors) == before else None


@cache
def _parser() -> Lark:
    return kept_lark("property", GRAMMAR, **OPTIONS)


# --- messages ----------------------------------------------------------------------------------

_CONDITION = "a condition"
_WORDS = {
    "NAME": "a name like `Page'Name`", "STRING": "a name like `Page'Name`", "INT": "a number",
    "REAL": "a number", "COMPARISON": "a comparison", "$END": "the end", "ML": _CONDITION,
}  # fmt: skip
_FORMULA = {
    "ML", "TRUE", "FALSE", "DEAD", "INITIAL", "ENABLED", "FIRES", "TOKENS", "LPAR", "NOT", "BANG", "X", "F", "G",
    "AX", "EX", "AF", "EF", "AG", "EG", "A", "E", "INT",
}  # fmt: skip
_BETWEEN = {"U", "R", "W", "AND", "OR"}
_FOREIGN = {
    "andalso": "write `&&` or `and`", "orelse": "write `||` or `or`", "implies": "write `->`", "iff": "write `<->`",
    "GF": "write `G F`", "FG": "write `F G`", "next": "write `X`", "eventually": "write `F`", "globally": "write `G`",
    "until": "write `U`", "Mark": "CPN ML stands in braces: `{ .. }`", "size": "CPN ML stands in braces: `{ .. }`",
}  # fmt: skip


def _say_why(text: str, start: str, source: SourceText, d: Diagnostics) -> None:
    """Why a text is no property, as lark finds it."""
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    try:
        _parser().parse(text, start=start)
    except UnexpectedCharacters as problem:
        at = cast(int, problem.pos_in_stream)
        _unexpected_character(text, at, source, d)
    except UnexpectedToken as problem:
        _unexpected_token(problem, source, d)
    else:
        raise AssertionError("lark reads what its tables refuse")


def _expected(terminals: set[str]) -> str:
    """What could stand here, in a few words."""
    left = set(terminals)
    words: list[str] = []
    if "ML" in left:
        left -= _FORMULA
        words.append(_CONDITION)
    elif {"U", "R", "W"} & left:
        left = {x for x in left if x not in _BETWEEN and not x.startswith("__ANON")}
        words.append("an operator")
    words += [_WORDS.get(name) or literal(_parser(), name) for name in sorted(left)]
    return listed(words)


def _unexpected_token(problem: UnexpectedToken, source: SourceText, d: Diagnostics) -> None:
    token = problem.token
    expected = {str(x) for x in (problem.accepts or problem.expected)}
    if token.type == "$END":
        end = len(source.text.rstrip())
        if not end and "DEADLOCK" in expected:
            d.error(
                codes.SYNTAX,
                "the property is empty",
                source.span(0, 1),
                hint="e.g. `deadlock free`, or `always { size (Mark.Page'Place 1) <= 3 }`",
            )
            return
        d.error(
            codes.SYNTAX,
            f"the property ends here, but {_expected(expected)} is expected",
            source.span(end, end + 1),
            hint="docs/properties.md has an example of each kind",
        )
        return
    start = cast(int, token.start_pos)
    word = source.text[start : start + len(token)]
    if not source.text[:start].strip() and "DEADLOCK" in expected:
        d.error(
            codes.SYNTAX,
            f"`{_short(word)}` is no kind of property",
            source.span(start, start + len(token)),
            hint=did_you_mean(word, _FIRST)
            or f"it begins with {', '.join(f'`{x}`' for x in _FIRST[:-1])} or `{_FIRST[-1]}`",
        )
        return
    hint = _FOREIGN.get(word, "")
    if not hint and word in KEYWORDS and "NAME" in expected:
        hint = f"`{word}` is a word of the language: write the name with its page, `Page'{word}`"
    if not hint and token.type == "NAME" and len(word) > 2:
        hint = did_you_mean(word, [x for x in KEYWORDS if x.upper() in expected])
    if not hint and token.type == "NAME" and "ML" in expected:
        hint = f"say what of it: `tokens({word}) >= 1`, `enabled({word})`, or CPN ML in braces"
    d.error(
        codes.SYNTAX,
        f"`{_short(word)}` cannot be used here: {_expected(expected)} is expected",
        source.span(start, start + len(token)),
        hint=hint or "docs/properties.md has an example of each kind",
    )


def _short(text: str) -> str:
    return text if len(text) <= 30 else f"{text[:27]}..."


def _unexpected_character(text: str, at: int, source: SourceText, d: Diagnostics) -> None:
    sign = text[at]
    hint = {
        "&": "write `&&`",
        "|": "write `||`",
        '"': "a path in quotes ends on its line",
        "}": "there is no `{` before it",
        "-": "numbers here are not negative",
        "~": "numbers here are not negative",
    }.get(sign, "CPN ML stands in braces: `{ .. }`")
    shown = sign if sign.isprintable() else f"character {ord(sign)}"
    d.error(codes.SYNTAX, f"`{shown}` cannot be used here", source.span(at, at + 1), hint=hint)


def _too_deep(tree: Node, source: SourceText, d: Diagnostics) -> bool:
    stack: list[tuple[Any, int]] = [(tree, 0)]
    while stack:
        node, depth = stack.pop()
        if isinstance(node, Piece):
            continue
        if depth > MAX_DEPTH:
            start = node.start_pos
            d.error(
                codes.SYNTAX,
                "the property is nested too deeply",
                source.span(start, start + 1),
                hint="write two properties, or give a condition a name as a function of the net",
            )
            return True
        stack.extend((c, depth + 1) for c in node.children)
    return False


# --- building the tree -------------------------------------------------------------------------


class _Builder:
    """The tree of the text -> that of the property. A method gets the node, and what was made of its parts."""

    def __init__(self, source: SourceText, d: Diagnostics) -> None:
        self._source = source
        self._d = d

    def value(self, node: Node) -> Any:
        """What a node means."""
        parts = [self.value(c) if isinstance(c, Node) else c for c in node.children]
        return getattr(self, node.name)(node, parts)

    def _span(self, node: Node) -> Span:
        return self._source.span(node.start_pos, node.end_pos)

    def _digits(self, token: Piece) -> str:
        """A number as it is written, or (reported) 0."""
        if len(token.partition(".")[0]) <= MOST_DIGITS:
            return str(token)
        start = token.start_pos
        self._d.error(
            codes.SYNTAX,
            f"`{_short(token)}` is too large",
            self._source.span(start, start + len(token)),
            hint=f"a number has at most {MOST_DIGITS} digits",
        )
        return "0"

    def _number(self, token: Piece) -> int:
        return int(self._digits(token))

    # kinds

    def deadlock(self, _: Node, c: list[Any]) -> t.Property:
        return t.DeadlockFree(c[0] if c else None)

    def upper(self, _: Node, c: list[Any]) -> t.Property:
        return t.Bound(c[0], None, self._number(c[1]))

    def lower(self, _: Node, c: list[Any]) -> t.Property:
        return t.Bound(c[1], self._number(c[0]), None)

    def both(self, _: Node, c: list[Any]) -> t.Property:
        return t.Bound(c[1], self._number(c[0]), self._number(c[2]))

    def always(self, _: Node, c: list[Any]) -> t.Property:
        return t.Marking("always", c[0])

    def never(self, _: Node, c: list[Any]) -> t.Property:
        return t.Marking("never", c[0])

    def reachable(self, _: Node, c: list[Any]) -> t.Property:
        return t.Marking("reachable", c[0])

    def mutex(self, _: Node, c: list[Any]) -> t.Property:
        return t.Mutex(tuple(t.Marked(x, x.span) if isinstance(x, t.Name) else x for x in c))

    def response(self, _: Node, c: list[Any]) -> t.Property:
        made = t.Response(c[0], c[1])
        if len(c) == 2:
            return made
        kind, value = c[2]
        if kind == "firings":
            return t.Response(c[0], c[1], firings=int(value))
        if kind == "time":
            return t.Response(c[0], c[1], time=str(value))
        return t.Response(c[0], c[1], fair=value)

    def within_firings(self, _: Node, c: list[Any]) -> tuple[str, Any]:
        return "firings", self._digits(c[0])

    def within_time(self, _: Node, c: list[Any]) -> tuple[str, Any]:
        return "time", self._digits(c[0])

    def assuming(self, _: Node, c: list[Any]) -> tuple[str, Any]:
        return "assuming", tuple(c)

    def fair(self, _: Node, c: list[Any]) -> t.Fair:
        return t.Fair(c[0] != "weak", c[-1] if isinstance(c[-1], t.Name) else None)

    def ctl(self, _: Node, c: list[Any]) -> t.Property:
        return t.Branching(c[0])

    def ltl(self, _: Node, c: list[Any]) -> t.Property:
        return t.Linear(c[0], c[1][1] if len(c) > 1 else ())

    # formulas

    def iff(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation("iff", tuple(c), None, self._span(node))

    def implies(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation("implies", tuple(c), None, self._span(node))

    def disjunction(self, node: Node, c: list[Any]) -> t.Formula:
        return self._joined("or", c, self._span(node))

    def conjunction(self, node: Node, c: list[Any]) -> t.Formula:
        return self._joined("and", c, self._span(node))

    def _joined(self, operator: str, parts: list[t.Formula], span: Span) -> t.Formula:
        """As a balanced tree: hundreds of parts are no problem for those who recurse over it."""
        if len(parts) == 1:
            return parts[0]
        middle = len(parts) // 2
        halves = (
            self._joined(operator, parts[:middle], span),
            self._joined(operator, parts[middle:], span),
        )
        return t.Operation(operator, halves, None, span)

    def until(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation(str(c[1]), (c[0], c[2]), None, self._span(node))

    def negation(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation("not", tuple(c), None, self._span(node))

    def temporal(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation(str(c[0]), (c[1],), None, self._span(node))

    def step(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Operation(str(c[0]), (c[2],), c[1], self._span(node))

    def quantified(self, node: Node, c: list[Any]) -> t.Formula:
        quantifier, inner = c
        if isinstance(inner, t.Operation) and inner.operator in ("U", "R", "W"):
            return t.Operation(f"{quantifier}{inner.operator}", inner.parts, None, self._span(node))
        self._d.error(
            codes.SYNTAX,
            f"`U` (or `W`, `R`) is expected between the brackets of `{quantifier}[ .. ]`",
            self._span(node),
            hint=f"write `{quantifier}[p U q]`, or `{quantifier}G p`, `{quantifier}F p`, `{quantifier}X p`",
        )
        return t.Word("true", self._span(node))

    def word(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Word(str(c[0]), self._span(node))

    def enabled(self, node: Node, c: list[Any]) -> t.Formula:
        return t.Enabled(c[0], self._span(node))

    def fires(self, node: Node, c: list[Any]) -> t.Formula:
        condition = self._ml(c[1]) if len(c) > 1 else None
        return t.Fires(c[0], condition, self._span(node))

    def comparison(self, node: Node, c: list[Any]) -> t.Formula:
        operator = str(c[1])
        return self._compare("=" if operator == "==" else operator, c[0], c[2], node)

    def at_most(self, node: Node, c: list[Any]) -> t.Formula:
        return self._compare("<=", c[0], c[1], node)

    def less(self, node: Node, c: list[Any]) -> t.Formula:
        return self._compare("<", c[0], c[1], node)

    def more(self, node: Node, c: list[Any]) -> t.Formula:
        return self._compare(">", c[0], c[1], node)

    def _compare(self, operator: str, left: Any, right: Any, node: Node) -> t.Formula:
        return t.Tokens(operator, left, right, self._span(node))

    def operand(self, _: Node, c: list[Any]) -> int | tuple[t.Name, ...]:
        return tuple(c) if isinstance(c[0], t.Name) else self._number(c[0])

    def ml(self, _: Node, c: list[Any]) -> t.Formula:
        return self._ml(c[0])

    def _ml(self, token: Piece) -> t.Ml:
        start = token.start_pos
        end = start + len(token)
        return t.Ml(part(self._source, start + 1, end - 1), self._source.span(start, end))

    def name(self, node: Node, c: list[Any]) -> t.Name:
        token = c[0]
        if token.kind == "STRING":
            return t.Name(str(token)[1:-1], None, True, self._span(node))
        number = self._number(c[1]) if len(c) > 1 else None
        return t.Name(str(token), number, False, self._span(node))
